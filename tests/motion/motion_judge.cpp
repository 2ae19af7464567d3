#include "motion_judge.hpp"

#include <cmath>

#include "course.hpp"
#include "motion_walk.hpp"

namespace trammel::test {
namespace {

constexpr double kUpdate = 32;  // clocks

class Judge {
 public:
  explicit Judge(const MotionLimits& limits) : limits_(limits) {
    for (std::size_t a = 0; a < limits.machine.axes.size(); ++a) {
      const machine::MachineAxis& axis = limits.machine.axes[a];
      velocity_[a] = axis.max_velocity * axis.steps_per_mm / limits.clock_hz;
      acceleration_[a] = axis.max_acceleration * axis.steps_per_mm / (limits.clock_hz * limits.clock_hz);
      jerk_[a] = axis.max_jerk * axis.steps_per_mm / (limits.clock_hz * limits.clock_hz * limits.clock_hz);
    }
  }

  void start() {
    resting_ = true;
    ++verdict.stops;
  }

  void interval(const Interval& now) {
    if (now.begins_path) enter(now);
    // Path and rate do not change in the same clock: pieces end at whole ticks, and the rate of a piece continues for
    // some clocks after its last tick. During these clocks the new path runs at the rates of the previous piece.
    if (now.begins_piece) piece_clock_ = now.clock;
    handing_over_ =
        !resting_ &&
        ((piece_clock_ < path_clock_ && (now.ticks <= 1 || now.clock - path_clock_ < 2 * MotionWalk::kSwapClocks)) ||
         now.path->ticks - now.ticks <= 2);
    if (corner_waits_ && (now.begins_piece || !handing_over_)) corner(now);
    if (resting_)
      at_rest(now);
    else if (now.begins_piece)
      border(now);
    if (!handing_over_) moving(now);
    resting_ = false;
    last_ = now;
    ++verdict.updates;
  }

  void stop() {
    if (corner_waits_) corner(last_);
    at_rest(last_);
  }

  MotionVerdict verdict;

 private:
  // Ticks per clock^2, as the piece commands it; the floor of the piece may cut an update short.
  static double acceleration(const Interval& now) { return static_cast<double>(now.acceleration) * 0x1p-64 / kUpdate; }
  static double rate(const Interval& now) { return static_cast<double>(now.rate) * 0x1p-48; }

  void moving(const Interval& now) {
    const double speed = rate(now);
    const bool goes_on = !resting_ && !now.begins_piece;
    const double change = goes_on ? (speed - rate(last_)) / kUpdate : 0;
    const double jerk = static_cast<double>(now.jerk) * 0x1p-64 / (kUpdate * kUpdate);
    const std::size_t where = now.path->command;
    if (course_.curvature == 0) {
      verdict.velocity.look(at_one_.velocity * speed, where);
      verdict.acceleration.look(at_one_.acceleration * std::abs(change), where);
      verdict.jerk.look(at_one_.jerk * std::abs(jerk), where);
      return;
    }
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      const double pulses = course_.pulses_a_tick[a];
      verdict.velocity.look(pulses * speed / velocity_[a], where);
      const double whole = std::hypot(pulses * change, centripetal(a, speed));
      verdict.acceleration.look(whole / acceleration_[a], where);
      if (jerk_[a] <= 0) continue;
      const double along = pulses * std::abs(jerk) + centripetal(a, speed) * turn_rate(a, speed);
      const double across = 3 * turn_rate(a, speed) * pulses * std::abs(change);
      verdict.jerk.look(std::hypot(along, across) / jerk_[a], where);
    }
  }

  // Shares of the limits that a straight path uses, at a rate of 1 and at changes of 1.
  struct Shares {
    double velocity = 0;
    double acceleration = 0;
    double jerk = 0;
  };
  Shares straight() const {
    Shares most;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      const double pulses = course_.pulses_a_tick[a];
      most.velocity = std::max(most.velocity, pulses / velocity_[a]);
      most.acceleration = std::max(most.acceleration, pulses / acceleration_[a]);
      if (jerk_[a] > 0) most.jerk = std::max(most.jerk, pulses / jerk_[a]);
    }
    return most;
  }

  // For the plane axes of an arc: radians per clock at a tick rate, and pulses per clock^2 towards the centre.
  double turn_rate(std::size_t axis, double speed) const {
    if (course_.curvature == 0 || (axis != course_.plane[0] && axis != course_.plane[1])) return 0;
    return course_.pulses_a_tick[axis] * speed * course_.curvature / scale(axis);
  }
  double centripetal(std::size_t axis, double speed) const {
    return course_.pulses_a_tick[axis] * speed * turn_rate(axis, speed);
  }

  // The highest rate with which a motion may start or stop on the current path.
  double floor() const { return floor(course_); }
  double floor(const Course& course) const {
    double allowed = INFINITY;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      const double pulses = course.pulses_a_tick[a];
      if (pulses == 0) continue;
      allowed =
          std::min(allowed, jerk_[a] > 0 ? std::cbrt(4.5 * jerk_[a] / pulses) : std::sqrt(acceleration_[a] / pulses));
    }
    return allowed;
  }

  // Checks the first and the last rate of a motion. A rate is that of the middle of its update, and the last rate may
  // come one update and, because pieces have whole ticks, one tick early.
  void at_rest(const Interval& now) {
    const double gain = std::abs(static_cast<double>(now.gain)) * 0x1p-48;
    const double tick = resting_ ? 0 : 2 * std::max(gain, std::abs(acceleration(last_)) * kUpdate) / kUpdate;
    verdict.rest.look(rate(now) / (std::sqrt(floor() * floor() + tick) + 1.5 * gain + 0x1p-31), now.path->command);
  }

  void border(const Interval& now) {
    const bool new_path = !started_ && (now.ticks <= 1 || now.clock - path_clock_ <= 2 * MotionWalk::kSwapClocks);
    const double change = new_path ? density_change(now) : 1;
    const double before = rate(last_);
    const double after = rate(now);
    const double gain = static_cast<double>(now.gain) * 0x1p-48;
    const double most = std::max(before * change, after);
    const double rest = std::max(floor(course_), floor(last_course_) * change);
    const bool stop = most <= 2 * rest;  // also at a start
    const double allowed =
        std::abs(gain) + std::abs(acceleration(last_)) * kUpdate * change + 0.001 * most + (stop ? rest : 0);
    double jump = std::abs(after - before);
    // At the end of a path the ticks per mm may change together with the rate. This change is known as well as the
    // rounded lengths are.
    if (new_path) {
      const double scaled = before * mm_a_tick(last_course_, before_) / mm_a_tick(course_, now);
      const double least = scaled * (1 - last_course_.error) / (1 + course_.error);
      const double largest = course_.error < 1 ? scaled * (1 + last_course_.error) / (1 - course_.error) : INFINITY;
      jump = std::min(jump, std::max({0.0, least - after, after - largest}));
    }
    verdict.rate_jump.look(jump / allowed, now.path->command);
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      if (jerk_[a] <= 0 || new_path) continue;
      const double jumped = course_.pulses_a_tick[a] * std::abs(acceleration(now) - acceleration(last_));
      verdict.acceleration_jump.look((jumped - 2 * kUpdate * jerk_[a]) / acceleration_[a], now.path->command);
      const double clocks = jumped / jerk_[a] - 2 * kUpdate - 1;
      verdict.acceleration_jump_ticks.look(clocks * std::max(before, after), now.path->command);
    }
  }

  // Ratio of the ticks per mm of this path to those of the previous one, if a piece begins with the path. If the
  // rounded lengths do not show whether the density changes, the rates decide.
  double density_change(const Interval& now) const {
    if (!now.begins_piece) return 1;
    const double change = mm_a_tick(last_course_, before_) / mm_a_tick(course_, now);
    const double open = (1 + last_course_.error) * (1 + course_.error);
    if (std::max(change, 1 / change) > open) return change;
    const double rates = rate(now) / rate(last_);
    return std::abs(std::log(rates / change)) < std::abs(std::log(rates)) ? change : 1;
  }

  static double mm_a_tick(const Course& course, const Interval& at) {
    return course.length / static_cast<double>(at.path->ticks);
  }

  void enter(const Interval& now) {
    if (corner_waits_) corner(last_);
    last_course_ = course_;
    course_ = course_of(*now.path, limits_.machine);
    at_one_ = straight();
    path_clock_ = now.clock;
    before_ = last_;
    started_ = resting_;
    corner_waits_ = !resting_;
  }

  // Compares the speed through a corner with what the rules allow for the smallest turn that the rounded ends leave
  // possible. A corner that allows no speed is passed at the floor.
  void corner(const Interval& now) {
    corner_waits_ = false;
    const double at_floor = floor(last_course_) + 1.5 * std::abs(acceleration(before_)) * kUpdate;
    if (last_course_.spatial && course_.spatial) verdict.corner.look(jump(now, false), now.path->command);
    double allowed = 0;
    if (last_course_.spatial == course_.spatial) {
      Vector turn{};
      double dot = 0;
      for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
        if (course_.spatial && !is_spatial(limits_.machine.axes[a])) continue;
        dot += last_course_.exit[a] * course_.entry[a];
        turn[a] = course_.entry[a] - last_course_.exit[a];
      }
      const double angle = std::acos(std::clamp(dot, -1.0, 1.0)) - last_course_.error - course_.error;
      if (!(angle > 0)) return;
      const double most = strongest(turn);
      const double s = std::cos(angle / 2);
      const double shorter = std::min(last_course_.length, course_.length) + 2 / scale(0);
      allowed = std::sqrt(most * std::min(limits_.junction_deviation * s / (1 - s), shorter / angle));
    }
    ++verdict.corners;
    const double scale = limits_.clock_hz * mm_a_tick(last_course_, before_) * (1 - last_course_.error);  // mm/s
    // Half an update, and one tick of the ramp to the corner, may be missing.
    const double gain = std::abs(acceleration(before_)) * kUpdate;
    const double most_rate = std::sqrt(allowed * allowed / (scale * scale) + 2 * gain / kUpdate) + gain / 2;
    double share = rate(before_) / std::max(most_rate, at_floor);
    // The rounded other path may contain a move of X Y Z below a pulse. Then the corner is no stop, but no axis may
    // jump.
    if (last_course_.spatial != course_.spatial) share = std::min(share, jump(now, true));
    verdict.corner.look(share, now.path->command);
  }

  // Jump of speed of the axes outside X Y Z, or of `all` axes. A jump of sqrt(a d) is allowed; rounded ends may hide
  // half a pulse of each path.
  double jump(const Interval& now, bool all) const {
    const double ticks_before = limits_.clock_hz * rate(before_);  // per second
    const double ticks_after = density_change(now) == 1 ? ticks_before : limits_.clock_hz * rate(now);
    double share = 0;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      const machine::MachineAxis& axis = limits_.machine.axes[a];
      if (!all && is_spatial(axis)) continue;
      const double before = last_course_.exit[a] * mm_a_tick(last_course_, before_);
      const double after = course_.entry[a] * mm_a_tick(course_, now);
      const double hidden = (ticks_before / static_cast<double>(before_.path->ticks) +
                             ticks_after / static_cast<double>(now.path->ticks)) /
                            scale(a);
      const double jumped = std::abs(after * ticks_after - before * ticks_before) - hidden;
      const double at_floor = std::max(floor(last_course_) * std::abs(before), floor(course_) * std::abs(after));
      const double allowed =
          std::sqrt(axis.max_acceleration * limits_.junction_deviation) + at_floor * limits_.clock_hz;
      share = std::max(share, jumped / allowed);
    }
    return share;
  }

  double scale(std::size_t axis) const { return limits_.machine.axes[axis].steps_per_mm; }

  // The largest acceleration in this direction that keeps the limit of each axis, mm/s^2.
  double strongest(const Vector& direction) const {
    double squares = 0;
    for (const double x : direction) squares += x * x;
    double most = INFINITY;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      if (direction[a] == 0) continue;
      most = std::min(most, limits_.machine.axes[a].max_acceleration * std::sqrt(squares) / std::abs(direction[a]));
    }
    return most;
  }

  const MotionLimits& limits_;
  Vector velocity_{};      // pulses per clock
  Vector acceleration_{};  // pulses per clock^2
  Vector jerk_{};          // pulses per clock^3; 0: no limit
  Course course_;
  Shares at_one_;
  Course last_course_;
  bool resting_ = true;
  Interval last_;
  Interval before_;                // the last interval of the previous path
  std::uint64_t path_clock_ = 0;   // first clock of this path
  std::uint64_t piece_clock_ = 0;  // first clock of this piece
  bool started_ = true;            // this path starts from rest
  bool handing_over_ = false;
  bool corner_waits_ = false;  // waits for the rate with which the path continues
};

}  // namespace

MotionVerdict judge_motion(const std::vector<driver::Command>& commands, const MotionLimits& limits) {
  MotionWalk walk(commands);
  Judge judge(limits);
  walk.visit(judge);
  judge.verdict.clocks = walk.clocks();
  return judge.verdict;
}

}  // namespace trammel::test
