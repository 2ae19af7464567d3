#include "motors.hpp"

#include <algorithm>

namespace trammel::platform {

Motors::Motors(const MotorParameters& parameters) : parameters_(parameters) { motors_.fill(world::Motor(parameters)); }

void Motors::pulse(double time, unsigned axis, int direction) {
  run_to(time);
  motors_[axis].pulse(direction);
}

void Motors::run_to(double time) {
  while (static_cast<double>(steps_ + 1) * kStep <= time) step();
}

void Motors::step() {
  ++steps_;
  std::uint16_t switches = 0;
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    move(axis);
    if (position(axis) <= parameters_.low) switches = static_cast<std::uint16_t>(switches | 1U << 2 * axis);
    if (position(axis) >= parameters_.high) switches = static_cast<std::uint16_t>(switches | 2U << 2 * axis);
  }
  switches_ = switches;
  if (sample_period_ > 0) sample();
}

void Motors::move(unsigned axis) {
  world::Motor& motor = motors_[axis];
  motor.advance(kStep);
  const double low = parameters_.low - parameters_.overtravel;
  const double high = parameters_.high + parameters_.overtravel;
  if (motor.position() < low || motor.position() > high) motor.hit(std::clamp(motor.position(), low, high));
}

void Motors::sample() {
  const double now = static_cast<double>(steps_) * kStep;
  if (!samples_.empty() && now < samples_.back().time + sample_period_) return;
  Sample sample{now, {}, {}};
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    sample.commanded[axis] = static_cast<double>(commanded(axis));
    sample.position[axis] = position(axis);
  }
  samples_.push_back(sample);
}

}  // namespace trammel::platform
