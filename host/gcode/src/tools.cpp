#include "tools.hpp"

#include <fmt/format.h>

namespace trammel::gcode {

double Tools::offset(unsigned tool, std::size_t axis) const {
  const machine::Tool* found = machine_.tool(tool);
  return found != nullptr ? found->offsets[axis] : 0;
}

bool Tools::apply(const WordSet& words, Offsets& offsets, Problem& problem) const {
  const auto code = words.code(Group::kToolLength);
  if (code == 490) {
    offsets.clear_tool();
    return true;
  }
  const auto given = words.letter('H');
  const auto number = given ? static_cast<unsigned>(*given) : current_;
  if (number != 0 && machine_.tool(number) == nullptr) {
    return problem.set(ErrorCode::kNoSuchTool,
                       fmt::format("G43{}: the machine file has no tool {}: --set tools.{}.z=LENGTH or [tools.{}] "
                                   "of the file describes it",
                                   given ? fmt::format(" H{}", number) : std::string(), number, number, number));
  }
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) offsets.set_tool(axis, {offset(number, axis), false});
  return true;
}

}  // namespace trammel::gcode
