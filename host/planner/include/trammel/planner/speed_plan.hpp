// The data that look-ahead, speed plan and quantiser exchange. Units: mm and seconds along the path (degrees if only
// rotary axes move).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace trammel::planner {

// Limits on an arc. The vector sum of the acceleration along the path and the acceleration across it, turning * v^2, is
// at most `whole`. The vector sum of the jerk along the path, increased by turning^2 * v^3, and the jerk across it, 3 *
// turning * v * acceleration, is at most `jerk`.
struct Curve {
  double whole = 0;                                       // mm/s^2; 0: no arc
  double turning = 0;                                     // 1/mm
  double at_rest = 0;                                     // mm/s^2, the most along the path at any speed
  double jerk = std::numeric_limits<double>::infinity();  // mm/s^3, > 0
  double jerk_at_rest = 0;                                // mm/s^3, the most along the path at any speed

  // The acceleration along the path that is left at a speed, if the jerk along the path is least_jerk() at that speed.
  double along(double speed) const {
    const double across = turning * speed * speed;
    const double kept = turned(speed) + kLeft * (1 - turned(speed));
    const double swung = std::sqrt(std::max(0.0, 1 - kept * kept)) * jerk / (3 * turning * speed);
    return std::min(std::sqrt(std::max(0.0, whole * whole - across * across)), swung);
  }
  // The jerk along the path that along() leaves at any speed up to `speed`.
  double least_jerk(double speed) const { return kLeft * (1 - turned(speed)) * jerk; }
  // The same at speeds up to `speed` with at most this acceleration, which is at most along().
  double jerk_along(double speed, double acceleration) const {
    const double swung = 3 * turning * speed * acceleration / jerk;
    const double left = std::sqrt(std::max(0.0, 1 - swung * swung)) - turned(speed);
    return std::min(jerk_at_rest, left * jerk);
  }

 private:
  // The share, for the jerk along the path, of the jerk that turning^2 * v^3 leaves.
  static constexpr double kLeft = 0.6;
  double turned(double speed) const { return turning * speed * (turning * speed) * speed / jerk; }
};

// A stretch of path with its own limits: a block, or a part of one.
struct Span {
  double length = 0;        // > 0
  double speed = 0;         // > 0, the most anywhere in it
  double acceleration = 0;  // > 0, the most along the path at `speed`, and so at any speed
  double jerk = 0;          // > 0, the most along the path; infinite: no limit
  double exit_speed = 0;    // >= 0, the most at its end, if there is a corner; 0: a stop
  Curve curve{};
};

// A part of the motion at constant jerk. It may begin and end anywhere on the path. Speed and acceleration are those at
// its beginning.
struct Phase {
  double length = 0;    // > 0
  double duration = 0;  // > 0
  double speed = 0;
  double acceleration = 0;
  double jerk = 0;
  double next = 0;           // acceleration of the next phase, in plans whose acceleration may jump; 0 at a stop
  bool stop = false;         // ends at the stop that finish() set
  bool short_sight = false;  // slower than the path allows, because the window ends
};

inline double end_speed(const Phase& phase) {
  return phase.speed + phase.duration * (phase.acceleration + phase.duration * phase.jerk / 2);
}

// The work of planning so far, in counts that are the same on every host.
struct PlanWork {
  std::uint64_t spans = 0;         // pushed
  std::uint64_t runs = 0;          // finished
  std::uint64_t windows = 0;       // planned
  std::uint64_t window_spans = 0;  // sum of the windows' spans
  std::uint64_t ramps = 0;         // ramps computed for the windows; in trapezoid plans: visits to a span
};

// Speeds along a path whose end is not known yet. The plan depends on the sequence of spans only. Not thread-safe.
class SpeedPlan {
 public:
  virtual ~SpeedPlan() = default;

  // No further span fits: take phases first.
  virtual bool full() const = 0;
  // The next stretch. Until another follows, the motion is planned to stop at its end.
  virtual void push(const Span& span) = 0;
  // The last span pushed ends in a stop; spans after it begin from rest.
  virtual void finish() = 0;
  // Gets the next phase, if the window is full or after finish(); false: push a span first. Phases come in order
  // without gaps, and their lengths add up to the spans' lengths.
  virtual bool next(Phase& phase) = 0;

  const PlanWork& work() const { return work_; }

 protected:
  PlanWork work_;
};

}  // namespace trammel::planner
