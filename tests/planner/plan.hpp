// A program's blocks with their commands, all at once, for tests.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"

namespace trammel::planner {

struct Planned {
  PlannedBlock planned;
  std::vector<driver::Command> commands;
  const Block* operator->() const { return &planned.block; }
};

class Collector final : public driver::CommandSink {
 public:
  void put(const driver::Command& command) override { commands.push_back(command); }
  std::vector<driver::Command> commands;
};

struct Plan {
  std::vector<Planned> blocks;
  std::optional<gcode::Error> error;
  Pulses start{};
};

inline Plan plan_lines(gcode::LineSource& lines, const machine::Machine& machine, const CardLimits& card,
                       const gcode::Coordinates& start = {}) {
  gcode::Reader reader(lines, machine, start);
  BlockBuilder blocks(reader, machine, card, start);
  Planner planner(blocks, machine, card);
  Plan result;
  result.start = blocks.start();
  PlannedBlock planned;
  for (Collector sink; planner.next(sink, planned); sink.commands.clear()) {
    result.blocks.push_back({planned, sink.commands});
  }
  result.error = blocks.error();
  return result;
}

inline Plan plan_text(const std::string& text, const machine::Machine& machine, const CardLimits& card,
                      const gcode::Coordinates& start = {}) {
  gcode::TextLines lines(text, "p.ngc");
  return plan_lines(lines, machine, card, start);
}

template <typename T>
std::vector<T> commands(const Planned& planned) {
  std::vector<T> found;
  for (const driver::Command& command : planned.commands) {
    if (const T* one = std::get_if<T>(&command)) found.push_back(*one);
  }
  return found;
}

}  // namespace trammel::planner
