// The machine file describes the machine that the card drives: a TOML file with a table [card] and a table
// [axis.<letter>] per axis; examples/machine.toml is the commented default. Plain data; the functions are pure and
// thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/card_map.hpp"

namespace trammel::machine {

// The order of the axes on the card; a machine has 1 to 8 of them.
inline constexpr std::string_view kAxisLetters = "XYZABCUVWE";
inline constexpr std::size_t kCoordinateSystems = 9;  // G54 .. G59.3

// Bounds of the card's clock, Hz.
inline constexpr std::uint32_t kSlowestClock = 1000;
inline constexpr std::uint32_t kFastestClock = std::numeric_limits<std::uint32_t>::max();

// what() is one line: "file:line: message", or "--set text: message".
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How an axis homes; the table [homing.<letter>], in LinuxCNC's terms. Velocities in mm/s (degrees/s).
struct AxisHoming {
  double search_velocity = 0;  // towards the switch; its sign is the direction; not 0
  // Velocity at the final edge. With the sign of search_velocity it is the edge into the switch, with the other sign
  // the edge off the switch. 0: the edge of the search is final (for a drive that reports its stall, which it does not
  // do at low speed).
  double latch_velocity = 0;
  double final_velocity = 0;   // velocity to final_position, > 0; 0: max_velocity
  double offset = 0;           // machine coordinate of the edge
  double final_position = 0;   // machine coordinate of the axis after homing
  double search_distance = 0;  // mm, > 0, within which the switch must be found; 0: 1.1 times max - min
  double squaring = 0;         // mm, > 0, bound for a gantry's second switch; 0: 1 % of max - min, 2 to 25
  bool use_index = false;      // the edge of the index input after the switch is final
  bool ignore_limits = false;  // limits of the axis stop nothing while homing: the home switch is one of them
  bool shared = false;         // switches of other axes use the same input: it must be inactive at the start
  // The switch is ignored until the axis has its speed, because a drive may report a stall earlier.
  bool at_speed = false;
  unsigned sequence = 0;  // 0 .. 31, in ascending order; axes with the same number home together
  std::string place;      // position in the file, for messages: "file:line: "

  int direction() const { return search_velocity < 0 ? -1 : 1; }
};

// Lengths in mm; degrees for the rotary letters A, B and C.
struct MachineAxis {
  char letter = 'X';
  double steps_per_mm = 0;        // pulses, > 0
  double max_velocity = 0;        // mm/s, > 0
  double max_acceleration = 0;    // mm/s^2, > 0
  double max_jerk = 0;            // mm/s^3, > 0; 0: not given
  double step_length_ns = 0;      // > 0
  double step_space_ns = 0;       // > 0
  double direction_setup_ns = 0;  // >= 0
  double direction_hold_ns = 0;   // >= 0
  bool inverted = false;
  // A second motor for the axis (gantry). It uses a further axis of the card, which makes the same steps.
  bool second_motor = false;
  bool second_inverted = false;  // direction of the second motor
  // The place of the axis's motors stays valid after an immediate stop and with disabled drives (KEEPS_PLACE), because
  // the mechanism cannot lose steps then. An external card needs map 3.3 for this.
  bool keeps_place = false;
  // Soft limits, machine coordinates, min < max; infinite if not given. Not enforced here.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool endless = false;                              // rotary axis declared to have no soft limits
  double overtravel = 0;                             // mm (degrees) from a limit switch to the mechanical end; >= 0
  double home = 0;                                   // machine coordinate for G28
  double second_home = 0;                            // machine coordinate for G30
  std::array<double, kCoordinateSystems> offsets{};  // of G54 .. G59.3, machine coordinates
  std::optional<AxisHoming> homing;                  // none: the axis cannot home
};

// Planning settings of the host; the table [motion]. Every entry is optional.
struct MotionSettings {
  double junction_deviation = 0.01;  // mm, >= 0; 0: every corner is a stop
  double max_override = 1;           // 1 .. 2: the limits are kept up to this feed override
  double hold_reserve = 0;           // 0 .. 0.9: fraction of each acceleration reserved for holds and override changes
  double window = 16384;             // most blocks in the look-ahead; integer, 2 .. 2^20
  double watchdog = 5;               // s, 0 .. 40: the card stops when the host is silent for this time; 0: never
  double stale_periods = 1;          // position streaming: periods bridged without data; integer, 0 .. 65535
};

// Outputs of the card that program words switch on, bit n: output n; the table [outputs]. A word that is not in the
// table switches no output; M62 to M65 are then refused. M3 and M4 switch off each other's outputs, M5 those of both;
// M9 switches off those of M7 and M8.
inline constexpr unsigned kMaxOutputs = 16;
struct MachineOutputs {
  std::uint16_t m3 = 0;  // spindle clockwise
  std::uint16_t m4 = 0;  // spindle counter-clockwise
  std::uint16_t m7 = 0;  // mist
  std::uint16_t m8 = 0;  // flood
  // Outputs of M62 to M65, by their P.
  std::array<std::uint16_t, kMaxOutputs> numbered{};

  // Outputs whose pulse width S sets; M3 and M4 switch them on, too. The table [spindle]; without it S has no effect.
  std::uint16_t pwm = 0;
  double pwm_hz = 1000;    // 1 .. 10^6
  double max_s = 1000;     // the S of full pulse width, > 0
  bool laser = false;      // off in rapids; M4: power follows the path speed; off at the cause of a stop
  double spin_up_s = 0;    // wait after M3, M4 and each new S; not for a laser
  double at_speed_s = 30;  // longest wait for an input with the role spindle at speed; not for a laser

  // Safe levels, which the card itself sets: 0 (off) or 1 (on). An output is in at most one of the off and on sets.
  std::uint16_t off_at_cause = 0;  // in the clock of a fault, and at an abort, such as a laser
  std::uint16_t on_at_cause = 0;
  std::uint16_t off_at_rest = 0;  // when the machine is at rest after a fault, and at an abort
  std::uint16_t on_at_rest = 0;
  // Outputs that follow the state of the drives and of the card, and the times of their sequence.
  std::uint16_t enable = 0;
  std::uint16_t brake = 0;
  std::uint16_t charge_pump = 0;
  std::uint16_t healthy = 0;
  double brake_release_ms = 0;  // from enabling the drives to releasing the brake
  double enable_delay_ms = 0;   // from releasing the brake to the first step
  double stop_delay_ms = 0;     // from the last step to the start of the disable sequence
  double brake_set_ms = 0;      // from setting the brake to disabling the drives
  double enable_idle_s = 0;     // time without motion until the drives are disabled; 0: never
  double charge_pump_hz = 1000;
  std::uint32_t disable_on = 0;  // faults that disable the drives at rest; bits of FAULT
  bool enable_manual = false;    // motion waits until a program enables the drives; else motion enables them
  std::string enable_axes;       // letters of the axes with these drives; empty: all axes
  // Whether the emergency stop ramps the axes or stops them at once; not given: the card's setting.
  std::optional<bool> emergency_stop_ramps;

  std::uint16_t spindle() const { return m3 | m4 | pwm; }
  std::uint16_t coolant() const { return m7 | m8; }
  std::uint16_t all_numbered() const {
    std::uint16_t all = 0;
    for (const std::uint16_t outputs : numbered) all = static_cast<std::uint16_t>(all | outputs);
    return all;
  }
  std::uint16_t of_words() const { return spindle() | coolant() | all_numbered(); }
  std::uint16_t roles() const { return enable | brake | charge_pump | healthy; }
  std::uint16_t safe_at_cause() const {
    return static_cast<std::uint16_t>(off_at_cause | on_at_cause | (laser ? pwm : 0));
  }
  std::uint16_t safe_at_rest() const { return off_at_rest | on_at_rest; }
  std::uint16_t safe() const { return safe_at_cause() | safe_at_rest(); }
  std::uint16_t all() const { return of_words() | safe() | roles(); }
};

// Length of a tool; the table [tools.<number>].
struct Tool {
  unsigned number = 0;                               // 1 .. kLargestTool
  std::array<double, card_map::kMaxAxes> offsets{};  // mm, degrees for A, B and C, by axis of the machine
};
inline constexpr unsigned kLargestTool = 999'999;

inline constexpr unsigned kMaxInputs = 32;
// The card's input of the probe; the table [probe].
struct Probe {
  std::optional<unsigned> input;
  bool touched_level = true;  // level of the input when the probe touches
};

// Inputs of the card that have a role; the table [inputs].
struct InputRole {
  std::uint32_t inputs = 0;      // bit n: input n; the role is active while at least one of them is
  std::optional<bool> closed;    // normally closed; if not given, limits are closed and others are not
  std::optional<double> filter;  // ms, 0 .. 20
  std::string place;             // position in the file, for messages: "file:line: "
};
enum class OnLimit { kAutomatic, kRamp, kImmediate };
enum class OnInput { kNothing, kRamp, kImmediate };
struct MachineInputs {
  // By the card's numbers (driver::Role); roles of an axis by its index.
  std::array<InputRole, 64> roles{};
  double filter = 1;          // ms, for inputs whose roles give none
  bool closed_level = false;  // level of the pin while its switch is closed: 0 with a pull-up and a switch to ground
  OnLimit on_limit = OnLimit::kAutomatic;
  std::string on_limit_place;
  OnInput on_drive_fault = OnInput::kRamp;
  OnInput on_probe = OnInput::kNothing;  // outside probing
  OnInput on_tool_setter = OnInput::kRamp;
  OnInput on_soft_limit = OnInput::kRamp;  // reaction to the card's own soft limits; never kNothing

  std::uint32_t used() const;  // inputs that have a role
  // Inputs that are read inverted: their active level is 0.
  std::uint32_t inverted() const;
  // Filter time of an input, ms: the longest of its roles.
  double filter_of(unsigned input) const;
};

// Relation between the card's axes and the machine's (trammel/kinematics/kinematics.hpp): the table [kinematics].
//   cartesian  a joint for each axis
//   corexy     the first two axes of the card are the motors A = X + Y and B = X - Y of crossed belts; steps_per_mm and
//              step times of X are A's, those of Y are B's, mm of belt
inline constexpr std::array<std::string_view, 2> kKinematics{"cartesian", "corexy"};
// Limits along a motor's own length (mm of belt); infinite: only the limits of the axes apply.
struct JointLimits {
  double velocity = std::numeric_limits<double>::infinity();      // mm/s
  double acceleration = std::numeric_limits<double>::infinity();  // mm/s^2
  double jerk = std::numeric_limits<double>::infinity();          // mm/s^3
};
struct MachineKinematics {
  std::string name{kKinematics[0]};
  JointLimits motor;  // corexy: limits of A and of B
};

struct Machine {
  std::uint32_t clock_hz = 0;     // kSlowestClock .. kFastestClock
  bool require_home = false;      // an external card moves only homed axes
  std::vector<MachineAxis> axes;  // in the card's order
  MachineKinematics kinematics;
  MotionSettings motion;
  MachineOutputs outputs;
  std::vector<Tool> tools;
  Probe probe;
  MachineInputs inputs;

  // Null if the machine file has no such tool.
  const Tool* tool(unsigned number) const;
  // Index of the axis on the card; `letter` in upper case.
  std::optional<std::size_t> axis(char letter) const;
  // The axes that have a second motor, by index. On the card these motors follow the axes, in this order.
  std::vector<std::size_t> second_motors() const;
  // Inputs with the role spindle at speed, and whether the run waits for them; a laser has no speed.
  std::uint32_t spindle_at_speed() const;
  bool awaits_spindle() const { return spindle_at_speed() != 0 && !outputs.laser; }
  // Axes of the card that the machine uses, at most 8.
  std::size_t motors() const { return axes.size() + second_motors().size(); }
};

// Duration of a hold from full speed to rest, s: v / (a / 2) of the axis for which this is longest, so the deceleration
// of a hold is at most half of every axis's acceleration. If the fraction h of it is reserved for holds (hold_reserve),
// v / (h a).
double hold_seconds(const Machine& machine);

// The fraction of each axis's acceleration that a hold from full speed may use: 1/2, or hold_reserve.
double hold_share(const Machine& machine);

// How limit switches stop the machine. They ramp only if each axis with a limit switch declares an overtravel of at
// least max_velocity * (filter + a scan + half of hold_seconds()), the distance that a ramp takes after the switch.
// Otherwise they stop at once.
struct LimitStop {
  bool ramps = false;
  // By axis: steps that the card may count beyond the switch on a ramp, 0 .. 65535. The card counts after the filter,
  // so the distance at max_velocity during the filter and a scan is subtracted.
  std::array<std::uint32_t, card_map::kMaxAxes> overtravel{};
};
LimitStop limit_stop(const Machine& machine);

// Each function throws MachineError for the first missing, unknown, non-numeric or out-of-range entry, and for a text
// of more than kLongestMachineText bytes. A file may be a pipe, but no other device.
inline constexpr std::size_t kLongestMachineText = 1 << 20;
Machine load_machine(const std::string& path);
Machine parse_machine(const std::string& toml_text, const std::string& name);

// Changes entries of the machine: "axis.x.steps_per_mm=20", "card.clock_hz=1e6"; any TOML assignment. Axes cannot be
// added. If it throws MachineError, the machine is unchanged.
void apply_override(Machine& machine, const std::string& text);

// The text of examples/machine.toml, and the machine that it describes.
const std::string& default_machine_text();
Machine default_machine();

}  // namespace trammel::machine
