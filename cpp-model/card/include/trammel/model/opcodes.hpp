// Kinds of commands that several blocks of the model tell apart. Thread-safe; no errors.
#pragma once

#include "trammel/card_map.hpp"

namespace trammel::model {

// Commands of the geometry queue that take no time: neither a path nor a barrier, and never counted as begun.
constexpr bool is_instant(card_map::Opcode opcode) {
  using card_map::Opcode;
  return opcode == Opcode::Output || opcode == Opcode::Mark || opcode == Opcode::Pwm || opcode == Opcode::Probe;
}

}  // namespace trammel::model
