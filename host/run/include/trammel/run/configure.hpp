// Settings of a card from a machine file.
#pragma once

#include <chrono>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

// Gives each of the machine's motors its step times and direction, and the time base its slew (planner::hold_seconds(),
// or the slowest that the card has); set_keeps_place() where an axis keeps its place. The card must stand. Where the
// machine gives inputs a role, also polarity, filters, roles and stops; else the card keeps those that it has. Throws
// driver::Error as driver::Card::configure_axis() does, and driver::ArgumentError where the machine names an output or
// an input that the card lacks.
void configure(driver::Card& card, const machine::Machine& machine);

// Which of the machine's motors keep their place (KEEPS_PLACE); the card's other axes stay as they are. On a card that
// another machine file has set up before, this ends what that one said. Throws driver::ArgumentError where an axis
// keeps its place and the card's map is before 3.3.
void set_keeps_place(driver::Card& card, const machine::Machine& machine);

// What of the machine's inputs stops the card, and how.
driver::InputStops input_stops(const machine::Machine& machine);
// Roles, filters, polarity and stops of the machine's inputs, as configure() writes them. Nothing where none has a
// role.
void configure_inputs(driver::Card& card, const machine::Machine& machine);
// Safe levels, roles of outputs, the drives' sequence and the emergency stop's reaction, as configure() writes them;
// what the machine file does not name stays as it is. Throws driver::ArgumentError for what the card lacks.
void configure_outputs(driver::Card& card, const machine::Machine& machine);

// For driver::WatchdogScope; 0: the machine has none.
std::chrono::nanoseconds watchdog_time(const machine::MotionSettings& motion);

}  // namespace trammel::run
