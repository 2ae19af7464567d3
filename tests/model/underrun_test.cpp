// Under-run hold on the golden card: programs that are starved at random never use up what is queued before they stand,
// make the same steps at the same path ticks as without starvation, and do not chatter. Stop distances come from the
// formula of the reference page (docs/reference/behaviour.md), counts of queued ticks from what was sent and the card's ticks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr double kFullSlew = 1 << 29;  // SLEW of a stop that takes as long as 2 clocks at full ratio

std::uint64_t seed() {
  const char* given = std::getenv("TRAMMEL_SEED");
  return given != nullptr ? std::stoull(given) : 1;
}

struct Piece {
  std::uint64_t ticks;
  double from;  // ticks a clock
  double to;
  std::uint32_t stop_distance;
};

// Sends a program and counts what is queued: sent, less the ticks that the card shows.
class Starved {
 public:
  explicit Starved(const model::CardConfig& config = {}) : bench(config) {}

  void clock(std::uint64_t clocks) {
    for (; clocks != 0; --clocks) {
      bench.clock({});
      watch();
    }
  }
  void send(const std::vector<std::uint32_t>& words) {
    for (const std::uint32_t word : words) {
      model::CoreModel::Inputs in;
      in.request = in.write = true;
      in.address = reg::kStream;
      in.data = word;
      bench.clock(in);
      watch();
      while (!bench.core.answer().ack) clock(1);
      ASSERT_FALSE(bench.core.answer().error);
    }
  }
  void line(std::uint64_t ticks, const std::vector<std::int64_t>& increments) {
    const auto mask = static_cast<std::uint8_t>((1U << increments.size()) - 1);
    send(command_words(card_map::Opcode::Line, mask, bench.number++, ticks, {}, increments));
    paths += ticks;
  }
  void piece(const Piece& p) {
    const double updates = static_cast<double>(p.ticks) / (0.5 * (p.from + p.to)) / 32;
    const double acceleration = (p.to - p.from) / updates;
    send(command_words(card_map::Opcode::Feed, 0, bench.number++, p.ticks,
                       {{"rate", static_cast<std::uint64_t>(std::min(p.from, 0.999) * 0x1p64)},
                        {"acceleration", static_cast<std::int64_t>(acceleration * 0x1p64)},
                        {"floor", static_cast<std::uint32_t>(std::max(1.0, std::min(p.from, p.to) * 0x1p32))},
                        {"stop_distance", p.stop_distance}}));
    pieces += p.ticks;
    ends_at_rest = p.stop_distance == 0;
  }
  std::uint64_t queued() const { return std::min(paths, pieces) - taken; }
  bool held() const { return (bench.core.outputs().status & field::kStatusUnderrun) != 0; }

  CoreBench bench;
  std::uint64_t paths = 0;
  std::uint64_t pieces = 0;
  std::uint64_t taken = 0;
  bool ends_at_rest = false;
  bool ran_dry = false;  // nothing was queued any more, though the last piece did not end at rest
  std::vector<std::uint64_t> holds;  // where they began

 private:
  void watch() {
    const auto& out = bench.core.outputs();
    taken += out.tick ? 1U : 0U;
    const bool ends = ends_at_rest && paths >= pieces;
    if (taken != 0 && queued() == 0 && !ends) ran_dry = true;
    if (held() && !was_held_) holds.push_back(bench.core.cycles());
    was_held_ = held();
  }
  bool was_held_ = false;
};

// A program: pieces of all rates, one after the other at speed, the last one to a stop; lines under them.
struct Program {
  std::vector<Piece> pieces;
  std::vector<std::uint64_t> lines;
  double stop_clocks;  // from full ratio to rest, half of it: T_s
  std::uint32_t slew;
  std::uint32_t ratio;
};

// S = ceil(T_s * the largest rate in the piece and in all that follows within T_s).
void give_stop_distances(Program& program, double share) {
  for (std::size_t i = 0; i + 1 < program.pieces.size(); ++i) {
    double fastest = 0;
    double clocks = 0;
    for (std::size_t k = i; k < program.pieces.size() && clocks <= program.stop_clocks; ++k) {
      const Piece& p = program.pieces[k];
      fastest = std::max({fastest, p.from, p.to});
      if (k != i) clocks += static_cast<double>(p.ticks) / std::max(p.from, p.to);
    }
    program.pieces[i].stop_distance =
        std::max(1U, static_cast<std::uint32_t>(std::ceil(share * program.stop_clocks * fastest)));
  }
  program.pieces.back().stop_distance = 0;
}

Program random_program(std::mt19937_64& random, double share = 1) {
  const auto any = [&random](double low, double high) {
    return low * std::pow(high / low, static_cast<double>(random() >> 11) * 0x1p-53);
  };
  Program program{};
  program.slew = static_cast<std::uint32_t>(kFullSlew / any(2.1, 10'000));
  program.stop_clocks = kFullSlew / program.slew;
  program.ratio = random() % 3 == 0 ? static_cast<std::uint32_t>(any(0x1000, 0xFFFF)) : 0x10000;
  double rate = any(0.004, 0.9);
  std::uint64_t total = 0;
  for (std::uint64_t left = 2 + random() % 12; left != 0; --left) {
    const double next = left == 1 ? 0.001 : random() % 2 == 0 ? rate : any(0.004, 0.95);
    const auto ticks = static_cast<std::uint64_t>(any(40, 2 * program.stop_clocks * std::max(rate, next) + 400));
    program.pieces.push_back({ticks, rate, next, 0});
    total += ticks;
    rate = next;
  }
  while (total != 0) {
    const std::uint64_t ticks = std::min<std::uint64_t>(total, static_cast<std::uint64_t>(any(25, 3000)));
    program.lines.push_back(ticks);
    total -= ticks;
  }
  give_stop_distances(program, share);
  return program;
}

std::vector<std::int64_t> increments(std::size_t line) {
  const auto n = static_cast<std::int64_t>(line);
  return {kOnePulse / 7 + n * 1234567, -kOnePulse / 11 + n * 7654321};
}

// `wait` gives the clocks before each command. A piece comes before the first line that it covers, or any time before.
template <class Wait>
void run(Starved& card, const Program& program, std::uint64_t ahead, const Wait& wait) {
  card.bench.write(reg::kSlew, program.slew);
  card.bench.write(reg::kRatioFeed, program.ratio);
  std::size_t next = 0;
  for (std::size_t i = 0; i < program.lines.size(); ++i) {
    while (next < program.pieces.size() && card.pieces <= card.paths + ahead) {
      card.clock(wait());
      card.piece(program.pieces[next++]);
    }
    card.clock(wait());
    card.line(program.lines[i], increments(i));
  }
  for (; next < program.pieces.size(); ++next) card.piece(program.pieces[next]);
  card.clock(16);
  for (int more = 0; more < 20'000 && (card.bench.core.outputs().status & field::kStatusBusy) != 0; ++more)
    card.bench.core.run(1000);
  ASSERT_EQ(card.bench.core.outputs().status & field::kStatusBusy, 0U);
}

std::uint64_t clocks_of(const Program& program) {
  double clocks = 0;
  for (const Piece& p : program.pieces) clocks += 2 * static_cast<double>(p.ticks) / (p.from + p.to);
  return static_cast<std::uint64_t>(clocks);
}

struct Outcome {
  unsigned dry = 0;
  std::uint64_t holds = 0;
};

Outcome starve(std::uint64_t cases, double share) {
  Outcome outcome;
  for (std::uint64_t i = 0; i < cases; ++i) {
    SCOPED_TRACE("TRAMMEL_SEED=" + std::to_string(seed()) + " case " + std::to_string(i));
    std::mt19937_64 random(seed() * 1'000'003 + i);
    const Program program = random_program(random, share);
    // All pieces first, or each right before the first line that it covers.
    const std::uint64_t ahead = random() % 2 == 0 ? 0 : 1'000'000'000;
    Starved plenty;
    run(plenty, program, ahead, [] { return std::uint64_t{0}; });
    Starved starved;
    const std::uint64_t pattern = random() % 3;
    const auto slow = static_cast<std::uint64_t>(program.stop_clocks);
    const std::uint64_t line_clocks = clocks_of(program) / program.lines.size();
    run(starved, program, ahead, [&]() -> std::uint64_t {
      if (pattern == 0) return random() % (4 * line_clocks + 100);  // a slow bus
      return random() % (pattern == 1 ? 4 : 12) == 0 ? 10 * (slow + line_clocks) : 0;  // bursts and stalls
    });
    outcome.dry += starved.ran_dry ? 1U : 0U;
    outcome.holds += starved.bench.read(reg::kUnderruns);
    EXPECT_EQ(starved.bench.steps.path, plenty.bench.steps.path);
    EXPECT_FALSE(plenty.bench.steps.path.empty());
    EXPECT_EQ(starved.bench.core.outputs().fault, 0U);
    if (::testing::Test::HasFailure()) break;
  }
  return outcome;
}

TEST(Underrun, NeverRunsDryAndStaysOnThePath) {
  const Outcome outcome = starve(160, 1);
  EXPECT_EQ(outcome.dry, 0U);
  EXPECT_GT(outcome.holds, 160U);
}

// The judge above can fail: stop distances of a twentieth are too short.
TEST(Underrun, RunsDryWhereStopDistancesAreTooShort) { EXPECT_GT(starve(40, 0.05).dry, 4U); }

}  // namespace
}  // namespace trammel::testing
