// The machine file: what hangs on the card. A TOML file with a table [card] and one table [axis.<letter>] an axis;
// examples/machine.toml is the commented default. Plain data; the functions are pure and thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace trammel::machine {

// The order of the axes on the card; a machine has a subset of 1 to 8.
inline constexpr std::string_view kAxisLetters = "XYZABCUVWE";
inline constexpr std::size_t kCoordinateSystems = 6;  // G54 .. G59

// Message: "file:line: what is wrong", or "--set text: what is wrong".
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
  double max_jerk = 0;            // mm/s^3, > 0
  double step_length_ns = 0;      // > 0
  double step_space_ns = 0;       // > 0
  double direction_setup_ns = 0;  // >= 0
  double direction_hold_ns = 0;   // >= 0
  bool inverted = false;
  double home = 0;                                   // machine coordinate that G28 goes to
  std::array<double, kCoordinateSystems> offsets{};  // of G54 .. G59, machine coordinates
};

struct Machine {
  std::uint32_t clock_hz = 0;     // > 0
  std::vector<MachineAxis> axes;  // in the card's order

  // Index of the axis on the card; `letter` in upper case.
  std::optional<std::size_t> axis(char letter) const;
};

// A time as register value: rounded up to whole clocks, at least 1 for any time above 0.
// Throws std::out_of_range when it does not fit the 16 bits of the card's registers.
std::uint16_t clocks_from_ns(double nanoseconds, std::uint32_t clock_hz);

// Each throws MachineError for the first missing, unknown, non-numeric or out-of-range entry.
Machine load_machine(const std::string& path);
Machine parse_machine(const std::string& toml_text, const std::string& name);

// Changes entries: "axis.x.steps_per_mm=20", "card.clock_hz=1e6"; any TOML assignment. Axes cannot be added.
// Throws MachineError and leaves the machine as it was.
void apply_override(Machine& machine, const std::string& text);

// The text of examples/machine.toml, and the machine that it describes.
const std::string& default_machine_text();
Machine default_machine();

}  // namespace trammel::machine
