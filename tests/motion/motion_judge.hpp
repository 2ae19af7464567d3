// An independent reading of the motion. It reconstructs in integers, from the commands to the card alone, what each
// axis does from update to update of the feed generator, and compares it with the limits of the machine. It uses
// neither the planner nor the golden model: it implements the arithmetic of the feed generator and of the generators
// anew from docs/reference/behaviour.md.
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

// The worst value of a quantity, as a multiple of its limit, and the geometry command (from 0) where it occurs.
struct Worst {
  double share = 0;
  std::size_t command = 0;
  void look(double candidate, std::size_t where) {
    if (candidate > share) *this = {candidate, where};
  }
};

// Shares of the limits that a motion uses. All are at most 1 except for the effects of integers.
struct MotionVerdict {
  Worst velocity;           // of an axis, relative to max_velocity
  Worst acceleration;       // of an axis, tangential and centripetal together, relative to max_acceleration
  Worst jerk;               // of an axis, along and across the path, relative to max_jerk; 0 if no axis has one
  Worst acceleration_jump;  // at ends of pieces, beyond the jerk of two updates, relative to max_acceleration
  // The same jump beyond the jerk of two updates and a clock, relative to the jerk of one tick: pieces have whole
  // ticks.
  Worst acceleration_jump_ticks;
  Worst rate_jump;          // at ends of pieces, relative to two updates of acceleration plus 0.1 % of the rate
  Worst rest;               // first and last rate at a stop, relative to the rule for the floor
  Worst corner;             // speed through a corner, relative to what the rules for corners allow
  std::size_t corners = 0;  // judged corners
  std::size_t stops = 0;
  std::uint64_t clocks = 0;
  std::uint64_t updates = 0;
  double seconds(double clock_hz) const { return static_cast<double>(clocks) / clock_hz; }
};

// Throws std::runtime_error if the ticks of geometry and feed differ between two barriers.
MotionVerdict judge_motion(const std::vector<driver::Command>& commands, const MotionLimits& limits);

// Compares the steps of a golden model of the card with the same reading. Returns the largest difference, in pulses,
// between the count of steps of an axis and its position. The steps are in the order of their cycles. The clocks from
// the first rate of a start to its first step are taken from that step.
struct TimedStep {
  std::uint64_t cycle;
  std::uint8_t axis;
  std::int8_t direction;
};
double farthest_from_motion(const std::vector<driver::Command>& commands, const std::vector<TimedStep>& steps);

}  // namespace trammel::test
