// What look-ahead, speed plan and quantiser hand to each other. mm and seconds along the path (degrees for moves of
// rotary axes alone).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace trammel::planner {

// Of an arc: acceleration along it and across it, which is turning * v^2, are `whole` together at the most.
struct Curve {
  double whole = 0;                                       // 0: no arc
  double turning = 0;                                     // 1/mm
  double at_rest = 0;                                     // the most along the path at any speed
  double jerk = std::numeric_limits<double>::infinity();  // across the path, 3 * turning * v * acceleration, the most

  // The acceleration along the path that is left at a speed.
  double along(double speed) const {
    const double across = turning * speed * speed;
    return std::min(std::sqrt(std::max(0.0, whole * whole - across * across)), jerk / (3 * turning * speed));
  }
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
