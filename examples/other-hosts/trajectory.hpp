// What the two sources of the example trajectory share: its numbers, and the record of a simulated card's pulses.
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "trammel/driver/position_stream.hpp"
#include "trammel/driver/steps.hpp"

namespace trajectory {

using namespace std::chrono_literals;
using namespace trammel::driver;
using std::chrono::nanoseconds;

constexpr unsigned kJoints = 3;
constexpr std::array<double, kJoints> kPulsesPerRadian = {2546.479, 2546.479, 1273.240};
constexpr nanoseconds kPeriod = 1ms;
constexpr unsigned kAhead = 2;           // periods that the card has queued
constexpr unsigned kStalePeriods = 10;   // that it goes on for without a new one
constexpr nanoseconds kSlewTime = 20ms;  // of a ramp from full speed

using Joints = std::array<double, kJoints>;

struct Point {
  nanoseconds time_from_start;
  Joints positions;   // radians
  Joints velocities;  // radians/s
};

inline double seconds(nanoseconds time) { return std::chrono::duration<double>(time).count(); }
inline double pulses_of(std::int64_t position) { return static_cast<double>(position) / PositionStream::kPulse; }
inline double in_pulses(const Joints& place, unsigned joint) { return place[joint] * kPulsesPerRadian[joint]; }

// What became of a trajectory.
struct Followed {
  std::uint64_t stale_ticks = 0;                       // that the card went on for, waiting for a point
  nanoseconds late{0}, back{0};                        // from this time of the trajectory to that one
  std::optional<PositionStream::Stopped> stopped;      // where it stood when it had ramped down
  std::uint64_t stopped_by = 0;                        // a clock in which it did
  PositionStream::Positions line_begin{}, line_end{};  // the last period before that
};

// What a simulated card's pins and paths have done.
struct Record final : StepSink {
  void pin_step(const PinStep& step) override { pins[step.axis] += step.direction; }
  void path_step(const PathStep& step) override { path.push_back(step); }

  std::vector<PathStep> path;
  std::array<std::int64_t, trammel::card_map::kMaxAxes> pins{};
};

// Checks where the joints were at the times of the points, and the line that the card went on along. Prints what does
// not hold, and gives back how many checks have failed so far.
int check_pulses(const Record& record, const Followed& followed, const std::vector<Point>& points, nanoseconds late,
                 double clock_hz);

}  // namespace trajectory
