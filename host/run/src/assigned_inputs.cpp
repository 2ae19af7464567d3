#include "trammel/run/assigned_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/interrupt.hpp"

namespace trammel::run {

namespace {

constexpr std::chrono::milliseconds kLook{20};

bool is_active(driver::Card& card, unsigned input) { return (card.read_inputs() >> input & 1) != 0; }

// Whether the input reached the level in time.
bool wait_until(driver::Card& card, unsigned input, bool active, std::chrono::nanoseconds longest) {
  for (std::chrono::nanoseconds waited{0}; is_active(card, input) != active; waited += kLook) {
    if (waited >= longest) return false;
    if (driver::interrupted()) throw driver::InterruptedError("waiting for a switch");
    card.bus().sleep(kLook);
  }
  return true;
}

}  // namespace

std::string AssignedInput::text() const {
  std::string names;
  for (const driver::Role role : roles) names += (names.empty() ? "" : ", ") + driver::role_name(role);
  return fmt::format("input {} ({})", input, names);
}

std::vector<AssignedInput> assigned_inputs(driver::Card& card) {
  std::vector<AssignedInput> result;
  if (!card_map::has_engine(card.identification().engines, card_map::engine::kMachineInputs)) return result;
  const auto add = [&](driver::Role role) {
    std::uint32_t inputs = card.read_role(role);
    for (unsigned input = 0; inputs != 0; ++input, inputs >>= 1) {
      if ((inputs & 1) == 0) continue;
      auto at = std::find_if(result.begin(), result.end(), [&](const AssignedInput& a) { return a.input == input; });
      if (at == result.end()) at = result.insert(result.end(), AssignedInput{input, {}});
      at->roles.push_back(role);
    }
  };
  for (unsigned kind = 0; kind < driver::kAxisRoles; ++kind) {
    for (unsigned n = 0; n < card.identification().axes; ++n) add({static_cast<driver::AxisRole>(kind), n});
  }
  for (auto role = static_cast<unsigned>(driver::CardRole::kProbe);
       role <= static_cast<unsigned>(driver::CardRole::kSpindleAtSpeed); ++role) {
    add(static_cast<driver::CardRole>(role));
  }
  std::sort(result.begin(), result.end(),
            [](const AssignedInput& a, const AssignedInput& b) { return a.input < b.input; });
  return result;
}

SwitchResult try_switch(driver::Card& card, unsigned input, std::chrono::nanoseconds longest,
                        const std::function<void(SwitchStep)>& wanted) {
  const bool before = is_active(card, input);
  if (!before) {
    wanted(SwitchStep::kPress);
    if (!wait_until(card, input, true, longest)) return SwitchResult::kNotPressed;
  }
  wanted(SwitchStep::kRelease);
  if (!wait_until(card, input, false, longest))
    return before ? SwitchResult::kActiveBefore : SwitchResult::kNotReleased;
  return before ? SwitchResult::kActiveBefore : SwitchResult::kWorks;
}

}  // namespace trammel::run
