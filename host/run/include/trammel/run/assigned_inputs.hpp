// Shows the switches at a card's inputs and lets an operator test each by hand: lists the inputs that have roles, and
// checks that an input becomes active when pressed and inactive when released. It only reads; nothing on the card
// changes. Thread safety: as driver::Card.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

// An input that has at least one role.
struct AssignedInput {
  unsigned input = 0;
  std::vector<driver::Role> roles;

  std::string text() const;  // "input 3 (limit minus of axis 0, home of axis 0)"
};

// The inputs with roles as the card has them now, in ascending order; empty for a card without machine inputs. 64
// reads.
std::vector<AssignedInput> assigned_inputs(driver::Card& card);

enum class SwitchResult { kWorks, kActiveBefore, kNotPressed, kNotReleased };
enum class SwitchStep { kPress, kRelease };

// Waits until the filtered input is active, then until it is inactive, at most `longest` of card time for each. An
// input that is active at first is only waited on until it is released, and the result is kActiveBefore. Calls `wanted`
// before each wait. Throws as driver::Card does, and driver::InterruptedError when an InterruptScope ends a wait.
SwitchResult try_switch(driver::Card& card, unsigned input, std::chrono::nanoseconds longest,
                        const std::function<void(SwitchStep)>& wanted);

}  // namespace trammel::run
