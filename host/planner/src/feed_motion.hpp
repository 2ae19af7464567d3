// The motion that one feed piece makes, in ticks and clocks of the card: constant jerk. Internal to the planner; pure.
#pragma once

namespace trammel::planner {

// Times are counted from the piece's start, rates in ticks per clock.
struct FeedMotion {
  double rate = 0;
  double acceleration = 0;  // at the start
  double jerk = 0;
  double clocks = 0;
  double end_rate = 0;
  bool rests = false;  // at rest at its end; the program need not stop there
};

struct FeedInstant {
  double clocks;
  double rate;
};

struct Rates {
  double begin;
  double end;
};

// A motion of constant acceleration.
FeedMotion steady(double rate, double end_rate, double ticks);

// The rates of a ramp of constant acceleration (ticks per clock^2, either sign). A rate near rest is raised to the rate
// half a tick away from rest, v^2 = 2 a s at s = 1/2. At a lower rate the tick next to rest would take too long.
Rates off_rest(double rate, double end_rate, double acceleration);

// The highest or lowest rate inside the motion, where the acceleration changes its sign; if it does not, the rate at
// the start.
double turning_rate(const FeedMotion& motion);

// Time and rate after `distance` of the motion's `ticks`.
FeedInstant instant(const FeedMotion& motion, double distance, double ticks);

// The time at which a motion has covered `distance`. Speed, acceleration and jerk are those at its beginning; it takes
// `duration` for `length`. A distance a little outside the motion counts at the speed at that end. Newton's method
// between bounds. Any consistent units.
double time_at(double distance, double speed, double acceleration, double jerk, double duration, double length);

}  // namespace trammel::planner
