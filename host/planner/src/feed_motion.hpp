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
  bool rests = false;  // at its end, whether the program stops there or not
};

struct FeedInstant {
  double clocks;
  double rate;
};

struct Rates {
  double begin;
  double end;
};

// Of constant acceleration.
FeedMotion steady(double rate, double end_rate, double ticks);

// Of a ramp of constant acceleration (ticks per clock^2, either sign), what lies near rest raised to the rate of half a
// tick from it: v^2 = 2 a s at s = 1/2. Slower, the tick there would hang.
Rates off_rest(double rate, double end_rate, double acceleration);

// The highest or lowest rate inside the motion, which is where the acceleration changes its sign; where it does not,
// the rate at its start.
double turning_rate(const FeedMotion& motion);

// Where `distance` of the motion's `ticks` are over.
FeedInstant instant(const FeedMotion& motion, double distance, double ticks);

// When the distance has been gone from speed, acceleration and jerk on, of a motion that takes `duration` for `length`;
// a little outside it at the speed that it has there. Newton's method between bounds. Any consistent units.
double time_at(double distance, double speed, double acceleration, double jerk, double duration, double length);

}  // namespace trammel::planner
