// The switches at a card's inputs, looked at and tried by hand: which inputs have roles, and whether each is active and
// at rest when somebody presses and releases it. Reads alone: nothing of the card changes. Thread-safety: as of
// driver::Card.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

// An input that has roles.
struct AssignedInput {
  unsigned input = 0;
  std::vector<driver::Role> roles;

  std::string text() const;  // "input 3 (limit minus of axis 0, home of axis 0)"
};

// As the card has them now, by input; none of a card without machine inputs. 64 reads.
std::vector<AssignedInput> assigned_inputs(driver::Card& card);

enum class SwitchResult { kWorks, kActiveBefore, kNotPressed, kNotReleased };
enum class SwitchStep { kPress, kRelease };

// Waits, in card time, until the input, behind its filter, is active, and then until it is not, for `longest` each; one
// that is active at first is released first, and is no good. `wanted` is called before each wait. Errors as of
// driver::Card, and driver::InterruptedError where an InterruptScope ends a wait.
SwitchResult try_switch(driver::Card& card, unsigned input, std::chrono::nanoseconds longest,
                        const std::function<void(SwitchStep)>& wanted);

}  // namespace trammel::run
