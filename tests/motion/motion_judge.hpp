// A second reading of the motion: from the commands that go to the card alone, it rebuilds in integers what each axis
// does from update to update of the feed generator, and holds it against the machine's limits. It knows neither
// planner nor golden model: the feed generator's and the generators' arithmetic is read anew from
// docs/reference/behaviour.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::test {

struct MotionLimits {
  machine::Machine machine;
  double clock_hz = 0;
  double junction_deviation = 0.01;  // mm
};

// A quantity at its worst: how many times its limit, and the geometry command (from 0) where that was.
struct Worst {
  double share = 0;
  std::size_t command = 0;
  void look(double candidate, std::size_t where) {
    if (candidate > share) *this = {candidate, where};
  }
};

// What a motion needs of what it is allowed: nothing above 1 but for what integers cost.
struct MotionVerdict {
  Worst velocity;           // of an axis; of max_velocity
  Worst acceleration;       // of an axis, tangential and centripetal together; of max_acceleration
  Worst jerk;               // of an axis, along the path and across it; of max_jerk. 0 where no axis has one
  Worst acceleration_jump;  // at borders of pieces, beyond two updates' jerk; of max_acceleration
  Worst rate_jump;          // at borders of pieces; of two updates' acceleration plus 0.1 % of the rate
  Worst rest;               // first and last rate at a stop; of the floor's rule
  Worst corner;             // speed through a corner; of what the rules for corners allow there
  std::size_t corners = 0;  // judged
  std::size_t stops = 0;
  std::uint64_t clocks = 0;
  std::uint64_t updates = 0;
  double seconds(double clock_hz) const { return static_cast<double>(clocks) / clock_hz; }
};

// Throws std::runtime_error for a stream that is no motion: ticks of geometry and feed that do not match between two
// barriers.
MotionVerdict judge_motion(const std::vector<driver::Command>& commands, const MotionLimits& limits);

// The steps of a golden model of the card, against the same reading: how far, in pulses, an axis's count of steps ever
// is from its position. Steps in order of cycles; the clocks from a start's first rate to its first step are taken
// from that step.
struct TimedStep {
  std::uint64_t cycle;
  std::uint8_t axis;
  std::int8_t direction;
};
double farthest_from_motion(const std::vector<driver::Command>& commands, const std::vector<TimedStep>& steps);

}  // namespace trammel::test
