#include "motors.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::platform {

namespace {

constexpr double kTurn = 6.283185307179586;

}  // namespace

Motors::Motors(const MotorParameters& parameters) : parameters_(parameters) {
  const MotorParameters& p = parameters;
  const double inertia = p.rotor_inertia + p.mass * p.radius * p.radius;
  const double pulses_a_radian = p.pulses_a_full_step * p.full_steps_a_turn / kTurn;
  field_a_pulse_ = kTurn / (4 * p.pulses_a_full_step);
  torque_ = p.holding_torque / inertia * pulses_a_radian;
  damping_ = p.damping / inertia;
  friction_ = p.friction / inertia * pulses_a_radian;
  friction_speed_ = p.friction_speed * pulses_a_radian;
}

void Motors::pulse(double time, unsigned axis, int direction) {
  run_to(time);
  commanded_[axis] += direction;
}

void Motors::run_to(double time) {
  while (static_cast<double>(steps_ + 1) * kStep <= time) step();
}

void Motors::step() {
  ++steps_;
  std::uint16_t switches = 0;
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    move(axis);
    if (rotor_[axis] <= parameters_.low) switches = static_cast<std::uint16_t>(switches | 1U << 2 * axis);
    if (rotor_[axis] >= parameters_.high) switches = static_cast<std::uint16_t>(switches | 2U << 2 * axis);
  }
  switches_ = switches;
  if (sample_period_ > 0) sample();
}

// Speed first, then the place by the new speed: that keeps the energy of a rotor that swings.
void Motors::move(unsigned axis) {
  double& rotor = rotor_[axis];
  double& speed = speed_[axis];
  const double lag = static_cast<double>(commanded_[axis]) - rotor;
  largest_lag_[axis] = std::max(largest_lag_[axis], std::abs(lag));
  if (lag == 0 && speed == 0) return;
  speed += kStep * (torque_ * std::sin(field_a_pulse_ * lag) - damping_ * speed -
                    friction_ * std::tanh(speed / friction_speed_));
  rotor += kStep * speed;
  const double low = parameters_.low - parameters_.overtravel;
  const double high = parameters_.high + parameters_.overtravel;
  if (rotor >= low && rotor <= high) return;
  rotor = std::clamp(rotor, low, high);
  speed = 0;
}

void Motors::sample() {
  const double now = static_cast<double>(steps_) * kStep;
  if (!samples_.empty() && now < samples_.back().time + sample_period_) return;
  Sample sample{now, {}, rotor_};
  for (unsigned axis = 0; axis < kAxes; ++axis) sample.commanded[axis] = static_cast<double>(commanded_[axis]);
  samples_.push_back(sample);
}

}  // namespace trammel::platform
