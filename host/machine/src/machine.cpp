#include "trammel/machine/machine.hpp"

#include "trammel/driver/roles.hpp"

namespace trammel::machine {

std::optional<std::size_t> Machine::axis(char letter) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].letter == letter) {
      return i;
    }
  }
  return std::nullopt;
}

const Tool* Machine::tool(unsigned number) const {
  for (const Tool& tool : tools) {
    if (tool.number == number) return &tool;
  }
  return nullptr;
}

std::vector<std::size_t> Machine::second_motors() const {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].second_motor) result.push_back(i);
  }
  return result;
}

std::uint32_t Machine::spindle_at_speed() const {
  return inputs.roles[driver::Role(driver::CardRole::kSpindleAtSpeed).number()].inputs;
}

}  // namespace trammel::machine
