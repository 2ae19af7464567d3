// Plans a whole program at once, for tests: its blocks with their commands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"

namespace trammel::planner {

constexpr std::uint32_t kClock = 100'000'000;
constexpr CardLimits kCard = {kClock, 4, true};

inline machine::Machine machine_with(const std::vector<std::string>& overrides) {
  machine::Machine machine = machine::default_machine();
  for (const std::string& text : overrides) machine::apply_override(machine, text);
  return machine;
}

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

// The blocks between two stops; their feed ticks are counted together.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
  std::uint64_t feed_ticks = 0;
  std::uint64_t path_ticks = 0;
  bool piece_first = true;  // each command of geometry comes after a piece for its first tick
};

inline std::uint64_t path_ticks_of(const driver::Command& command) {
  if (const auto* line = std::get_if<driver::LineCommand>(&command)) return line->ticks;
  if (const auto* arc = std::get_if<driver::ArcCommand>(&command)) return arc->ticks;
  if (const auto* arc = std::get_if<driver::ArcChordCommand>(&command)) return arc->ticks;
  return 0;
}

inline std::vector<Stretch> stretches_of(const std::vector<Planned>& blocks) {
  std::vector<Stretch> stretches;
  bool open = false;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!moves(blocks[i].planned.block)) continue;
    if (!open) stretches.push_back({i});
    Stretch& stretch = stretches.back();
    stretch.last = i;
    for (const driver::Command& command : blocks[i].commands) {
      if (const auto* piece = std::get_if<driver::FeedCommand>(&command)) {
        stretch.feed_ticks += piece->ticks;
      } else {
        stretch.piece_first = stretch.piece_first && stretch.feed_ticks > stretch.path_ticks;
        stretch.path_ticks += path_ticks_of(command);
      }
    }
    open = !blocks[i].planned.stop;
  }
  return stretches;
}

}  // namespace trammel::planner
