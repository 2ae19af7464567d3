#include "trammel/run/machine_position.hpp"

namespace trammel::run {

void MachinePosition::look(const driver::Snapshot& now) {
  for (std::size_t joint = 0; joint < kinematics_.joints(); ++joint) {
    pulses_[joint] += driver::pulses_between(last_.position[joint], now.position[joint]);
  }
  last_ = now;
}

// Joints that do not move with the axis keep their pulse counts.
void MachinePosition::set(std::size_t axis, double millimetres) {
  gcode::Coordinates at = kinematics_.coordinates(pulses_);
  at[axis] = millimetres;
  for (std::size_t joint = 0; joint < kinematics_.joints(); ++joint) {
    if ((kinematics_.axes_of(joint) >> axis & 1U) != 0) pulses_[joint] = kinematics_.pulses(joint, at);
  }
}

}  // namespace trammel::run
