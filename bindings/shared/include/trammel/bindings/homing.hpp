// Homing and places in mm, by a machine file, as C and Python have them. For the thread that uses the card.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/homing.hpp"

namespace trammel::bindings {

// A path, or the built-in machine where it is empty or "default". Throws driver::ArgumentError with file and line.
machine::Machine load_machine(const std::string& file);
// An entry as on the command line: "homing.x.search_distance=20". Throws driver::ArgumentError; nothing has changed.
void change_machine(machine::Machine& machine, const std::string& entry);

// What `trammel run` writes to a card before it moves: step times, slew, inputs, outputs, KEEPS_PLACE. The card stands.
void configure(driver::Card& card, const machine::Machine& machine);

// Configures the card, and homes the axes of these letters; empty: all that have a [homing]. Throws as run::home(),
// driver::ArgumentError for a letter that the machine lacks, driver::HeldError on a card that holds, and
// driver::StateError where the card's place was counted in other scales.
std::vector<run::HomedAxis> home(driver::Card& card, const machine::Machine& machine, const std::string& letters,
                                 const std::function<void(const std::string&)>& say);

// Machine coordinates at which the card's axes stand, mm (degrees), by axis of the machine; zeros where no place was
// set since the card's reset. Throws driver::StateError where the place was counted in other scales.
std::vector<double> read_coordinates(driver::Card& card, const machine::Machine& machine);

// Pulses of the card's axes for a way in mm (degrees), by axis of the machine; what is missing at the end is 0.
std::vector<std::int64_t> pulses_of(const machine::Machine& machine, const std::vector<double>& way);

}  // namespace trammel::bindings
