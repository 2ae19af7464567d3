// Settings of a card from a machine file.
#pragma once

#include <chrono>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

// Gives each of the machine's motors its step times and direction, and the time base its slew (planner::hold_seconds(),
// or the slowest that the card has). The card must stand. Throws driver::Error as driver::Card::configure_axis() does,
// and driver::ArgumentError where the machine names an output that the card lacks.
void configure(driver::Card& card, const machine::Machine& machine);

// For driver::WatchdogScope; 0: the machine has none.
std::chrono::nanoseconds watchdog_time(const machine::MotionSettings& motion);

}  // namespace trammel::run
