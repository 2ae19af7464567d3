#include "trammel/measure/motor.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <cmath>
#include <cstdint>
#include <functional>

#include "numbers.hpp"

namespace trammel::measure {
namespace {

constexpr double kSettle = 0.1;  // s of rest after the last pulse

// Rotor angle (rad), speed (rad/s), currents of both phases (A).
using State = std::array<double, 4>;
using Currents = std::array<double, 2>;

class Motor {
 public:
  explicit Motor(const MotorParameters& parameters)
      : p_(parameters),
        torque_constant_(p_.holding_torque / (std::sqrt(2.0) * p_.rated_current)),
        inertia_(p_.rotor_inertia + p_.load_inertia),
        gain_(p_.inductance / p_.chopper_time) {}

  // The currents whose field is at an electrical angle.
  Currents reference(double electrical_angle) const {
    const double amplitude = std::sqrt(2.0) * p_.rated_current;
    return {amplitude * std::cos(electrical_angle), amplitude * std::sin(electrical_angle)};
  }

  void set_reference(const Currents& reference) { reference_ = reference; }

  void operator()(const State& state, State& rate, double /*time*/) const {
    const double speed = state[1];
    const double sine = std::sin(p_.pole_pairs * state[0]);
    const double cosine = std::cos(p_.pole_pairs * state[0]);
    const double sine_of_4 = 4 * sine * cosine * (cosine * cosine - sine * sine);
    const double torque = torque_constant_ * (state[3] * cosine - state[2] * sine) - p_.detent_torque * sine_of_4 -
                          p_.viscous_damping * speed - p_.friction * std::tanh(speed / p_.friction_speed);
    rate[0] = speed;
    rate[1] = torque / inertia_;
    rate[2] = current_rate(0, state[2], -torque_constant_ * speed * sine);
    rate[3] = current_rate(1, state[3], torque_constant_ * speed * cosine);
  }

 private:
  double current_rate(std::size_t phase, double current, double back_emf) const {
    const double wanted = p_.resistance * reference_[phase] + gain_ * (reference_[phase] - current);
    const double voltage = std::clamp(wanted, -p_.supply, p_.supply);
    return (voltage - p_.resistance * current - back_emf) / p_.inductance;
  }

  MotorParameters p_;
  double torque_constant_;  // N m/A
  double inertia_;
  double gain_;  // V/A
  Currents reference_{};
};

// True if the curve can be repeated without a jump in position or speed. (An open arc has a jump in speed.)
bool repeatable(const IdealCurve& curve) { return curve.is_line() || curve.is_closed(); }

// The number of runs of the curve: a whole number, except that a curve of more than the maximum of pulses is cut
// short.
double repeats_of(const Trace& trace, const IdealCurve& curve, const MotorRun& run) {
  const auto pulses = static_cast<double>(pulses_of(trace));
  // Pulses of both ramps together, with the mean number of pulses per length of path.
  const double ramps = run.speed * run.ramp_time * pulses / curve.length();
  const double most = static_cast<double>(run.max_pulses) + ramps;
  if (pulses > most) return most / pulses;
  return repeatable(curve) ? std::ceil((static_cast<double>(run.min_pulses) + ramps) / pulses) : 1;
}

// The running point over time: a ramp from rest to a speed, and a ramp back to rest.
class RampedMotion {
 public:
  RampedMotion(double way, double speed, double ramp_time)
      : speed_(speed),
        ramp_(std::min(ramp_time, 2 * way / (3 * speed))),
        ramp_way_(speed * ramp_ / 2),
        way_(way),
        duration_(way / speed + ramp_) {}

  double duration() const { return duration_; }
  double ramp() const { return ramp_; }

  double time_of(double way) const {
    if (way < ramp_way_) return ramp_ * std::sqrt(way / ramp_way_);
    if (way > way_ - ramp_way_) return duration_ - ramp_ * std::sqrt(std::max(0.0, way_ - way) / ramp_way_);
    return ramp_ + (way - ramp_way_) / speed_;
  }
  double way_at(double time) const {
    if (time < ramp_) return ramp_way_ * (time / ramp_) * (time / ramp_);
    const double left = std::max(0.0, duration_ - time);
    if (left < ramp_) return way_ - ramp_way_ * (left / ramp_) * (left / ramp_);
    return ramp_way_ + (time - ramp_) * speed_;
  }
  double speed_at(double time) const {
    if (time < ramp_) return speed_ * time / ramp_;
    const double left = std::max(0.0, duration_ - time);
    return left < ramp_ ? speed_ * left / ramp_ : speed_;
  }

 private:
  double speed_;
  double ramp_;      // s
  double ramp_way_;  // pulses along the path
  double way_;
  double duration_;
};

// One axis over all repeats of the curve.
class AxisRun {
 public:
  // Runs the curve `repeats` times; `repeats` need not be whole.
  AxisRun(const Trace& trace, const IdealCurve& curve, const MotorRun& run, std::size_t axis, double repeats)
      : trace_(trace),
        curve_(curve),
        run_(run),
        axis_(axis),
        motor_(run.motor),
        way_(repeats * curve.length()),
        motion_(way_, run.speed, run.ramp_time),
        full_steps_a_pulse_(run.drive == Drive::kFullStep ? 1.0 : 0.5),
        radians_a_pulse_(kTurn / (4 * run.motor.pole_pairs) * full_steps_a_pulse_) {
    const double at_speed = motion_.duration() - 2 * motion_.ramp();
    measured_from_ = motion_.ramp() + (repeats == 1 && !repeatable(curve) ? 0 : at_speed / 3);
    measured_to_ = motion_.ramp() + at_speed;
    // At full-step positions both phases are on: the field is at 45 degrees.
    turn_field();
    const Currents currents = motor_.reference(field_angle() * run.motor.pole_pairs);
    state_ = {field_angle(), 0, currents[0], currents[1]};
  }

  // Returns false if steps were lost.
  bool execute() {
    bool over = false;
    for (std::size_t repeat = 0; !over; ++repeat) {
      const double offset = curve_.length() * static_cast<double>(repeat);
      over = offset + curve_.length() >= way_;
      for (const Event& event : trace_.events()) {
        if (event.direction[axis_] == 0) continue;
        const double way = offset + curve_.length() * fraction(event.time);
        if (way > way_) break;
        if (!advance(motion_.time_of(way))) return false;
        pulses_ += event.direction[axis_];
        turn_field();
      }
    }
    if (!advance(motion_.duration())) return false;
    return advance(time_ + kSettle) && std::abs(lag()) < 2;
  }

  AxisVibration vibration() const {
    AxisVibration result;
    const double mean_speed = run_.speed * radians_a_pulse_;
    if (measured_time_ > 0) result.rms_ripple = std::sqrt(squares_ / measured_time_) / mean_speed;
    result.largest_lag = largest_lag_;
    return result;
  }

 private:
  double fraction(std::uint64_t time) const {
    return static_cast<double>(time) / static_cast<double>(trace_.total_time());
  }
  double field_angle() const {
    return kTurn / 8 / run_.motor.pole_pairs + static_cast<double>(pulses_) * radians_a_pulse_;
  }
  void turn_field() { motor_.set_reference(motor_.reference(field_angle() * run_.motor.pole_pairs)); }
  double lag() const { return (field_angle() - state_[0]) / radians_a_pulse_ * full_steps_a_pulse_; }

  // The speed of the running point, converted to that of the motor, rad/s.
  double ideal_speed(double time) const {
    const double within = std::fmod(motion_.way_at(time), curve_.length()) / curve_.length();
    return curve_.tangent(within)[axis_] * motion_.speed_at(time) * radians_a_pulse_;
  }

  // Integrates until `end`; false if the rotor has slipped by a whole electrical turn (4 full steps).
  bool advance(double end) {
    const double span = end - time_;
    if (span <= 0) return true;
    const auto steps = static_cast<std::size_t>(std::ceil(span / run_.step));
    const double step = span / static_cast<double>(steps);
    // The lag is largest right after a pulse.
    if (measured(time_)) largest_lag_ = std::max(largest_lag_, std::abs(lag()));
    for (std::size_t i = 0; i < steps; ++i) {
      stepper_.do_step(std::cref(motor_), state_, time_, step);
      time_ += step;
      const double angle = std::abs(lag());
      if (!(angle < 4)) return false;
      if (!measured(time_)) continue;
      const double difference = state_[1] - ideal_speed(time_);
      squares_ += difference * difference * step;
      measured_time_ += step;
      largest_lag_ = std::max(largest_lag_, angle);
    }
    time_ = end;
    return true;
  }
  bool measured(double time) const { return time >= measured_from_ && time <= measured_to_; }

  const Trace& trace_;
  const IdealCurve& curve_;
  const MotorRun& run_;
  std::size_t axis_;
  Motor motor_;
  double way_;  // pulses along the path
  RampedMotion motion_;
  double full_steps_a_pulse_;
  double radians_a_pulse_;
  double measured_from_ = 0;
  double measured_to_ = 0;
  std::int64_t pulses_ = 0;
  State state_{};
  double time_ = 0;
  double squares_ = 0;
  double measured_time_ = 0;
  double largest_lag_ = 0;
  boost::numeric::odeint::runge_kutta4<State> stepper_;
};

}  // namespace

Vibration simulate_motors(const Trace& trace, const IdealCurve& curve, const MotorRun& run) {
  Vibration result;
  if (pulses_of(trace) == 0) return result;
  const double repeats = repeats_of(trace, curve, run);
  double squares = 0;
  for (std::size_t a = 0; a < trace.axes(); ++a) {
    if (trace.times(a).empty()) continue;
    AxisRun axis(trace, curve, run, a, repeats);
    if (!axis.execute()) result.lost_steps = true;
    result.axis[a] = axis.vibration();
    squares += result.axis[a].rms_ripple * result.axis[a].rms_ripple;
    result.largest_lag = std::max(result.largest_lag, result.axis[a].largest_lag);
  }
  result.rms_ripple = std::sqrt(squares);
  return result;
}

}  // namespace trammel::measure
