// Combines the settings of the HAL component with those of the machine file; the component's take precedence. Pure
// functions, and writes to a card at rest.
#pragma once

#include <array>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/linuxcnc/servo_stream.hpp"
#include "trammel/linuxcnc/shared_region.h"
#include "trammel/machine/machine.hpp"

namespace trammel::linuxcnc {

// Pulses per mm or degree, by joint (an axis of the card): the component's value, or that of the machine file.
std::array<double, card_map::kMaxAxes> pulses_per_unit(const machine::Machine& machine,
                                                       const trammel_settings& settings);
// Maximum speeds: the component's, or those of the machine file plus 5 % for the difference between LinuxCNC's clock
// and the card's. Lead: the component's, or 2.
ServoSettings servo_settings(const machine::Machine& machine, const trammel_settings& settings);
// Writes the step times: the component's if given, otherwise the machine file's. Throws as
// driver::Card::configure_axis() does.
void configure_joints(driver::Card& card, const machine::Machine& machine, const trammel_settings& settings);

}  // namespace trammel::linuxcnc
