#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// A copy of examples/machine.toml, so that the library needs no installed files; a test compares the two.
const std::string& default_machine_text() {
  static const std::string text =
      R"toml(# A machine: what the card drives. This file is also the default, used when no machine file is given.
# Lengths in mm (degrees for A, B and C), times in seconds unless the name says nanoseconds.

[card]
clock_hz = 100_000_000         # of the card; a simulated card may run at any other

# One table an axis, of the letters X Y Z A B C U V W E, in this order on the card; 1 to 8 axes.
[axis.x]
steps_per_mm = 80              # pulses
max_velocity = 150             # mm/s; also the speed of G0
max_acceleration = 1000        # mm/s^2
max_jerk = 50_000              # mm/s^3, for S-curves
step_length_ns = 2000          # STEP high
step_space_ns = 2000           # STEP low before the next pulse
direction_setup_ns = 1000      # DIR stable before the leading edge of STEP
direction_hold_ns = 1000       # DIR stable after the trailing edge of STEP
inverted = false               # DIR pin inverted
# Optional, 0 when absent:
# home = 0                     # machine coordinate that G28 goes to
# g54 = 0                      # offset of the coordinate system G54; also g55 to g59

[axis.y]
steps_per_mm = 80
max_velocity = 150
max_acceleration = 1000
max_jerk = 50_000
step_length_ns = 2000
step_space_ns = 2000
direction_setup_ns = 1000
direction_hold_ns = 1000
inverted = false

[axis.z]
steps_per_mm = 80
max_velocity = 100
max_acceleration = 1000
max_jerk = 50_000
step_length_ns = 2000
step_space_ns = 2000
direction_setup_ns = 1000
direction_hold_ns = 1000
inverted = false

[axis.e]
steps_per_mm = 80
max_velocity = 100
max_acceleration = 1000
max_jerk = 50_000
step_length_ns = 2000
step_space_ns = 2000
direction_setup_ns = 1000
direction_hold_ns = 1000
inverted = false
)toml";
  return text;
}

Machine default_machine() { return parse_machine(default_machine_text(), "default machine"); }

}  // namespace trammel::machine
