// What must hold of a machine as a whole, wherever it came from. Each throws a MachineError whose message begins with
// `where`. Internal to the library.
#pragma once

#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// No more axes and motors than a card has.
void check_motors(const std::string& where, const Machine& machine);

// The kinematics have their axes, and motor limits belong to a member that has motors of its own.
void check_kinematics(const std::string& where, const Machine& machine);

// No axis takes more than 1,000 s from rest to its max_velocity: longer ones are slips of a unit.
void check_ramps(const std::string& where, const Machine& machine);

// Step times fit the card's registers at its clock; rounded up to whole nanoseconds, as the driver takes them.
void check_times(const std::string& where, const Machine& machine);

// Rotary axes have soft limits, or say that they are endless.
void check_soft_limits(const std::string& where, const Machine& machine);

// No output for both spindle and coolant: M5 and M9 could not tell them apart.
void check_outputs(const std::string& where, const MachineOutputs& outputs);

}  // namespace trammel::machine
