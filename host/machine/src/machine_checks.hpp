// Checks of a whole machine, from any source. Each throws a MachineError whose message begins with `where`. Internal to
// the library.
#pragma once

#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// A machine has no more axes and motors than a card.
void check_motors(const std::string& where, const Machine& machine);

// CoreXY has axes X and Y without second motors; motor limits are given only for CoreXY.
void check_kinematics(const std::string& where, const Machine& machine);

// No axis takes more than 1,000 s from rest to its max_velocity: a longer time indicates a wrong unit.
void check_ramps(const std::string& where, const Machine& machine);

// Step times, rounded up to whole nanoseconds as in the driver, fit the card's registers at its clock.
void check_times(const std::string& where, const Machine& machine);

// Rotary axes have soft limits or are declared endless.
void check_soft_limits(const std::string& where, const Machine& machine);

// No output is for both spindle and coolant, because M5 and M9 could not distinguish them.
void check_outputs(const std::string& where, const MachineOutputs& outputs);

}  // namespace trammel::machine
