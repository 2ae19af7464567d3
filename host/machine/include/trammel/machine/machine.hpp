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
  // Soft limits, machine coordinates, min < max; infinite where none is given. Nothing checks them here.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double home = 0;                                   // machine coordinate that G28 goes to
  double second_home = 0;                            // and G30
  std::array<double, kCoordinateSystems> offsets{};  // of G54 .. G59.3, machine coordinates
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
// does not name switch none. M3 and M4 switch off what the other has, M5 both; M9 switches off what M7 and M8 have.
inline constexpr unsigned kMaxOutputs = 16;
struct MachineOutputs {
  std::uint16_t m3 = 0;  // spindle clockwise
  std::uint16_t m4 = 0;  // and counter-clockwise
  std::uint16_t m7 = 0;  // mist
  std::uint16_t m8 = 0;  // flood

  std::uint16_t spindle() const { return m3 | m4; }
  std::uint16_t coolant() const { return m7 | m8; }
  std::uint16_t all() const { return spindle() | coolant(); }
};

// How long a tool is; the table [tools.<number>].
struct Tool {
  unsigned number = 0;                               // 1 .. kLargestTool
  std::array<double, card_map::kMaxAxes> offsets{};  // mm, degrees for A, B and C, by axis of the machine
};
inline constexpr unsigned kLargestTool = 999'999;

inline constexpr unsigned kMaxInputs = 16;
// The card's input that a probe is at; the table [probe].
struct Probe {
  std::optional<unsigned> input;
  bool touched_level = true;  // of the input, when it touches
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
  std::vector<MachineAxis> axes;  // in the card's order
  MachineKinematics kinematics;
  MotionSettings motion;
  MachineOutputs outputs;
  std::vector<Tool> tools;
  Probe probe;

  // Nothing where the machine file has no such tool.
  const Tool* tool(unsigned number) const;
  // Index of the axis on the card; `letter` in upper case.
  std::optional<std::size_t> axis(char letter) const;
  // The axes that have a second motor, by index. On the card these motors follow the axes, in this order.
  std::vector<std::size_t> second_motors() const;
  // Axes of the card that it takes, at most 8.
  std::size_t motors() const { return axes.size() + second_motors().size(); }
};

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
