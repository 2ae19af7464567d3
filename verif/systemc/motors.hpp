// A machine on STEP and DIR: an axis has a stepper motor that moves a carriage by a belt, with inertia, friction, a
// switch near each end of its travel and a stop behind it. Plain C++; one thread.
//
// A two-phase hybrid stepper whose driver keeps the current, so that the torque depends on the angle alone:
//   J dw/dt = T sin(field - rotor) - B w - F tanh(w / w_0),  J = rotor + mass * radius^2
// with field and rotor in electrical angle, a turn of which is 4 full steps. A rotor that is left behind by half of
// such a turn falls into the next one: it stands a multiple of 4 full steps beside its commanded place, as a real one
// does.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pins.hpp"

namespace trammel::platform {

struct MotorParameters {
  double holding_torque = 0.40;    // N m, both phases at the rated current
  double rotor_inertia = 54e-7;    // kg m^2
  double mass = 0.5;               // kg, what the belt moves
  double radius = 6.366e-3;        // m, of the pulley: 40 mm a turn
  double friction = 0.04;          // N m, against the motion
  double friction_speed = 0.5;     // rad/s (w_0): where friction reaches 76 % of its full torque
  double damping = 0.004;          // N m s (B)
  double pulses_a_full_step = 16;  // microsteps
  double full_steps_a_turn = 200;
  // Travel from where the machine stands at the beginning, pulses. The switches close at the ends, the stops come so
  // many pulses behind them.
  double low = -8000;
  double high = 24000;
  double overtravel = 400;
};

class Motors {
 public:
  static constexpr double kStep = 20e-6;  // s of integration

  explicit Motors(const MotorParameters& parameters = {});

  // A pulse for `axis` at this time, s; times do not fall. direction: +1 or -1.
  void pulse(double time, unsigned axis, int direction);
  // What happens until then.
  void run_to(double time);

  std::int64_t commanded(unsigned axis) const { return commanded_[axis]; }  // pulses
  double position(unsigned axis) const { return rotor_[axis]; }             // pulses
  double largest_lag(unsigned axis) const { return largest_lag_[axis]; }    // pulses, between field and rotor
  // Inputs of the card: bit 2 n: the switch at the low end of axis n, bit 2 n + 1: at the high end; 1: closed.
  std::uint16_t switches() const { return switches_; }

  // A sample every `period` of all axes, from now on.
  struct Sample {
    double time;  // s
    std::array<double, kAxes> commanded;
    std::array<double, kAxes> position;
  };
  void record(double period) { sample_period_ = period; }
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  void step();
  void move(unsigned axis);
  void sample();

  MotorParameters parameters_;
  double field_a_pulse_;     // rad electrical
  double torque_;            // pulses/s^2 at the largest torque
  double damping_;           // 1/s
  double friction_;          // pulses/s^2
  double friction_speed_;    // pulses/s
  std::uint64_t steps_ = 0;  // of integration, done
  std::array<std::int64_t, kAxes> commanded_{};
  std::array<double, kAxes> rotor_{};
  std::array<double, kAxes> speed_{};  // pulses/s
  std::array<double, kAxes> largest_lag_{};
  std::uint16_t switches_ = 0;
  double sample_period_ = 0;
  std::vector<Sample> samples_;
};

}  // namespace trammel::platform
