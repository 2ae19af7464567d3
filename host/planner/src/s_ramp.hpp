// Ramps between two speeds, jerk limited, with no acceleration at either end. A ramp from a lower to a higher speed and
// its mirror image have the same length. Pure functions of + - * / and sqrt: the same on every host. Internal to the
// planner.
#pragma once

#include <array>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

struct RampLimits {
  double acceleration = 0;  // > 0
  double jerk = 0;          // > 0, may be infinite
};

// A ramp, or a stretch at one speed where the two are equal.
struct Ramp {
  double length = 0;
  double from = 0;
  double to = 0;
  RampLimits limits;
  bool short_sight = false;  // as the phases'
};

// Of the ramp from `low` to `high`.
double ramp_length(double low, double high, RampLimits limits);

// The least length in which `high` is reached from `low` without acceleration at first; at `high` the speed goes on
// rising. At most ramp_length().
double reach_length(double low, double high, RampLimits limits);

// The two ends of a path and what holds on the way up from the first and down to the second.
struct Hop {
  double length = 0;
  double from = 0;
  double to = 0;
  RampLimits up;
  RampLimits down;
};

// The highest speed, at most `most`, that ramps up and down leave room for. At least the higher of from and to.
double peak_speed(const Hop& hop, double most);

// Parts of constant jerk, as many as are returned.
unsigned phases_of(const Ramp& ramp, std::array<Phase, 3>& phases);

}  // namespace trammel::planner
