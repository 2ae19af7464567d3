// A stepper motor that moves a mass by a belt or a screw: the response of its rotor to pulses. One thread per object.
//
// A two-phase hybrid stepper with a constant-current driver, so that the torque depends on the angle only:
//   J dw/dt = T sin(field - rotor) - B w - F tanh(w / w_0),  J = rotor + mass * radius^2
// Field and rotor are electrical angles; an electrical turn is 4 full steps. A rotor that lags by half an electrical
// turn falls into the next one. It is then at rest a multiple of 4 full steps from its commanded position, as a real
// rotor is.
#pragma once

#include <cstdint>

namespace trammel::world {

struct MotorParameters {
  double holding_torque = 0.40;    // N m, both phases at the rated current; > 0
  double rotor_inertia = 54e-7;    // kg m^2; > 0
  double mass = 0.5;               // kg, moved mass; >= 0
  double radius = 6.366e-3;        // m, travel of the mass per radian: 40 mm per turn; > 0
  double friction = 0.04;          // N m, opposes the motion; >= 0
  double friction_speed = 0.5;     // rad/s (w_0): speed at which friction reaches 76 % of its full torque; > 0
  double damping = 0.004;          // N m s (B); >= 0
  double pulses_a_full_step = 16;  // microsteps per full step; > 0
  double full_steps_a_turn = 200;  // > 0
};

class Motor {
 public:
  static constexpr double kLongestStep = 20e-6;  // s, longest integration step

  // At rest, with field and rotor at pulse 0. Throws std::invalid_argument for parameters out of range, and for a motor
  // whose dynamics are too fast for steps of kLongestStep.
  explicit Motor(const MotorParameters& parameters = {});

  // A pulse turns the field by a microstep. direction: +1 or -1.
  void pulse(int direction) {
    commanded_ += direction;
    still_ = false;
  }
  // One integration step of `seconds`: > 0, at most kLongestStep.
  void advance(double seconds);
  // Switches the power. Without power there is no torque. When it returns, the rotor falls into the next position where
  // the field holds it.
  void set_power(bool on);
  bool powered() const { return powered_; }
  // An end stop holds the rotor at `pulses`: its speed becomes 0.
  void hit(double pulses);

  std::int64_t commanded() const { return commanded_; }  // pulses
  double position() const { return rotor_; }             // pulses
  double speed() const { return speed_; }                // pulses/s
  double largest_lag() const { return largest_lag_; }    // pulses, largest difference between field and rotor
  double strongest() const { return torque_; }           // pulses/s^2, largest by torque alone
  double pulses_a_turn() const { return turn_; }         // pulses per electrical turn: 4 full steps
  // Whether the rotor is at rest, and stays so until a pulse or a change of power.
  bool still() const { return still_; }
  // Commanded position minus the position where the rotor is held, pulses: a multiple of 4 full steps.
  std::int64_t lost() const;

  // A rotor closer to its held position and slower than these limits counts as at rest: pulses, pulses/s.
  static constexpr double kAtPlace = 1e-6;
  static constexpr double kAtRest = 1e-3;

 private:
  double lag() const { return static_cast<double>(commanded_) - rotor_; }
  void settle();

  double turn_;            // pulses per electrical turn
  double field_a_pulse_;   // electrical angle per pulse, rad
  double torque_;          // largest acceleration by torque, pulses/s^2
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
