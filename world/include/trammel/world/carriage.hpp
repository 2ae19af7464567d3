// The carriage of an axis, between two end stops that it cannot pass. Positions are pulses from the carriage's position
// at the start. One thread per object.
#pragma once

#include <cstdint>

#include "trammel/world/motor.hpp"

namespace trammel::world {

struct CarriageParameters {
  static constexpr std::int64_t kNone = std::int64_t{1} << 40;  // pulses: no stop on this side

  MotorParameters motor;
  std::int64_t low = -kNone;  // positions of the stops, pulses: low <= 0 <= high
  std::int64_t high = kNone;
};

class Carriage {
 public:
  // Throws std::invalid_argument for stops that do not enclose pulse 0, and as Motor does.
  explicit Carriage(const CarriageParameters& parameters);

  void pulse(int direction) { motor_.pulse(direction); }  // +1 or -1
  void advance(double seconds);                           // as Motor::advance()
  void set_power(bool on) { motor_.set_power(on); }

  double position() const { return motor_.position(); }          // pulses, exact
  std::int64_t place() const;                                    // pulses, rounded
  std::int64_t commanded() const { return motor_.commanded(); }  // pulses, as the card counts them
  std::int64_t lost() const { return motor_.lost(); }            // pulses; see Motor::lost()
  bool still() const { return motor_.still(); }
  const Motor& motor() const { return motor_; }

  // Number of steps of `seconds` in which the carriage cannot reach `edge`, pulses, whatever the card does: a bound
  // from its speed and the motor's largest torque.
  std::uint64_t steps_short_of(std::int64_t edge, double seconds) const;

 private:
  Motor motor_;
  double low_;
  double high_;
};

}  // namespace trammel::world
