// A machine on STEP and DIR. Each axis has a stepper motor (equations in trammel/world/motor.hpp) that moves a
// carriage by a belt, with a switch near each end of its travel and a stop behind it. Plain C++; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pins.hpp"
#include "trammel/world/motor.hpp"

namespace trammel::platform {

struct MotorParameters : world::MotorParameters {
  // Travel from the initial position, pulses. The switches close at the ends; the stops are `overtravel` pulses
  // behind them.
  double low = -8000;
  double high = 24000;
  double overtravel = 400;
};

class Motors {
 public:
  static constexpr double kStep = world::Motor::kLongestStep;  // s of integration

  explicit Motors(const MotorParameters& parameters = {});

  // A pulse for `axis` at `time`, s; times never decrease. direction: +1 or -1.
  void pulse(double time, unsigned axis, int direction);
  // Simulates until `time`.
  void run_to(double time);

  std::int64_t commanded(unsigned axis) const { return motors_[axis].commanded(); }  // pulses
  double position(unsigned axis) const { return motors_[axis].position(); }          // pulses
  double largest_lag(unsigned axis) const { return motors_[axis].largest_lag(); }    // pulses, between field and rotor
  // Inputs of the card: bit 2 n: the switch at the low end of axis n, bit 2 n + 1: at the high end; 1: closed.
  std::uint16_t switches() const { return switches_; }

  // Records a sample of all axes every `period`, from now on.
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
  std::array<world::Motor, kAxes> motors_;
  std::uint64_t steps_ = 0;  // integration steps done
  std::uint16_t switches_ = 0;
  double sample_period_ = 0;
  std::vector<Sample> samples_;
};

}  // namespace trammel::platform
