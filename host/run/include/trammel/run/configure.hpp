// Writes the settings of a machine file to a card.
#pragma once

#include <chrono>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

// Sets step times and direction of each of the machine's motors, and the slew of the time base
// (planner::hold_seconds(), or the slowest slew that the card has). Names the card's axes in messages about faults.
// Calls set_keeps_place() if an axis keeps its place.
// The card must be at rest. If the machine gives inputs a role, this also sets polarity, filters, roles and stops;
// otherwise the card keeps its present ones. Throws driver::Error as driver::Card::configure_axis() does, and
// driver::ArgumentError if the machine names an output or an input that the card lacks.
void configure(driver::Card& card, const machine::Machine& machine);

// Sets which of the machine's motors keep their place (KEEPS_PLACE); the card's other axes do not change. Replaces the
// setting of an earlier machine file for these motors. Throws driver::ArgumentError if an axis keeps its place and the
// card's register map is older than 3.3.
void set_keeps_place(driver::Card& card, const machine::Machine& machine);

// Which of the machine's inputs stop the card, and how.
driver::InputStops input_stops(const machine::Machine& machine);
// Writes roles, filters, polarity and stops of the machine's inputs, as configure() does. Does nothing if no input has
// a role.
void configure_inputs(driver::Card& card, const machine::Machine& machine);
// Writes safe levels, roles of outputs, the enable sequence of the drives and the reaction to an emergency stop, as
// configure() does. Settings that the machine file does not name do not change. Throws driver::ArgumentError for a
// feature that the card lacks.
void configure_outputs(driver::Card& card, const machine::Machine& machine);

// The time for driver::WatchdogScope; 0: the machine has no watchdog.
std::chrono::nanoseconds watchdog_time(const machine::MotionSettings& motion);

}  // namespace trammel::run
