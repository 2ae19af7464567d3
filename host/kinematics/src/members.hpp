// The members of the kinematics. Internal to the library.
#pragma once

#include "trammel/kinematics/kinematics.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::kinematics {

// The layout of the member that the machine names.
Layout layout_of(const machine::Machine& machine);
// One joint per axis, one pulse per unit.
Layout layout_in_pulses(std::size_t axes);

}  // namespace trammel::kinematics
