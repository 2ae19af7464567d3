// The position of the machine, as numbers and as text. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trammel/gcode/motion.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

struct EndPosition {
  std::string axes;                  // letters of the machine's axes, in the card's order
  std::vector<std::int64_t> pulses;  // by axis of the card, relative to machine zero
  std::vector<double> millimetres;   // by axis of the machine; degrees for a rotary axis
  bool joint_for_each_axis = true;   // no motor moves two axes
};

// `pulses`: one for each motor of the machine.
EndPosition end_position(const machine::Machine& machine, const std::vector<std::int64_t>& pulses);

// "mm", or "degrees" for a rotary axis.
const char* unit_of(char letter);

// All axes, such as "X 10.0000 Y 0.0000 mm", or "X 10.0000 mm A 30.0000 degrees" if some axes are rotary.
std::string place_text(const gcode::Coordinates& place, const machine::Machine& machine);

}  // namespace trammel::run
