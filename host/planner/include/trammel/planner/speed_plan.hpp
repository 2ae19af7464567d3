// What look-ahead, speed plan and quantiser hand to each other. mm and seconds along the path (degrees for moves of
// rotary axes alone).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace trammel::planner {

// Of an arc: acceleration along it and across it, which is turning * v^2, are `whole` together at the most. So are
// `jerk` the jerk along it, with turning^2 * v^3, and that across it, which is 3 * turning * v * acceleration.
struct Curve {
  double whole = 0;                                       // 0: no arc
  double turning = 0;                                     // 1/mm
  double at_rest = 0;                                     // the most along the path at any speed
  double jerk = std::numeric_limits<double>::infinity();  // > 0
  double jerk_at_rest = 0;                                // the most along the path at any speed

  // The acceleration along the path that is left at a speed, together with least_jerk() at that speed.
  double along(double speed) const {
    const double across = turning * speed * speed;
    const double kept = turned(speed) + kLeft * (1 - turned(speed));
    const double swung = std::sqrt(std::max(0.0, 1 - kept * kept)) * jerk / (3 * turning * speed);
    return std::min(std::sqrt(std::max(0.0, whole * whole - across * across)), swung);
  }
  // The jerk along the path that along() leaves at any speed up to this one.
  double least_jerk(double speed) const { return kLeft * (1 - turned(speed)) * jerk; }
  // The same at a speed up to this one with no more acceleration than this, which is at most along().
  double jerk_along(double speed, double acceleration) const {
    const double swung = 3 * turning * speed * acceleration / jerk;
    const double left = std::sqrt(std::max(0.0, 1 - swung * swung)) - turned(speed);
    return std::min(jerk_at_rest, left * jerk);
  }

 private:
  static constexpr double kLeft = 0.6;  // for the jerk along the path, of what the turning leaves
  double turned(double speed) const { return turning * speed * (turning * speed) * speed / jerk; }
};

// A stretch of path with limits of its own: a block, or a part of one.
struct Span {
  double length = 0;        // > 0
  double speed = 0;         // > 0, the most in it
  double acceleration = 0;  // > 0, the most along the path at that speed, and so at any
  double jerk = 0;          // > 0, the most along the path; infinite: no limit
  double exit_speed = 0;    // >= 0, the most at its end, where a corner is; 0: a stop
  Curve curve{};
};

// A part of the motion at constant jerk. Its borders lie anywhere along the path. Speed and acceleration are those at
// its beginning.
struct Phase {
  double length = 0;    // > 0
  double duration = 0;  // > 0
  double speed = 0;
  double acceleration = 0;
  double jerk = 0;
  double next = 0;           // acceleration of the phase behind it, where acceleration may jump; 0 at a stop
  bool stop = false;         // ends where finish() said
  bool short_sight = false;  // slower than the path allows, because of what `window` does not show
};

inline double end_speed(const Phase& phase) {
  return phase.speed + phase.duration * (phase.acceleration + phase.duration * phase.jerk / 2);
}

// What planning has taken so far, in counts that are the same on every host.
struct PlanWork {
  std::uint64_t spans = 0;         // pushed
  std::uint64_t runs = 0;          // finished
  std::uint64_t windows = 0;       // planned
  std::uint64_t window_spans = 0;  // in these, summed up
  std::uint64_t ramps = 0;         // computed for these; where acceleration may jump: looks at a span
};

// Speeds along a path that is not known to its end. A function of the sequence of spans alone. Not thread-safe.
class SpeedPlan {
 public:
  virtual ~SpeedPlan() = default;

  // No further span fits: phases are to be taken first.
  virtual bool full() const = 0;
  // The next stretch. Until another follows, the motion is planned to stop at its end.
  virtual void push(const Span& span) = 0;
  // What was pushed last ends in a stop; spans after it begin from rest.
  virtual void finish() = 0;
  // The next phase, when the window is full or after finish(); false when a span is wanted first. The lengths of the
  // phases add up to the spans'. In order, without gap.
  virtual bool next(Phase& phase) = 0;

  const PlanWork& work() const { return work_; }

 protected:
  PlanWork work_;
};

}  // namespace trammel::planner
