// The position of the machine in machine coordinates. The card counts pulses from its reset on and its counters cannot
// be written, so a position that is set is an offset on the host. Not thread-safe.
#pragma once

#include <cstddef>

#include "trammel/driver/card.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::run {

class MachinePosition {
 public:
  // The card's present position is machine position 0.
  MachinePosition(const driver::Snapshot& now, const machine::Machine& machine) : kinematics_(machine), last_(now) {}

  // Updates the position from a snapshot of the card. The counters wrap: call look() at least once in 2^31 pulses of an
  // axis.
  void look(const driver::Snapshot& now);
  // Declares the axis to be at `millimetres` (degrees), without moving; rounded to a pulse. Applies to the position at
  // the last look().
  void set(std::size_t axis, double millimetres);

  // By axis of the card, and by axis of the machine.
  const planner::Pulses& pulses() const { return pulses_; }
  gcode::Coordinates millimetres() const { return kinematics_.coordinates(pulses_); }

 private:
  kinematics::Kinematics kinematics_;
  driver::Snapshot last_;
  planner::Pulses pulses_{};
};

}  // namespace trammel::run
