// Effects of PlannerSettings on a plan.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "plan.hpp"

namespace trammel::planner {
namespace {

// The blocks of a program, planned with `settings`; `end` receives the state of the path ticks at its end.
std::vector<Planned> blocks_with(const PlannerSettings& settings, const std::string& text, PathTicks* end = nullptr,
                                 const gcode::Coordinates& start = {}) {
  const machine::Machine machine = machine::default_machine();
  gcode::TextLines lines(text, "p.ngc");
  gcode::Reader reader(lines, machine, start);
  BlockBuilder builder(reader, machine, kCard, start);
  Planner planner(builder, machine, kCard, settings);
  std::vector<Planned> blocks;
  PlannedBlock planned;
  for (Collector sink; planner.next(sink, planned); sink.commands.clear()) blocks.push_back({planned, sink.commands});
  if (end != nullptr) *end = planner.ticks();
  return blocks;
}

TEST(Settings, ASingleBlockEndsInAStop) {
  PlannerSettings settings;
  settings.single_block = true;
  const std::string text = "G1 X10 F600\nX20\nX30\nM2\n";
  for (const bool single : {false, true}) {
    const std::vector<Planned> blocks = blocks_with(single ? settings : PlannerSettings{}, text);
    ASSERT_EQ(blocks.size(), 4U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(blocks[i].planned.stop, single || i == 2) << i;
  }
}

TEST(Settings, MeanwhileIsCalledForEachBlock) {
  PlannerSettings settings;
  std::size_t calls = 0;
  settings.meanwhile = [&] { ++calls; };
  EXPECT_EQ(blocks_with(settings, "G1 X10 F600\nX20\nX30\nM2\n").size(), 4U);
  EXPECT_GE(calls, 4U);
  settings.meanwhile = [] { throw std::runtime_error("stopped"); };
  EXPECT_THROW(blocks_with(settings, "G1 X10 F600\n"), std::runtime_error);
}

// A path takes over the fraction of a tick that the path before has left.
TEST(Settings, ProgramsInPartsHaveTheTicksOfTheWhole) {
  const std::string first = "G1 X0.3701 F600\nX1.10034\nG4 P0\n";
  const std::string second = "G1 X1.4707 F600\nX2.3333\nG4 P0\nG0 X5.5557\n";
  const auto ticks = [](const std::vector<Planned>& blocks) {
    std::vector<std::uint64_t> found;
    for (const Planned& block : blocks) {
      for (const driver::LineCommand& line : commands<driver::LineCommand>(block)) found.push_back(line.ticks);
    }
    return found;
  };
  PathTicks end;
  std::vector<std::uint64_t> parts = ticks(blocks_with({}, first, &end));
  PlannerSettings settings;
  settings.ticks = end;
  for (const std::uint64_t more : ticks(blocks_with(settings, second, &end, {1.10034}))) parts.push_back(more);
  PathTicks whole_end;
  EXPECT_EQ(parts, ticks(blocks_with({}, first + second, &whole_end)));
  EXPECT_EQ(end.end_tick, whole_end.end_tick);
  EXPECT_DOUBLE_EQ(end.end_mm, whole_end.end_mm);
  EXPECT_TRUE(end.rapid);
}

}  // namespace
}  // namespace trammel::planner
