// Where the machine stands, in machine coordinates. The card counts pulses from its reset on and nobody can write its
// counters, so a position that is set is an offset of the host's. Not thread-safe.
#pragma once

#include <cstddef>

#include "trammel/driver/card.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::run {

class MachinePosition {
 public:
  // The machine stands at 0 where the card does now.
  MachinePosition(const driver::Snapshot& now, const machine::Machine& machine) : kinematics_(machine), last_(now) {}

  // What the card says now. The counters wrap: at least one look in 2^31 pulses of an axis.
  void look(const driver::Snapshot& now);
  // What the machine is told to stand at, mm (degrees), without moving; rounded to a pulse. The last look counts.
  void set(std::size_t axis, double millimetres);

  // By axis of the card; and as the machine's axes stand.
  const planner::Pulses& pulses() const { return pulses_; }
  gcode::Coordinates millimetres() const { return kinematics_.coordinates(pulses_); }

 private:
  kinematics::Kinematics kinematics_;
  driver::Snapshot last_;
  planner::Pulses pulses_{};
};

}  // namespace trammel::run
