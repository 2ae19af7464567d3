// A stepper motor that pulls a mass by a belt or a screw: what a pulse does to a rotor. One object, one thread.
//
// A two-phase hybrid stepper whose driver keeps the current, so that the torque depends on the angle alone:
//   J dw/dt = T sin(field - rotor) - B w - F tanh(w / w_0),  J = rotor + mass * radius^2
// with field and rotor in electrical angle, a turn of which is 4 full steps. A rotor that is left behind by half of
// such a turn falls into the next one: it stands a multiple of 4 full steps beside its commanded place, as a real one
// does.
#pragma once

#include <cstdint>

namespace trammel::world {

struct MotorParameters {
  double holding_torque = 0.40;    // N m, both phases at the rated current; > 0
  double rotor_inertia = 54e-7;    // kg m^2; > 0
  double mass = 0.5;               // kg, what it pulls; >= 0
  double radius = 6.366e-3;        // m, way of the mass a radian: 40 mm a turn; > 0
  double friction = 0.04;          // N m, against the motion; >= 0
  double friction_speed = 0.5;     // rad/s (w_0): where friction reaches 76 % of its full torque; > 0
  double damping = 0.004;          // N m s (B); >= 0
  double pulses_a_full_step = 16;  // microsteps; > 0
  double full_steps_a_turn = 200;  // > 0
};

class Motor {
 public:
  static constexpr double kLongestStep = 20e-6;  // s of integration

  // At rest, field and rotor at pulse 0. Throws std::invalid_argument for what is out of range, and for a motor that is
  // too lively for steps of kLongestStep.
  explicit Motor(const MotorParameters& parameters = {});

  // A pulse: the field turns by a microstep. direction: +1 or -1.
  void pulse(int direction) {
    commanded_ += direction;
    still_ = false;
  }
  // One step of integration, `seconds` long: > 0, at most kLongestStep.
  void advance(double seconds);
  // Without power there is no torque. With it again the rotor falls into the next place where the field holds it.
  void set_power(bool on);
  bool powered() const { return powered_; }
  // Something stops the rotor there: it stands.
  void hit(double pulses);

  std::int64_t commanded() const { return commanded_; }  // pulses
  double position() const { return rotor_; }             // pulses
  double speed() const { return speed_; }                // pulses/s
  double largest_lag() const { return largest_lag_; }    // pulses, between field and rotor
  double strongest() const { return torque_; }           // pulses/s^2, by the motor's torque alone
  double pulses_a_turn() const { return turn_; }         // of the field: 4 full steps
  // Neither moves nor will without a pulse or power.
  bool still() const { return still_; }
  // Pulses by which the place that the rotor is held at lies behind the commanded one: a multiple of 4 full steps.
  std::int64_t lost() const;

  // A rotor closer to its place and slower than these stands: pulses, pulses/s.
  static constexpr double kAtPlace = 1e-6;
  static constexpr double kAtRest = 1e-3;

 private:
  double lag() const { return static_cast<double>(commanded_) - rotor_; }
  void settle();

  double turn_;            // pulses an electrical turn
  double field_a_pulse_;   // rad electrical
  double torque_;          // pulses/s^2 at the largest torque
  double damping_;         // 1/s
  double friction_;        // pulses/s^2
  double friction_speed_;  // pulses/s
  std::int64_t commanded_ = 0;
  double rotor_ = 0;
  double speed_ = 0;
  double largest_lag_ = 0;
  bool powered_ = true;
  bool still_ = true;
};

}  // namespace trammel::world
