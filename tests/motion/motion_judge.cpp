#include "motion_judge.hpp"

#include <cmath>

#include "motion_walk.hpp"

namespace trammel::test {
namespace {

constexpr double kUpdate = 32;  // clocks

using Vector = std::array<double, card_map::kMaxAxes>;

double length(const Vector& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

// What the limits say of a path.
struct Course {
  Vector pulses_a_tick{};  // by axis, signed
  Vector mm{};             // from its start to its end
  double length = 0;       // mm, along X Y Z, or all axes where none of these moves
  bool spatial = false;    // X, Y or Z moves
  double error = 0;        // radians: how far rounded ends may have turned it
};

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
    if (resting_) at_rest(now);
    else if (now.begins_piece) border(now);
    moving(now);
    resting_ = false;
    last_ = now;
    last_acceleration_ = static_cast<double>(now.gain) * 0x1p-48 / kUpdate;
    ++verdict.updates;
  }

  void stop() { at_rest(last_); }

  MotionVerdict verdict;

 private:
  static double rate(const Interval& now) { return static_cast<double>(now.rate) * 0x1p-48; }

  void moving(const Interval& now) {
    const double speed = rate(now);
    const double acceleration = static_cast<double>(now.gain) * 0x1p-48 / kUpdate;
    const double jerk = static_cast<double>(now.jerk) * 0x1p-64 / (kUpdate * kUpdate);
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      const double pulses = std::abs(course_.pulses_a_tick[a]);
      verdict.velocity.look(pulses * speed / velocity_[a], now.command);
      verdict.acceleration.look(pulses * std::abs(acceleration) / acceleration_[a], now.command);
      if (jerk_[a] > 0) verdict.jerk.look(pulses * std::abs(jerk) / jerk_[a], now.command);
    }
  }

  // First and last rate of a motion: the floor's, and half an update's gain, since rates are those of an update's
  // middle; at the end the piece may stop an update early.
  void at_rest(const Interval& now) {
    double allowed = INFINITY;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      const double pulses = std::abs(course_.pulses_a_tick[a]);
      if (pulses == 0) continue;
      allowed = std::min(allowed, jerk_[a] > 0 ? std::cbrt(4.5 * jerk_[a] / pulses) : std::sqrt(acceleration_[a] / pulses));
    }
    const double gain = std::abs(static_cast<double>(now.gain)) * 0x1p-48;
    verdict.rest.look(rate(now) / (allowed + 1.5 * gain + 0x1p-31), now.command);
  }

  void border(const Interval& now) {
    const double before = rate(last_);
    const double after = rate(now);
    const double gain = static_cast<double>(now.gain) * 0x1p-48;
    const double allowed = std::abs(gain) + std::abs(last_acceleration_) * kUpdate + 0.001 * std::max(before, after);
    double jump = std::abs(after - before);
    // Where a path ends too, the density of ticks may change with the rate.
    if (now.begins_path) jump = std::min(jump, std::abs(after - before * density(last_) / density(now)));
    verdict.rate_jump.look(jump / allowed, now.command);
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      if (jerk_[a] <= 0 || now.begins_path) continue;
      const double pulses = std::abs(course_.pulses_a_tick[a]);
      const double step = pulses * std::abs(gain / kUpdate - last_acceleration_) - 2 * kUpdate * jerk_[a];
      verdict.acceleration_jump.look(step / acceleration_[a], now.command);
    }
  }

  double density(const Interval& at) const { return course_of(*at.path).length / static_cast<double>(at.path->ticks); }

  void enter(const Interval& now) {
    const Course next = course_of(*now.path);
    if (!resting_) corner(next, now);
    course_ = next;
  }

  Course course_of(const driver::LineCommand& line) const {
    Course course;
    double finest = 0;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      course.pulses_a_tick[a] = static_cast<double>(line.increment[a]) * 0x1p-40;
      course.mm[a] = std::round(course.pulses_a_tick[a] * static_cast<double>(line.ticks)) / scale(a);
      const bool counts = limits_.machine.axes[a].letter >= 'X';
      if (counts && course.mm[a] != 0) course.spatial = true;
      if (course.mm[a] != 0 || counts) finest = std::max(finest, 1 / scale(a));
    }
    Vector along = course.mm;
    for (std::size_t a = 0; a < along.size(); ++a) {
      if (course.spatial && a < limits_.machine.axes.size() && limits_.machine.axes[a].letter < 'X') along[a] = 0;
    }
    course.length = length(along);
    // Each end is off by half a pulse an axis: across the path by half a pulse times sqrt(3) at most.
    course.error = course.length > 0 ? std::sqrt(3) * finest / course.length : INFINITY;
    return course;
  }

  double scale(std::size_t axis) const { return limits_.machine.axes[axis].steps_per_mm; }

  // Speed through a corner, mm/s, against what design rules allow for the least turn that the rounded ends leave.
  void corner(const Course& next, const Interval& now) {
    if (course_.spatial != next.spatial) {
      verdict.corner.look(INFINITY, now.command);  // such a border is a stop
      return;
    }
    Vector turn{};
    double dot = 0;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      if (next.spatial && limits_.machine.axes[a].letter < 'X') continue;
      const double u0 = course_.mm[a] / course_.length;
      const double u1 = next.mm[a] / next.length;
      dot += u0 * u1;
      turn[a] = u1 - u0;
    }
    const double angle = std::acos(std::clamp(dot, -1.0, 1.0)) - course_.error - next.error;
    if (!(angle > 0)) return;
    ++verdict.corners;
    const double shorter = std::min(course_.length, next.length);
    const double speed = rate(last_) * limits_.clock_hz * course_.length / static_cast<double>(last_.path->ticks);
    const double most = strongest(turn);
    const double s = std::cos(angle / 2);
    const double deviation = most * limits_.junction_deviation * s / (1 - s);
    const double centripetal = most * (shorter + 2 / scale(0)) / angle;
    verdict.corner.look(speed / std::sqrt(std::min(deviation, centripetal)), now.command);
  }

  // The largest acceleration in the direction that no axis's limit forbids, mm/s^2.
  double strongest(const Vector& direction) const {
    const double whole = length(direction);
    double most = INFINITY;
    for (std::size_t a = 0; a < limits_.machine.axes.size(); ++a) {
      if (direction[a] == 0) continue;
      most = std::min(most, limits_.machine.axes[a].max_acceleration * whole / std::abs(direction[a]));
    }
    return most;
  }

  const MotionLimits& limits_;
  Vector velocity_{};      // pulses a clock
  Vector acceleration_{};  // a clock^2
  Vector jerk_{};          // a clock^3; 0: no limit
  Course course_;
  bool resting_ = true;
  Interval last_;
  double last_acceleration_ = 0;  // ticks a clock^2
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
