// Declarations shared by the two source files of the example trajectory: its constants, and the record of a simulated
// card's pulses.
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
constexpr unsigned kAhead = 2;           // periods to keep queued in the card
constexpr unsigned kStalePeriods = 10;   // periods for which the card continues when no new one comes
constexpr nanoseconds kSlewTime = 20ms;  // duration of a ramp from full speed to rest

using Joints = std::array<double, kJoints>;

struct Point {
  nanoseconds time_from_start;
  Joints positions;   // radians
  Joints velocities;  // radians/s
};

inline double seconds(nanoseconds time) { return std::chrono::duration<double>(time).count(); }
inline double pulses_of(std::int64_t position) { return static_cast<double>(position) / PositionStream::kPulse; }
inline double in_pulses(const Joints& place, unsigned joint) { return place[joint] * kPulsesPerRadian[joint]; }

// Result of following a trajectory.
struct Followed {
  std::uint64_t stale_ticks = 0;                       // ticks for which the card continued while it waited for a point
  nanoseconds late{0}, back{0};                        // trajectory times between which the card was behind the points
  std::optional<PositionStream::Stopped> stopped;      // positions at rest, after a ramp down
  std::uint64_t stopped_by = 0;                        // a clock at which the card was at rest
  PositionStream::Positions line_begin{}, line_end{};  // the last period before the late point
};

// Pulses at the pins and steps of the paths of a simulated card.
struct Record final : StepSink {
  void pin_step(const PinStep& step) override { pins[step.axis] += step.direction; }
  void path_step(const PathStep& step) override { path.push_back(step); }

  std::vector<PathStep> path;
  std::array<std::int64_t, trammel::card_map::kMaxAxes> pins{};
};

// Checks the joints' positions at the times of the points, and the line along which the card continued. Prints each
// failed check. Returns the number of all failed checks so far.
int check_pulses(const Record& record, const Followed& followed, const std::vector<Point>& points, nanoseconds late,
                 double clock_hz);

}  // namespace trajectory
