#include "trammel/world/motor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trammel::world {

namespace {

constexpr double kTurn = 6.283185307179586;

void check(const MotorParameters& p) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  const auto not_negative = [](double value) { return value >= 0 && std::isfinite(value); };
  if (!positive(p.holding_torque) || !positive(p.rotor_inertia) || !positive(p.radius) || !positive(p.friction_speed) ||
      !positive(p.pulses_a_full_step) || !positive(p.full_steps_a_turn)) {
    throw std::invalid_argument("a motor's torque, rotor, radius, friction's speed and steps must be greater than 0");
  }
  if (!not_negative(p.mass) || !not_negative(p.friction) || !not_negative(p.damping)) {
    throw std::invalid_argument("a motor's mass, friction and damping must be 0 or more");
  }
}

}  // namespace

Motor::Motor(const MotorParameters& p) {
  check(p);
  const double inertia = p.rotor_inertia + p.mass * p.radius * p.radius;
  const double pulses_a_radian = p.pulses_a_full_step * p.full_steps_a_turn / kTurn;
  turn_ = 4 * p.pulses_a_full_step;
  field_a_pulse_ = kTurn / turn_;
  torque_ = p.holding_torque / inertia * pulses_a_radian;
  damping_ = p.damping / inertia;
  friction_ = p.friction / inertia * pulses_a_radian;
  friction_speed_ = p.friction_speed * pulses_a_radian;
  const double swing = torque_ * field_a_pulse_ * kLongestStep * kLongestStep;
  if (swing + (damping_ + friction_ / friction_speed_) * kLongestStep > 1) {
    throw std::invalid_argument(
        "a motor's rotor is too light for its torque, friction or damping: it would swing within steps of 20 "
        "microseconds; a larger inertia or mass, or less of the others");
  }
}

// Integrates the speed first, then the position with the new speed (symplectic Euler): this conserves the energy of a
// rotor that oscillates.
void Motor::advance(double seconds) {
  const double behind = lag();
  largest_lag_ = std::max(largest_lag_, std::abs(behind));
  if (still_) return;
  const double torque = powered_ ? torque_ * std::sin(field_a_pulse_ * behind) : 0;
  speed_ += seconds * (torque - damping_ * speed_ - friction_ * std::tanh(speed_ / friction_speed_));
  rotor_ += seconds * speed_;
  settle();
}

void Motor::set_power(bool on) {
  if (on == powered_) return;
  powered_ = on;
  still_ = false;
}

void Motor::hit(double pulses) {
  rotor_ = pulses;
  speed_ = 0;
}

std::int64_t Motor::lost() const { return std::llround(std::round(lag() / turn_) * turn_); }

void Motor::settle() {
  if (std::abs(speed_) > kAtRest) return;
  if (powered_) {
    const double from_place = std::remainder(lag(), turn_);
    if (std::abs(from_place) > kAtPlace) return;
    rotor_ += from_place;
  }
  speed_ = 0;
  still_ = true;
}

}  // namespace trammel::world
