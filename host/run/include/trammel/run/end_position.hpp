// Where the machine stands. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trammel/driver/card_state.hpp"
#include "trammel/gcode/motion.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

struct EndPosition {
  std::string axes;                  // letters of the machine's axes, in the card's order
  std::vector<std::int64_t> pulses;  // by axis of the card, from machine zero on
  std::vector<double> millimetres;   // by axis of the machine; degrees of a rotary axis
  bool joint_for_each_axis = true;   // no motor moves two axes
};

// `pulses`: one for each motor of the machine.
EndPosition end_position(const machine::Machine& machine, const std::vector<std::int64_t>& pulses);

// By the card's counters, which began at 0 where the machine stood at the card's reset: machine zero is there.
gcode::Coordinates standing_at(const machine::Machine& machine, const driver::Snapshot& now);
// "X 10.0000 Y 0.0000", of all axes, mm (degrees).
std::string place_text(const gcode::Coordinates& place, const machine::Machine& machine);

}  // namespace trammel::run
