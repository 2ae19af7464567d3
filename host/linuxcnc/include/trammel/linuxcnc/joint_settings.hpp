// Settings of the HAL component laid over those of the machine file. Pure functions and writes to a card that stands.
#pragma once

#include <array>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/linuxcnc/servo_stream.hpp"
#include "trammel/linuxcnc/shared_region.h"
#include "trammel/machine/machine.hpp"

namespace trammel::linuxcnc {

// By joint, which is an axis of the card: pulses per mm or degree of the machine file, or of the component.
std::array<double, card_map::kMaxAxes> pulses_per_unit(const machine::Machine& machine,
                                                       const trammel_settings& settings);
// Largest speeds: the component's, or those of the machine file and 5 % more, for what LinuxCNC's and the card's clock
// differ by. The lead likewise: the component's, or 2.
ServoSettings servo_settings(const machine::Machine& machine, const trammel_settings& settings);
// Writes the step times: the component's where it gives them, else the machine file's. Errors as of
// driver::Card::configure_axis().
void configure_joints(driver::Card& card, const machine::Machine& machine, const trammel_settings& settings);

}  // namespace trammel::linuxcnc
