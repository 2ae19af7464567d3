// Vibration of a two-phase hybrid stepper driven by the pulses of a method.
//
// Equations (the usual ones of the two-phase hybrid stepper; MathWorks, Simscape Electrical, block "Stepper Motor"):
//   J dw/dt  = K (-i_a sin(N q) + i_b cos(N q)) - D sin(4 N q) - B w - friction * tanh(w / w_0)
//   dq/dt    = w
//   L di/dt  = v - R i - e,   e_a = -K w sin(N q),   e_b = K w cos(N q)
// with N pole pairs. The driver is an averaged chopper: v = R i_ref + (L / tau) (i_ref - i), limited to the supply.
// Full-step drive holds both phases at the rated current (i_a = +-I, i_b = +-I). Half-step drive adds positions in
// between, with one phase at sqrt(2) I, so that the torque is the same at all positions. A pulse turns the field by a
// quarter or an eighth of an electrical turn.
//
// The rotor starts at rest in its field, and ramps of constant acceleration lead to the speed and back to rest. So
// only the unevenness of the pulses makes it swing or lose steps, not an abrupt start or stop. On a ramp each pulse
// comes when the running point passes its place on the path. All methods get the same duration, and so the same mean
// speed. Integrated by Boost.Odeint (fourth-order Runge-Kutta, no step longer than `step`). Pure functions:
// thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "trammel/measure/ideal_curve.hpp"
#include "trammel/measure/trace.hpp"

namespace trammel::measure {

// A common NEMA 17 motor of 40 mm, MotionKing 17HS4401 (its data sheet: 1.8 degrees, 1.7 A, 1.5 ohm, 2.8 mH, holding
// torque 40 N cm, detent torque 2.2 N cm, rotor 54 g cm^2), on a 24 V driver. Values missing in the data sheet are
// assumed: a load of the rotor's own inertia, viscous damping that gives a damping ratio of about 0.04 with that
// inertia, and a friction load of a tenth of the holding torque.
struct MotorParameters {
  double pole_pairs = 50;           // 200 full steps per turn
  double rated_current = 1.7;       // A per phase, both on
  double holding_torque = 0.40;     // N m, both phases at rated current
  double detent_torque = 0.022;     // N m
  double resistance = 1.5;          // ohm per phase
  double inductance = 2.8e-3;       // H per phase
  double rotor_inertia = 54e-7;     // kg m^2
  double load_inertia = 54e-7;      // kg m^2
  double viscous_damping = 1.2e-3;  // N m s
  double friction = 0.04;           // N m, against the motion
  double friction_speed = 0.5;      // rad/s (w_0): friction reaches 76 % of its full torque
  double supply = 24;               // V
  double chopper_time = 50e-6;      // s (tau)
};

enum class Drive { kFullStep, kHalfStep };

struct MotorRun {
  MotorParameters motor;
  Drive drive = Drive::kFullStep;
  double speed = 200;             // mean speed along the path, pulses/s, > 0
  double ramp_time = 0.05;        // s per ramp; both ramps take at most two thirds of the way; 0: full speed at once
  double step = 10e-6;            // s, longest integration step, > 0
  std::size_t min_pulses = 240;   // a line or closed curve is repeated until all axes together have made this many
  std::size_t max_pulses = 1000;  // the run ends after this many; pulses of the ramps do not count in either
};

struct AxisVibration {
  double rms_ripple = 0;   // rms of (rotor speed - running point's speed), relative to the mean speed along the path
  double largest_lag = 0;  // largest angle between field and rotor, in full steps; at 2 the torque changes its sign
};

struct Vibration {
  double rms_ripple = 0;    // of all axes together (root of the sum of squares)
  double largest_lag = 0;   // of the worst axis
  bool lost_steps = false;  // a rotor came to rest off its field, or slipped by a whole electrical turn during the run
  std::array<AxisVibration, kTraceAxes> axis{};
};

// Runs one motor per axis. Ripple and lag are measured over the last two thirds at full speed; for an open arc, which
// can be run only once, over all of it. Lost steps are counted from the start until the rest after the end. After a
// loss the run ends, and ripple and lag keep their values of then. Precondition: the trace ends at the curve's end,
// or for closed curves at its start.
Vibration simulate_motors(const Trace& trace, const IdealCurve& curve, const MotorRun& run);

// Speeds a seventh of an octave apart, 100 to 6,400 pulses/s: from below the resonance of the motor above to beyond
// its pull-out speed.
inline constexpr std::size_t kSpeedsAnOctave = 7;
std::vector<double> sweep_speeds();

// Every trace at every speed; run.speed is ignored. The result does not depend on the number of threads. `progress`
// is called from time to time by the calling thread, with the fraction done.
std::vector<std::vector<Vibration>> sweep_motors(const std::vector<Trace>& traces, const IdealCurve& curve,
                                                 const MotorRun& run, const std::vector<double>& speeds,
                                                 unsigned threads, const std::function<void(double)>& progress = {});

// First and last speed of a range of a sweep.
struct SpeedRange {
  double first;
  double last;
};

// The ranges of neighbouring speeds at which steps were lost.
std::vector<SpeedRange> lost_at(const std::vector<double>& speeds, const std::vector<Vibration>& sweep);

}  // namespace trammel::measure
