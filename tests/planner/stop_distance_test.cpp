// Stop distances against the contents of full queues, counted from the commands alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "plan.hpp"

namespace trammel::planner {
namespace {

std::uint32_t halfwords_of(const driver::Command& command) {
  const card_map::Opcode opcode = std::holds_alternative<driver::LineCommand>(command) ? card_map::Opcode::Line
                                  : std::holds_alternative<driver::ArcChordCommand>(command)
                                      ? card_map::Opcode::ArcChord
                                      : card_map::Opcode::Arc;
  return card_map::queue_halfwords(*card_map::find_command(static_cast<std::uint8_t>(opcode)), 0xf);
}

struct Path {
  std::uint64_t begin = 0;  // first tick
  std::uint64_t ticks = 0;
  std::uint32_t halfwords = 0;
};

struct Piece {
  std::uint64_t begin = 0;
  std::uint32_t stop_distance = 0;
};

// Largest ratio of a stop distance (plus 256 ticks) to a quarter of the ticks in a full geometry queue from the
// beginning of its piece. Only pieces that a full queue follows are counted.
double worst_share(const std::string& program, const machine::Machine& machine, const CardLimits& card) {
  std::vector<Path> paths;
  std::vector<Piece> pieces;
  std::uint64_t path_ticks = 0;
  std::uint64_t piece_ticks = 0;
  for (const Planned& planned : plan_text(program, machine, card).blocks) {
    for (const driver::Command& command : planned.commands) {
      if (const auto* feed = std::get_if<driver::FeedCommand>(&command)) {
        pieces.push_back({piece_ticks, feed->stop_distance});
        piece_ticks += feed->ticks;
      } else if (const std::uint64_t ticks = path_ticks_of(command); ticks != 0) {
        paths.push_back({path_ticks, ticks, halfwords_of(command)});
        path_ticks += ticks;
      }
    }
  }
  double worst = 0;
  std::size_t first = 0;
  std::size_t judged = 0;
  for (const Piece& piece : pieces) {
    while (paths[first].begin + paths[first].ticks <= piece.begin) ++first;
    std::uint32_t queued = 0;
    std::size_t end = first;
    for (; end < paths.size() && queued < card.geometry_depth; ++end) queued += paths[end].halfwords;
    if (end == paths.size()) break;
    if (piece.stop_distance <= 1) continue;
    const auto ticks = static_cast<double>(paths[end].begin - piece.begin);
    worst = std::max(worst, (piece.stop_distance + 256.0) / (ticks / 4));
    ++judged;
  }
  EXPECT_GT(judged, 5U);
  return worst;
}

// 300 mm/s, 3,000 mm/s^2: stops of 0.1 s and more.
machine::Machine quick_machine() {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) {
    axis.max_velocity = 300;
    axis.max_acceleration = 3000;
  }
  return machine;
}

std::string circles(const char* between) {
  std::string program = "F18000\n";
  for (int i = 0; i < 8; ++i) program += fmt::format("F{} G2 X0 Y0 I40 J0\n{}", i % 2 == 0 ? 18000 : 9000, between);
  return program + "M2\n";
}

TEST(StopDistance, OfArcsInChordsCountsTheirChords) {
  CardLimits card;
  card.clock_hz = 50'000'000;
  card.geometry_depth = 1024;
  machine::Machine machine = quick_machine();
  EXPECT_LE(worst_share(circles(""), machine, with_arcs_by(card, ArcsBy::kChords)), 1.02);
  machine.axes[1].steps_per_mm = 100;
  EXPECT_LE(worst_share(circles("G1 X0.01\n"), machine, with_arcs_by(card, ArcsBy::kChords)), 1.02);
}

// A command for the arc generator is longer than two lines.
TEST(StopDistance, OfShortArcsCountsTheirSize) {
  CardLimits card;
  card.clock_hz = 50'000'000;
  card.geometry_depth = 2048;
  std::string program = "F18000\n";
  for (int i = 0; i < 1500; ++i) {
    program +=
        fmt::format("F{} {} X{:.2f} R5\n", i / 50 % 2 == 0 ? 6000 : 3000, i % 2 == 0 ? "G2" : "G3", 0.1 * (i + 1));
  }
  machine::Machine machine = quick_machine();
  for (machine::MachineAxis& axis : machine.axes) axis.max = 1e4;
  machine.motion.junction_deviation = 10;
  EXPECT_LE(worst_share(program + "M2\n", machine, card), 1.02);
}

// For pieces that begin in the last path before a stop, everything up to the stop is queued.
TEST(StopDistance, IsNoneWhereAllUpToTheStopIsQueued) {
  CardLimits card;
  card.clock_hz = 50'000'000;
  const Plan plan =
      plan_text("F9000\nG1 X5\nX10 Y1\nG61.1 G1 X0\nG1 Y9\nG64 G2 X5 R5\nG1 E3\nM2\n", quick_machine(), card);
  ASSERT_FALSE(plan.error);
  std::size_t last = 0;
  std::size_t others = 0;
  for (const Planned& planned : plan.blocks) {
    for (const auto& piece : commands<driver::FeedCommand>(planned)) {
      if (planned.planned.stop) {
        EXPECT_LE(piece.stop_distance, 1U) << "line " << planned->line;
        ++last;
      } else if (piece.stop_distance > 1) {
        ++others;
      }
    }
  }
  EXPECT_GE(last, 10U);
  EXPECT_GE(others, 2U);
}

// 10 mm at 1 mm/s, then 1 mm at the highest speed possible before the stop. From the last piece of the slow line, a
// stop takes at most 0.1 mm of this line and the whole fast line, for any rates.
TEST(StopDistance, IsAtMostTheWayToTheStop) {
  CardLimits card;
  card.clock_hz = 50'000'000;
  // These lines come first because the host fills the queues at the start.
  std::string program = "G61.1 F600\n";
  for (int i = 0; i < 300; ++i) program += "G1 Y0.1\nY0\n";
  const Plan plan = plan_text(program + "G64 F60\nG1 X10\nF6000 G1 X11\nM2\n", quick_machine(), card);
  ASSERT_FALSE(plan.error);
  const Planned& slow = plan.blocks.at(600);
  const auto pieces = commands<driver::FeedCommand>(slow);
  const double ticks_a_mm = static_cast<double>(path_ticks_of(slow.commands.back())) / 10;
  EXPECT_GE(pieces.back().stop_distance, 1 * ticks_a_mm);
  EXPECT_LE(pieces.back().stop_distance, 1.11 * ticks_a_mm);
}

}  // namespace
}  // namespace trammel::planner
