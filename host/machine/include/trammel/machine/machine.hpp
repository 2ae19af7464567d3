// The machine file: the machine that the card drives. A TOML file with a table [card] and a table [axis.<letter>] per
// axis; examples/machine.toml is the commented default. Plain data; the functions are pure and thread-safe.
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

// The order of the axes on the card; a machine has a subset of 1 to 8.
inline constexpr std::string_view kAxisLetters = "XYZABCUVWE";
inline constexpr std::size_t kCoordinateSystems = 9;  // G54 .. G59.3

// Of the card, Hz.
inline constexpr std::uint32_t kSlowestClock = 1000;
inline constexpr std::uint32_t kFastestClock = std::numeric_limits<std::uint32_t>::max();

// Message, one line: "file:line: what is wrong", or "--set text: what is wrong".
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How an axis finds its place; the table [homing.<letter>], in LinuxCNC's terms. Velocities in mm/s (degrees/s).
struct AxisHoming {
  double search_velocity = 0;  // towards the switch; its sign is the direction; not 0
  // Of the edge that counts: with the sign of search_velocity the one into the switch, with the other sign the one off
  // it. 0: the edge of the search counts (a drive that reports its stall, which a slow axis does not).
  double latch_velocity = 0;
  double final_velocity = 0;   // to final_position, > 0; 0: max_velocity
  double offset = 0;           // machine coordinate of the edge
  double final_position = 0;   // machine coordinate that the axis goes to in the end
  double search_distance = 0;  // mm, > 0, until the switch must have come; 0: 1.1 times max - min
  double squaring = 0;     // mm, > 0, by which a gantry's second switch may come later; 0: 1 % of max - min, 2 to 25
  bool use_index = false;  // the edge of the index input behind the switch counts
  bool ignore_limits = false;  // the axis's limits stop nothing meanwhile: its home switch is one of them
  bool shared = false;         // other axes' switches are at the same input: it must be free at the start
  // The switch is not looked at before the axis has its speed, since a drive may report a stall before.
  bool at_speed = false;
  unsigned sequence = 0;  // 0 .. 31, in rising order; axes with the same number home together
  std::string place;      // where it stands, for messages: "file:line: "

  int direction() const { return search_velocity < 0 ? -1 : 1; }
};

// Lengths in mm; for the rotary letters A, B and C read degrees.
struct MachineAxis {
  char letter = 'X';
  double steps_per_mm = 0;        // pulses, > 0
  double max_velocity = 0;        // mm/s, > 0
  double max_acceleration = 0;    // mm/s^2, > 0
  double max_jerk = 0;            // mm/s^3, > 0; 0: none given
  double step_length_ns = 0;      // > 0
  double step_space_ns = 0;       // > 0
  double direction_setup_ns = 0;  // >= 0
  double direction_hold_ns = 0;   // >= 0
  bool inverted = false;
  // A second motor on the letter (gantry): its pins are those of a further axis of the card and make the same steps.
  bool second_motor = false;
  bool second_inverted = false;  // its direction
  // The place of its motors outlives an immediate stop and disabled drives (KEEPS_PLACE), since its mechanism cannot
  // lose steps by them. A card outside needs map 3.3 for it.
  bool keeps_place = false;
  // Soft limits, machine coordinates, min < max; infinite where none is given. Nothing checks them here.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool endless = false;                              // a rotary axis without soft limits, which says so
  double overtravel = 0;                             // beyond a limit switch, before something hits; >= 0
  double home = 0;                                   // machine coordinate that G28 goes to
  double second_home = 0;                            // and G30
  std::array<double, kCoordinateSystems> offsets{};  // of G54 .. G59.3, machine coordinates
  std::optional<AxisHoming> homing;                  // none: the axis has no switch to home by
};

// How the host plans; the table [motion], each entry of which may be left out.
struct MotionSettings {
  double junction_deviation = 0.01;  // mm, >= 0; 0: every corner is a stop
  double max_override = 1;           // 1 .. 2: limits hold up to this feed override
  double hold_reserve = 0;           // 0 .. 0.9: share of each acceleration kept for holds and changes of the override
  double window = 16384;             // blocks that look-ahead sees at most; whole, 2 .. 2^20
  double watchdog = 5;               // s, 0 .. 40: the card stops when the host is silent for so long; 0: never
  double stale_periods = 1;          // position streaming: periods that the card goes on alone; whole, 0 .. 65535
};

// Outputs of the card that words of a program switch on, bit n: output n; the table [outputs]. Words that the table
// does not name switch none, and M62 to M65 are refused then. M3 and M4 switch off what the other has, M5 both; M9
// switches off what M7 and M8 have.
inline constexpr unsigned kMaxOutputs = 16;
struct MachineOutputs {
  std::uint16_t m3 = 0;  // spindle clockwise
  std::uint16_t m4 = 0;  // and counter-clockwise
  std::uint16_t m7 = 0;  // mist
  std::uint16_t m8 = 0;  // flood
  // Of M62 to M65, by their P.
  std::array<std::uint16_t, kMaxOutputs> numbered{};

  // Outputs whose pulses S sets; M3 and M4 switch them on, too. The table [spindle]; without it S has no effect.
  std::uint16_t pwm = 0;
  double pwm_hz = 1000;    // 1 .. 10^6
  double max_s = 1000;     // the S of full pulses, > 0
  bool laser = false;      // dark in traverses; M4: power follows the speed on the path; off at the cause of a stop
  double spin_up_s = 0;    // after M3, M4 and each new S; not of a laser
  double at_speed_s = 30;  // the longest wait then for an input with the role spindle at speed; not of a laser

  // Switched by the card itself, to 0 (off) or to 1 (on): an output is in one of the two.
  std::uint16_t off_at_cause = 0;  // in the clock of a fault, and at an abort: a laser
  std::uint16_t on_at_cause = 0;
  std::uint16_t off_at_rest = 0;  // when the machine has come to rest after a fault, and at an abort
  std::uint16_t on_at_rest = 0;
  // Outputs that follow the drives and the card, and the times of their sequence.
  std::uint16_t enable = 0;
  std::uint16_t brake = 0;
  std::uint16_t charge_pump = 0;
  std::uint16_t healthy = 0;
  double brake_release_ms = 0;  // from the enable of the drives to the release of the brake
  double enable_delay_ms = 0;   // from there to the first step
  double stop_delay_ms = 0;     // after the last step, when the drives are to be disabled
  double brake_set_ms = 0;      // from the brake's setting to the disable
  double enable_idle_s = 0;     // without motion, until the drives are disabled; 0: never
  double charge_pump_hz = 1000;
  std::uint32_t disable_on = 0;  // faults that disable the drives at rest; bits of FAULT
  bool enable_manual = false;    // motion waits for a program's order to enable the drives; else it enables them
  std::string enable_axes;       // letters of the axes whose drives these are; none: of all axes
  // How the emergency stop stops the axes: on a ramp, or at once; none given: as the card has it.
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

// How long a tool is; the table [tools.<number>].
struct Tool {
  unsigned number = 0;                               // 1 .. kLargestTool
  std::array<double, card_map::kMaxAxes> offsets{};  // mm, degrees for A, B and C, by axis of the machine
};
inline constexpr unsigned kLargestTool = 999'999;

inline constexpr unsigned kMaxInputs = 32;
// The card's input that a probe is at; the table [probe].
struct Probe {
  std::optional<unsigned> input;
  bool touched_level = true;  // of the input, when it touches
};

// Inputs of the card that have a role; the table [inputs].
struct InputRole {
  std::uint32_t inputs = 0;      // bit n: input n; the role is active while one of them is
  std::optional<bool> closed;    // normally; without it limits are, and others are not
  std::optional<double> filter;  // ms, 0 .. 20
  std::string place;             // where it stands, for messages: "file:line: "
};
enum class OnLimit { kAutomatic, kRamp, kImmediate };
enum class OnInput { kNothing, kRamp, kImmediate };
struct MachineInputs {
  // By the card's numbers (driver::Role); those of an axis by its index.
  std::array<InputRole, 64> roles{};
  double filter = 1;          // ms, of inputs whose roles name none
  bool closed_level = false;  // of the pin, while a switch at it is closed: 0 with a pull-up and a switch to ground
  OnLimit on_limit = OnLimit::kAutomatic;
  std::string on_limit_place;
  OnInput on_drive_fault = OnInput::kRamp;
  OnInput on_probe = OnInput::kNothing;  // outside probing
  OnInput on_tool_setter = OnInput::kRamp;
  OnInput on_soft_limit = OnInput::kRamp;  // of the card's own soft limits; never kNothing

  std::uint32_t used() const;  // inputs that have a role
  // Those that read inverted: where the active level is 0.
  std::uint32_t inverted() const;
  // Of an input, ms: the longest that one of its roles names.
  double filter_of(unsigned input) const;
};

// How the card's axes move the machine's (trammel/kinematics/kinematics.hpp): the table [kinematics].
//   cartesian  a joint for each axis
//   corexy     the first two axes of the card are the motors A = X + Y and B = X - Y of crossed belts; steps_per_mm and
//              step times of X are A's, those of Y are B's, mm of belt
inline constexpr std::array<std::string_view, 2> kKinematics{"cartesian", "corexy"};
// Along a motor's own length (mm of belt); infinite: the axes' limits alone hold.
struct JointLimits {
  double velocity = std::numeric_limits<double>::infinity();      // mm/s
  double acceleration = std::numeric_limits<double>::infinity();  // mm/s^2
  double jerk = std::numeric_limits<double>::infinity();          // mm/s^3
};
struct MachineKinematics {
  std::string name{kKinematics[0]};
  JointLimits motor;  // corexy: of A and of B
};

struct Machine {
  std::uint32_t clock_hz = 0;     // kSlowestClock .. kFastestClock
  bool require_home = false;      // a card outside moves an axis only when it was homed
  std::vector<MachineAxis> axes;  // in the card's order
  MachineKinematics kinematics;
  MotionSettings motion;
  MachineOutputs outputs;
  std::vector<Tool> tools;
  Probe probe;
  MachineInputs inputs;

  // Nothing where the machine file has no such tool.
  const Tool* tool(unsigned number) const;
  // Index of the axis on the card; `letter` in upper case.
  std::optional<std::size_t> axis(char letter) const;
  // The axes that have a second motor, by index. On the card these motors follow the axes, in this order.
  std::vector<std::size_t> second_motors() const;
  // Inputs that say that the spindle is at speed, and whether anybody waits for them; a laser has no speed.
  std::uint32_t spindle_at_speed() const;
  bool awaits_spindle() const { return spindle_at_speed() != 0 && !outputs.laser; }
  // Axes of the card that it takes, at most 8.
  std::size_t motors() const { return axes.size() + second_motors().size(); }
};

// Seconds that a hold takes from full speed to a stop: v / (a / 2) of the axis where that is longest, so that a hold's
// deceleration is half of every axis's acceleration at most; v / (h a) where h of it is kept for holds (hold_reserve).
double hold_seconds(const Machine& machine);

// The share of each axis's acceleration that a hold from full speed may take: 1/2, or hold_reserve.
double hold_share(const Machine& machine);

// How limits stop the machine. On a ramp only where each axis with a limit declares an overtravel of at least
// max_velocity * (filter + a scan + half of hold_seconds()): the way that a ramp takes after the switch. Else at once.
struct LimitStop {
  bool ramps = false;
  // By axis: steps that the card may count beyond the switch on a ramp, 0 .. 65535. It counts behind the filter, so the
  // way at max_velocity during the filter and a scan is taken off.
  std::array<std::uint32_t, card_map::kMaxAxes> overtravel{};
};
LimitStop limit_stop(const Machine& machine);

// Each throws MachineError for the first missing, unknown, non-numeric or out-of-range entry, and for a text of more
// than kLongestMachineText bytes. A file may be a pipe, but no other device.
inline constexpr std::size_t kLongestMachineText = 1 << 20;
Machine load_machine(const std::string& path);
Machine parse_machine(const std::string& toml_text, const std::string& name);

// Changes entries: "axis.x.steps_per_mm=20", "card.clock_hz=1e6"; any TOML assignment. Axes cannot be added.
// Throws MachineError and leaves the machine as it was.
void apply_override(Machine& machine, const std::string& text);

// The text of examples/machine.toml, and the machine that it describes.
const std::string& default_machine_text();
Machine default_machine();

}  // namespace trammel::machine
