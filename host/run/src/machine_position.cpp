#include "trammel/run/machine_position.hpp"

#include "trammel/planner/block_builder.hpp"

namespace trammel::run {

void MachinePosition::look(const driver::Snapshot& now) {
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    pulses_[axis] += driver::pulses_between(last_.position[axis], now.position[axis]);
  }
  last_ = now;
}

void MachinePosition::set(std::size_t axis, double millimetres) {
  pulses_[axis] = planner::to_pulses(millimetres, machine_.axes[axis].steps_per_mm);
}

gcode::Coordinates MachinePosition::millimetres() const {
  gcode::Coordinates result{};
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    result[axis] = static_cast<double>(pulses_[axis]) / machine_.axes[axis].steps_per_mm;
  }
  return result;
}

}  // namespace trammel::run
