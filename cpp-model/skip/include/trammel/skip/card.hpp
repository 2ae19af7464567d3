// The core and the card with skipping. clock() leaves the state that the block's own clock() leaves, and run() the
// state that this number of them leaves; but blocks within their horizon are not clocked, and clocks between steps
// pass at once.
#pragma once

#include <cstdint>

#include "trammel/model/card_model.hpp"

namespace trammel::skip {

// One rising edge.
void clock(model::CoreModel& core, const model::CoreModel::Inputs& in);
void clock(model::CardModel& card, const model::CardModel::Inputs& in);

// Levels at the card's inputs, and at the emergency stop's pin.
struct Pins {
  // NOLINTNEXTLINE: the card's inputs are most of its pins
  Pins(std::uint32_t levels = 0, bool emergency = false) : inputs(levels), emergency_stop(emergency) {}
  std::uint32_t inputs;
  bool emergency_stop;
};

// Passes edges without requests at once, at most `limit`, with these levels at the inputs. Returns their number; 0 if
// a jump is not worth its cost.
std::uint64_t jump(model::CoreModel& core, std::uint64_t limit, const Pins& pins = {});

// Makes `clocks` edges without requests or bus traffic, with these levels at the inputs.
void run(model::CoreModel& core, std::uint64_t clocks, const Pins& pins = {});
void run(model::CardModel& card, std::uint64_t clocks, const Pins& pins = {});

}  // namespace trammel::skip
