// Under-run hold on the golden card. Programs that starve at random never use up the queued ticks before they are at
// rest, make the same steps at the same path ticks as without starvation, and do not chatter. Stop distances come from
// the formula of the reference page (docs/reference/behaviour.md), counts of queued ticks from the commands sent and
// the ticks of the card.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "core_bench.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr double kFullSlew = 1 << 29;  // T_s in clocks is kFullSlew / SLEW

struct Piece {
  std::uint64_t ticks;
  double from;  // ticks per clock
  double to;
  std::uint32_t stop_distance;
};

// Sends a program and counts the queued ticks: those sent minus the ticks of the card.
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
  bool ran_dry = false;              // the queues ran empty although the last piece did not end at rest
  std::vector<std::uint64_t> holds;  // clocks in which a hold began

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

// A program: pieces of all rates with matching speeds, the last one to a stop; and the lines that they cover.
struct RandomPieces {
  std::vector<Piece> pieces;
  std::vector<std::uint64_t> lines;
  double stop_clocks;  // T_s: half the clocks from full ratio to rest
  std::uint32_t slew;
  std::uint32_t ratio;
};

// S = ceil(T_s * the largest rate in the piece and in all following pieces within T_s).
void give_stop_distances(RandomPieces& program, double share) {
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

RandomPieces random_program(std::mt19937_64& random, double share = 1) {
  const auto any = [&random](double low, double high) {
    return low * std::pow(high / low, static_cast<double>(random() >> 11) * 0x1p-53);
  };
  RandomPieces program{};
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

// `wait` returns the clocks before each command. A piece comes before the first line that it covers, or any time
// earlier.
template <class Wait>
void run(Starved& card, const RandomPieces& program, std::uint64_t ahead, const Wait& wait) {
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
    skip::run(card.bench.core, 1000);
  ASSERT_EQ(card.bench.core.outputs().status & field::kStatusBusy, 0U);
}

std::uint64_t clocks_of(const RandomPieces& program) {
  double clocks = 0;
  for (const Piece& p : program.pieces) clocks += 2 * static_cast<double>(p.ticks) / (p.from + p.to);
  return static_cast<std::uint64_t>(clocks);
}

// Command, tick, axis and direction of each step, without the time.
std::vector<std::tuple<std::uint64_t, std::uint64_t, unsigned, int>> path_of(const Starved& card) {
  std::vector<std::tuple<std::uint64_t, std::uint64_t, unsigned, int>> path;
  for (const auto& [command, tick, axis, direction, cycle] : card.bench.steps.path)
    path.emplace_back(command, tick, axis, direction);
  return path;
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
    const RandomPieces program = random_program(random, share);
    // All pieces first, or each piece right before the first line that it covers.
    const std::uint64_t ahead = random() % 2 == 0 ? 0 : 1'000'000'000;
    Starved plenty;
    run(plenty, program, ahead, [] { return std::uint64_t{0}; });
    Starved starved;
    const std::uint64_t pattern = random() % 3;
    const auto slow = static_cast<std::uint64_t>(program.stop_clocks);
    const std::uint64_t line_clocks = clocks_of(program) / program.lines.size();
    run(starved, program, ahead, [&]() -> std::uint64_t {
      if (pattern == 0) return random() % (4 * line_clocks + 100);                     // a slow bus
      return random() % (pattern == 1 ? 4 : 12) == 0 ? 10 * (slow + line_clocks) : 0;  // bursts and stalls
    });
    outcome.dry += starved.ran_dry ? 1U : 0U;
    outcome.holds += starved.bench.read(reg::kUnderruns);
    EXPECT_TRUE(path_of(starved) == path_of(plenty));
    EXPECT_FALSE(plenty.bench.steps.path.empty());
    EXPECT_EQ(starved.bench.core.outputs().fault, 0U);
    if (::testing::Test::HasFailure()) break;
  }
  return outcome;
}

TEST(Underrun, NeverRunsDryAndStaysOnThePath) {
  const Outcome outcome = starve(80, 1);
  EXPECT_EQ(outcome.dry, 0U);
  EXPECT_GT(outcome.holds, 40U);
}

// The test above can fail: a hundredth of the stop distances is too short.
TEST(Underrun, RunsDryWhereStopDistancesAreTooShort) { EXPECT_GT(starve(40, 0.01).dry, 1U); }

// A stream of one piece with a tick every fourth clock, over lines of 1,000 ticks. The piece either goes on (its stop
// distance of 4,000 is exactly a stop from full ratio) or ends at rest.
class Directed : public ::testing::Test {
 protected:
  static constexpr double kRate = 0.25;
  static constexpr std::uint32_t kStop = 4000;
  static constexpr std::uint32_t kReserve = card_map::constant::kUnderrunReserveTicks;

  explicit Directed(std::uint32_t without = 0) : card(config_without(without)) {
    card.bench.write(reg::kSlew, static_cast<std::uint32_t>(kFullSlew * kRate / kStop));
  }
  static model::CardConfig config_without(std::uint32_t engines) {
    model::CardConfig config;
    config.engines &= ~engines;
    return config;
  }
  void goes_on(std::uint64_t ticks) { card.piece({ticks, kRate, kRate, kStop}); }
  void ends(std::uint64_t ticks) { card.piece({ticks, kRate, kRate, 0}); }
  void lines(std::uint64_t count) {
    for (; count != 0; --count) card.line(1000, {kOnePulse / 50, -kOnePulse / 70});
  }
  void send(card_map::Opcode opcode, std::uint64_t count) {
    card.send(command_words(opcode, 0, card.bench.number++, count, {}));
  }
  std::uint32_t status() const { return card.bench.core.outputs().status; }
  std::uint32_t ratio() const { return card.bench.core.outputs().ratio; }
  bool busy() const { return (status() & field::kStatusBusy) != 0; }
  std::uint32_t underruns() { return card.bench.read(reg::kUnderruns); }
  // Clocks for `ticks` at full ratio.
  void run(std::uint64_t ticks) { card.clock(static_cast<std::uint64_t>(static_cast<double>(ticks) / kRate)); }

  Starved card;
};

class WithoutTheEngine : public Directed {
 protected:
  WithoutTheEngine() : Directed(card_map::engines::kUnderrunHold) {}
};

TEST_F(Directed, NothingQueuedIsNoUnderrun) {
  card.clock(1000);
  EXPECT_FALSE(card.held());
  EXPECT_EQ(ratio(), 0x10000U);
  EXPECT_EQ(underruns(), 0U);
}

// From rest, a piece waits until twice the stop from the present ratio is queued. STATUS shows the wait, which is not
// counted as an under-run.
TEST_F(Directed, APieceFromRestWaitsForEnough) {
  lines(8);
  goes_on(1'000'000);
  card.clock(1000);
  EXPECT_TRUE(card.held());
  EXPECT_EQ(card.taken, 0U);
  EXPECT_EQ(ratio(), 0x10000U);
  lines(1);  // 9,000 > 8,000 + 256
  card.clock(200);
  EXPECT_FALSE(card.held());
  EXPECT_GT(card.taken, 0U);
  EXPECT_EQ(underruns(), 0U);
}

// The hold begins where the formula says, within a round of the guard. The machine comes to rest with ticks left, and
// continues by itself when twice a stop is queued.
TEST_F(Directed, HoldsWhereTheFormulaSaysAndGoesOnAlone) {
  lines(10);
  goes_on(1'000'000);
  while (!card.held()) card.clock(1);
  EXPECT_LE(card.queued(), kStop + kReserve);
  EXPECT_GE(card.queued(), kStop + kReserve - 64 * kRate - 8);
  run(3 * kStop);
  EXPECT_EQ(ratio(), 0U);
  EXPECT_GE(card.queued(), kReserve - 64 * kRate);
  EXPECT_LE(card.queued(), kReserve + 64);
  EXPECT_EQ(underruns(), 1U);
  lines(8);  // at most 8,000 + 256 + 64
  run(kStop);
  EXPECT_EQ(ratio(), 0U);
  lines(1);
  run(kStop);
  EXPECT_GT(ratio(), 0U);
  EXPECT_EQ(underruns(), 1U);
}

// A bus of half the speed: each hold lasts until twice a stop is queued, so there is at most one hold per such amount.
TEST_F(Directed, DoesNotChatter) {
  lines(10);
  goes_on(1'000'000);
  for (int i = 0; i < 200; ++i) {
    lines(1);
    run(2000);
  }
  EXPECT_FALSE(card.ran_dry);
  EXPECT_GT(underruns(), 5U);
  EXPECT_LT(underruns(), 210'000U / kStop);
}

// The end of a program is not an under-run: it takes exactly the same clocks as without the engine.
std::uint64_t clocks_to_the_end(Starved& card) {
  card.clock(20);
  while ((card.bench.core.outputs().status & field::kStatusBusy) != 0) card.clock(1);
  return card.bench.core.cycles();
}
void whole_program(Starved& card) {
  card.bench.write(reg::kHold, 1);
  for (int i = 0; i < 10; ++i) card.line(1000, {kOnePulse / 50, -kOnePulse / 70});
  card.piece({9000, 0.25, 0.25, 4000});
  card.piece({1000, 0.25, 0.01, 0});
  card.bench.write(reg::kHold, 0);
}
TEST_F(Directed, TheEndOfAProgramIsNone) {
  whole_program(card);
  const std::uint64_t clocks = clocks_to_the_end(card);
  Starved without(config_without(card_map::engines::kUnderrunHold));
  without.bench.write(reg::kSlew, static_cast<std::uint32_t>(kFullSlew * kRate / kStop));
  whole_program(without);
  // The first piece waits for a round of the guard.
  const std::uint64_t without_clocks = clocks_to_the_end(without);
  EXPECT_GE(clocks, without_clocks);
  EXPECT_LE(clocks, without_clocks + 64);
  EXPECT_EQ(underruns(), 0U);
  EXPECT_TRUE(path_of(card) == path_of(without));
}

// All pieces are queued and the last one ends at rest, but the paths end earlier: their end counts.
TEST_F(Directed, PathsThatEndBeforeTheirPiecesCount) {
  goes_on(20'000);
  ends(1000);
  lines(10);
  run(15'000);
  EXPECT_EQ(ratio(), 0U);
  EXPECT_EQ(underruns(), 1U);
  EXPECT_FALSE(card.ran_dry);
  lines(11);
  run(30'000);
  EXPECT_FALSE(busy());
}

// The same in a piece that itself ends at rest: the stop distance of the previous piece still applies.
TEST_F(Directed, PathsThatEndBeforeTheLastPieceCount) {
  lines(10);
  goes_on(9000);
  ends(10'000);
  run(20'000);
  EXPECT_EQ(ratio(), 0U);
  EXPECT_EQ(card.taken, 10'000 - card.queued());
  EXPECT_FALSE(card.ran_dry);
  lines(9);
  run(30'000);
  EXPECT_FALSE(busy());
}

// A barrier that was sent ends the ticks before it, regardless of the pieces.
TEST_F(Directed, ABarrierIsAnEnd) {
  for (const auto opcode : {card_map::Opcode::Dwell, card_map::Opcode::End}) {
    lines(5);
    goes_on(5000);
    send(opcode, opcode == card_map::Opcode::End ? 0 : 50);
    run(8000);
    EXPECT_FALSE(busy());
    EXPECT_EQ(card.bench.core.outputs().fault, 0U);
  }
  EXPECT_EQ(underruns(), 0U);
}

TEST_F(Directed, NoStopDistanceNoRule) {
  lines(1);
  ends(300);
  run(290);
  EXPECT_GT(card.taken, 250U);
  EXPECT_EQ(ratio(), 0x10000U);
  ends(700);
  run(900);
  EXPECT_FALSE(busy());
  EXPECT_EQ(underruns(), 0U);
}

TEST_F(Directed, NotInDirectMode) {
  card.bench.write(reg::frequency_lo(0), 1U << 30);
  card.bench.write(reg::count(0), 20);
  card.bench.write(reg::kLengthLo, 30'000);
  card.bench.write(reg::kStart, 1);
  card.bench.idle(10'000);
  EXPECT_NE(status() & field::kStatusDirect, 0U);
  EXPECT_EQ(status() & field::kStatusUnderrun, 0U);
  card.bench.idle(30'000);
  EXPECT_FALSE(busy());
  // Ticks of a direct move are not subtracted from the queues.
  lines(9);
  goes_on(9000);
  card.clock(200);
  EXPECT_FALSE(card.held());
  EXPECT_TRUE(busy());
}

// Together with a hold of the host: motion continues only when both holds have ended.
TEST_F(Directed, BesideAHostsHold) {
  lines(10);
  goes_on(1'000'000);
  run(9000);
  EXPECT_TRUE(card.held());
  card.bench.write(reg::kHold, 1);
  run(5000);
  EXPECT_EQ(ratio(), 0U);
  card.bench.write(reg::kHold, 0);
  run(5000);
  EXPECT_EQ(ratio(), 0U);
  card.bench.write(reg::kHold, 1);
  lines(20);
  run(1000);
  EXPECT_FALSE(card.held());
  EXPECT_EQ(ratio(), 0U);
  card.bench.write(reg::kHold, 0);
  run(1000);
  EXPECT_GT(ratio(), 0U);
}

TEST_F(Directed, AnAbortEndsIt) {
  lines(10);
  goes_on(1'000'000);
  run(20'000);
  EXPECT_TRUE(card.held());
  card.bench.write(reg::kControl, field::kControlAbort);
  run(kStop * 3);
  EXPECT_FALSE(card.held());
  EXPECT_EQ(ratio(), 0x10000U);
  EXPECT_FALSE(busy());
  card.bench.number = 0;
  lines(1);
  ends(1000);
  run(1100);
  EXPECT_FALSE(busy());
  EXPECT_EQ(underruns(), 1U);
}

// No more commands can come when a queue is full, so the card continues as fast as the queued ticks allow.
TEST_F(Directed, AFullQueueGoesOn) {
  model::CardConfig config;
  config.geometry_depth = 200;  // 13 lines of 2 axes
  Starved small(config);
  small.bench.write(reg::kSlew, static_cast<std::uint32_t>(kFullSlew * kRate / kStop));
  small.piece({30'000, kRate, kRate, 3 * kStop});
  small.piece({1000, kRate, 0.01, 0});
  std::uint64_t sent = 0;
  for (std::uint64_t clocks = 0; clocks < 4'000'000 && small.taken < 31'000; clocks += 50) {
    small.clock(50);
    if (sent < 62 && small.bench.core.outputs().geometry_room >= 13) {
      small.line(500, {kOnePulse / 50, -kOnePulse / 70});
      ++sent;
    }
  }
  EXPECT_EQ(small.taken, 31'000U);
  EXPECT_FALSE(small.ran_dry);
}

TEST_F(WithoutTheEngine, NothingHolds) {
  lines(10);
  goes_on(1'000'000);
  run(11'000);
  EXPECT_EQ(card.taken, 10'000U);
  EXPECT_EQ(ratio(), 0x10000U);
  EXPECT_FALSE(card.bench.access(reg::kUnderruns, false, 0));
}

}  // namespace
}  // namespace trammel::testing
