// Homing and positions in mm from a machine file, shared by the C and Python bindings. For the thread that uses the
// card.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/homing.hpp"

namespace trammel::bindings {

// Loads a machine file: a path; empty or "default": the built-in machine. Throws driver::ArgumentError with file and
// line.
machine::Machine load_machine(const std::string& file);
// Changes an entry, written as on the command line: "homing.x.search_distance=20". Throws driver::ArgumentError, and
// changes nothing, for an invalid entry.
void change_machine(machine::Machine& machine, const std::string& entry);

// Writes the settings that `trammel run` writes before it moves: step times, slew, inputs, outputs, KEEPS_PLACE. The
// card must be at rest.
void configure(driver::Card& card, const machine::Machine& machine);

// Configures the card, and homes the axes with these letters; empty: all axes that have a [homing]. Throws as
// run::home(); driver::ArgumentError for a letter that the machine lacks, driver::HeldError on a card that holds,
// driver::StateError if the card's place was counted in other scales.
std::vector<run::HomedAxis> home(driver::Card& card, const machine::Machine& machine, const std::string& letters,
                                 const std::function<void(const std::string&)>& say);

// Machine coordinates of the card's axes, mm (degrees), by axis of the machine; zeros if no place was set since the
// card's reset. Throws driver::StateError if the place was counted in other scales.
std::vector<double> read_coordinates(driver::Card& card, const machine::Machine& machine);

// Converts a displacement in mm (degrees), by axis of the machine, to pulses of the card's axes. Missing entries at the
// end are 0.
std::vector<std::int64_t> pulses_of(const machine::Machine& machine, const std::vector<double>& way);

}  // namespace trammel::bindings
