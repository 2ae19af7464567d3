// What an axis moves, between two end stops that it cannot pass. Pulses count from where it stands at the beginning.
// One object, one thread.
#pragma once

#include <cstdint>

#include "trammel/world/motor.hpp"

namespace trammel::world {

struct CarriageParameters {
  static constexpr std::int64_t kNone = std::int64_t{1} << 40;  // pulses: no stop on a side

  MotorParameters motor;
  std::int64_t low = -kNone;  // pulses, where the stops are: low <= 0 <= high
  std::int64_t high = kNone;
};

class Carriage {
 public:
  // Throws std::invalid_argument for stops that it does not stand between, and as Motor does.
  explicit Carriage(const CarriageParameters& parameters);

  void pulse(int direction) { motor_.pulse(direction); }  // +1 or -1
  void advance(double seconds);                           // as of Motor
  void set_power(bool on) { motor_.set_power(on); }

  double position() const { return motor_.position(); }          // pulses, exact
  std::int64_t place() const;                                    // pulses, rounded
  std::int64_t commanded() const { return motor_.commanded(); }  // pulses, as the card counts them
  std::int64_t lost() const { return motor_.lost(); }            // pulses: commanded less where it is held
  bool still() const { return motor_.still(); }
  const Motor& motor() const { return motor_; }

  // Steps of `seconds` in which it surely does not come to `edge`, pulses, whatever the card does: from its speed, and
  // the motor's strongest pull.
  std::uint64_t steps_short_of(std::int64_t edge, double seconds) const;

 private:
  Motor motor_;
  double low_;
  double high_;
};

}  // namespace trammel::world
