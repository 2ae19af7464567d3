// CoreModel::run() against clock(): the same random programs on two cores, one of which goes from step to step.
// Outputs, positions, reported steps and all that follows are compared after waits of random length.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "core_bench.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;

class Pair {
 public:
  // What is compared: a core that is clocked with one that jumps, or one that never rests with one that does.
  enum class Of { ClockAndRun, AllAndResting };

  Pair(Of of, const model::CardConfig& config, std::uint64_t seed)
      : of_(of), clocked(config), jumping(config), random(seed) {
    clocked.logs = jumping.logs = of == Of::AllAndResting;
    clocked.skips = of != Of::AllAndResting;
  }

  std::uint64_t any(std::uint64_t low, std::uint64_t high) { return low + random() % (high - low + 1); }
  // Any order of size up to 2^bits.
  std::uint64_t sized(unsigned bits) {
    const std::uint64_t size = any(0, bits);
    return size == 0 ? 0 : random() >> (64 - size);
  }
  bool one_in(std::uint64_t n) { return random() % n == 0; }

  bool write(std::uint32_t address, std::uint32_t data) {
    const bool good = clocked.write(address, data);
    EXPECT_EQ(jumping.write(address, data), good);
    return good;
  }
  bool send(const std::vector<std::uint32_t>& words) {
    const bool good = clocked.send(words);
    EXPECT_EQ(jumping.send(words), good);
    return good;
  }
  void wait(std::uint64_t clocks) {
    clocked.idle(clocks);
    if (of_ == Of::ClockAndRun)
      skip::run(jumping.core, clocks, jumping.pins);
    else
      jumping.idle(clocks);
    waits += 1;
  }
  // The same as run(), counting the clocks of jumps over which the ratio changed.
  void wait_on_ramps(std::uint64_t clocks) {
    clocked.idle(clocks);
    while (clocks != 0) {
      const std::uint32_t ratio = jumping.core.outputs().ratio;
      const std::uint64_t gone = skip::jump(jumping.core, clocks, jumping.pins);
      if (gone == 0) jumping.idle(1);
      if (jumping.core.outputs().ratio != ratio) on_ramps += gone;
      clocks -= std::max<std::uint64_t>(gone, 1);
    }
  }
  void compare() {
    ASSERT_EQ(clocked.core.cycles(), jumping.core.cycles());
    const auto& a = clocked.core.outputs();
    const auto& b = jumping.core.outputs();
    ASSERT_TRUE(a == b) << "cycle " << clocked.core.cycles() << " rate " << a.rate << " " << b.rate << " status "
                        << a.status << " " << b.status << " tick " << a.tick << b.tick << " path " << a.path_step
                        << b.path_step << " dir " << a.path_dir << b.path_dir << " pins " << a.step << b.step;
    for (std::size_t i = 0; i < clocked.log.size(); ++i)
      ASSERT_TRUE(clocked.log[i] == jumping.log[i]) << clocked.log.size() - i - 1 << " clocks before";
    for (unsigned n = 0; n < clocked.core.config().axes; ++n)
      ASSERT_EQ(clocked.core.position(n), jumping.core.position(n)) << "axis " << n;
    ASSERT_TRUE(clocked.steps.pins == jumping.steps.pins) << "cycle " << clocked.core.cycles();
    ASSERT_TRUE(clocked.steps.path == jumping.steps.path) << "cycle " << clocked.core.cycles();
    // What was equal once need not be compared again.
    for (CoreBench* bench : {&clocked, &jumping}) {
      steps += bench->steps.pins.size();
      bench->steps.pins.clear();
      bench->steps.path.clear();
      one_by_one += bench->log.size();
      bench->log.clear();
    }
  }
  // Waits of all lengths, that the ends of jumps fall everywhere.
  void wait_in_pieces(std::uint64_t clocks, std::uint64_t longest) {
    while (clocks != 0 && !::testing::Test::HasFatalFailure()) {
      const std::uint64_t piece = std::min(clocks, one_in(4) ? any(1, longest) : any(1, 90));
      wait(piece);
      compare();
      clocks -= piece;
    }
  }

  const Of of_;
  CoreBench clocked;
  CoreBench jumping;
  std::mt19937_64 random;
  std::uint64_t waits = 0;
  std::uint64_t steps = 0;
  std::uint64_t chord_arcs = 0;
  std::uint64_t on_ramps = 0;
  std::uint64_t one_by_one = 0;  // clocks compared, on both
};

// Settings, paths, pieces and barriers of a program; returns its ticks.
class Program {
 public:
  explicit Program(Pair& pair) : p_(pair), axes_(pair.clocked.core.config().axes) {}

  void settings() {
    const auto times = [this](std::uint64_t most) {
      return static_cast<std::uint32_t>(p_.one_in(3) ? 0 : p_.any(0, most));
    };
    const std::uint64_t most = p_.one_in(4) ? 200 : 12;
    for (unsigned n = 0; n < axes_; ++n) {
      p_.write(reg::step_length(n), times(most));
      p_.write(reg::step_space(n), times(most));
      p_.write(reg::dir_setup(n), times(most));
      p_.write(reg::dir_hold(n), times(most));
      p_.write(reg::mode(n), static_cast<std::uint32_t>(p_.one_in(2) ? 0 : p_.any(0, 3) << 2 | p_.any(0, 2)));
    }
    for (const std::uint32_t ratio : {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed})
      p_.write(ratio, static_cast<std::uint32_t>(p_.one_in(2) ? 0x10000 : p_.any(0x100, 0x10000)));
    if (p_.one_in(2)) p_.write(reg::kGeometryWatermark, static_cast<std::uint32_t>(p_.any(1, 60)));
    if (p_.one_in(2)) p_.write(reg::kFeedWatermark, static_cast<std::uint32_t>(p_.any(1, 60)));
    if (p_.one_in(2)) p_.write(reg::kIrqEnable, static_cast<std::uint32_t>(p_.any(0, (1U << 18) - 1)));
    if (p_.one_in(3)) p_.write(reg::kHoldLimit, static_cast<std::uint32_t>(p_.any(1, p_.one_in(2) ? 60 : 2000)));
    if (p_.one_in(3)) p_.write(reg::kStopReaction, static_cast<std::uint32_t>(p_.any(0, 255) | p_.any(0, 1) << 10));
    if (p_.one_in(8)) p_.write(reg::kStreaming, 1U | static_cast<std::uint32_t>(p_.any(0, 2)) << 8);
  }

  // A tick every `pace` clocks.
  void paths_and_pieces(double pace) {
    std::uint64_t ticks = 0;
    const bool probing = p_.one_in(2);
    if (probing) conditional(card_map::Opcode::Probe, 0);
    for (std::uint64_t paths = p_.any(1, 5); paths != 0; --paths) {
      instants();
      const std::uint64_t n = p_.one_in(4) ? p_.any(1, 40) : p_.any(100, 3000);
      const bool chords = card_map::has_engine(p_.clocked.core.config().engines, card_map::engine::kArcGenerator);
      if (axes_ >= 2 && chords && p_.one_in(2))
        ticks += chord_arc(n);
      else
        ticks += axes_ >= 2 && p_.one_in(5) ? circle(n) : line(n);
    }
    while (ticks != 0) {
      const std::uint64_t n = std::min(ticks, p_.one_in(4) ? p_.any(1, 30) : p_.any(30, 4000));
      piece(n, pace);
      ticks -= n;
    }
    instants();
    if (p_.one_in(2)) barrier();
    instants();
    if (p_.one_in(6)) conditional(card_map::Opcode::WaitInput, p_.one_in(3) ? 0 : p_.sized(12));
    if (probing && !p_.one_in(6)) p_.send(command_words(card_map::Opcode::ProbeEnd, 0, number_++, 0, {}));
  }

  // Arcs in chords alone, at a path tick for nearly each feed tick.
  void arcs(double pace) {
    std::uint64_t ticks = 0;
    for (int i = 0; i < 4; ++i) ticks += chord_arc(p_.any(500, 3000));
    piece(ticks, pace);
    barrier();
  }

  // Refused where anything runs still.
  void direct_move() {
    for (unsigned n = 0; n < axes_; ++n) {
      p_.write(reg::frequency_lo(n), static_cast<std::uint32_t>(p_.random()));
      p_.write(reg::frequency_hi(n), static_cast<std::uint32_t>(p_.any(0, 40)));
      p_.write(reg::count(n), static_cast<std::uint32_t>(p_.any(0, 40)));
      p_.write(reg::direction(n), static_cast<std::uint32_t>(p_.any(0, 1)));
    }
    p_.write(reg::kLengthLo, static_cast<std::uint32_t>(p_.any(1, 2000)));
    p_.write(reg::kStart, static_cast<std::uint32_t>(p_.any(1, (1U << axes_) - 1)));
  }

 private:
  // Commands that are neither paths nor barriers.
  void instants() {
    while (p_.one_in(3)) {
      if (p_.one_in(2))
        p_.send(command_words(card_map::Opcode::Mark, 0, number_++, 0, {}));
      else
        p_.send(command_words(card_map::Opcode::Output, 0, number_++, 0,
                              {{"set", p_.any(0, 0xFFFF)}, {"clear", p_.any(0, 0xFFFF)}}));
    }
  }

  void conditional(card_map::Opcode opcode, std::uint64_t count) {
    p_.send(command_words(opcode, 0, number_++, count, {{"condition", p_.any(0, 1) << 5 | p_.any(0, 3)}}));
  }

  std::uint64_t line(std::uint64_t ticks) {
    const auto mask = static_cast<std::uint8_t>(p_.any(1, (1U << axes_) - 1));
    std::vector<std::int64_t> increments;
    for (unsigned n = 0; n < card_map::axes_in(mask); ++n) {
      const auto magnitude = static_cast<std::int64_t>(p_.one_in(3) ? p_.sized(40) : p_.any(0, std::uint64_t{1} << 34));
      increments.push_back(p_.one_in(2) ? magnitude : -magnitude);
    }
    p_.send(command_words(card_map::Opcode::Line, mask, number_++, ticks, {}, increments));
    return ticks;
  }

  std::uint64_t circle(std::uint64_t ticks) {
    const std::int64_t r = static_cast<std::int64_t>(p_.any(1, 6));
    ticks = std::max<std::uint64_t>(ticks, static_cast<std::uint64_t>(8 * r));
    const bool can = card_map::has_engine(p_.clocked.core.config().engines, card_map::engine::kAccumulator8);
    const bool eight = can && p_.one_in(2);
    p_.send(CoreBench::circle_words(number_++, ticks, r, p_.one_in(2), eight));
    return ticks;
  }

  // In chords, with any further axes.
  std::uint64_t chord_arc(std::uint64_t ticks) {
    const auto x = static_cast<unsigned>(p_.any(0, axes_ - 1));
    const auto y = static_cast<unsigned>((x + p_.any(1, axes_ - 1)) % axes_);
    const auto mask = static_cast<std::uint8_t>(1U << x | 1U << y | p_.any(0, (1U << axes_) - 1));
    const auto any = [this](unsigned bits) {
      const auto magnitude = static_cast<std::int64_t>(p_.sized(bits));
      return p_.one_in(2) ? magnitude : -magnitude;
    };
    const std::uint64_t path_ticks = p_.any(p_.one_in(2) ? 1 : ticks / 2, ticks);
    const auto k = static_cast<unsigned>(p_.any(1, 24));
    std::vector<std::int64_t> further;
    for (unsigned n = 2; n < card_map::axes_in(mask); ++n) further.push_back(any(36));
    const bool taken = p_.send(command_words(card_map::Opcode::ArcChord, mask, number_++, ticks,
                                             {{"path_ticks", path_ticks},
                                              {"prescale", ((int128{path_ticks} << 40) + ticks / 2) / ticks},
                                              {"plane", y << 8 | x << 4 | p_.any(0, 1)},
                                              {"shifts", k | p_.any(5, 13) << 8},
                                              {"x", any(k + 38)},
                                              {"y", any(k + 38)},
                                              {"first_x", any(38)},
                                              {"first_y", any(38)},
                                              {"closing_x", any(30)},
                                              {"closing_y", any(30)}},
                                             further));
    p_.chord_arcs += taken ? 1 : 0;
    return ticks;
  }

  void piece(std::uint64_t ticks, double pace) {
    const auto rate = static_cast<std::uint64_t>(0x1p64 / pace);
    const auto floor = static_cast<std::uint32_t>(std::max(1.0, 0x1p32 / pace / 3));
    std::int64_t acceleration = 0;
    std::int64_t jerk = 0;
    if (p_.one_in(2)) {
      acceleration = static_cast<std::int64_t>(p_.random()) / static_cast<std::int64_t>(pace * pace * 900);
      if (p_.one_in(2)) jerk = acceleration / -97;
    }
    const auto piece_class = static_cast<std::uint8_t>(p_.one_in(2) ? 0 : p_.any(0, 2));
    p_.send(command_words(card_map::Opcode::Feed, piece_class, number_++, ticks,
                          {{"rate", rate},
                           {"acceleration", acceleration},
                           {"jerk", jerk},
                           {"floor", floor},
                           {"stop_distance", p_.one_in(2) ? 0 : p_.any(1, p_.one_in(4) ? 5000 : 400)}}));
  }

  void barrier() {
    if (p_.one_in(3))
      p_.send(command_words(card_map::Opcode::End, 0, number_++, 0, {}));
    else
      p_.send(command_words(card_map::Opcode::Dwell, 0, number_++, p_.sized(12), {}));
  }

  Pair& p_;
  unsigned axes_;
  std::uint8_t number_ = 0;
};

void disturb(Pair& pair) {
  const auto clocks = [&pair] { return pair.any(1, 3000); };
  switch (pair.any(0, 9)) {
    case 0:
      pair.write(reg::kSlew, static_cast<std::uint32_t>(pair.one_in(2) ? pair.any(0x400, 0x1'0000)
                                                                       : pair.any(0x1'0000, 0xFFF'FFFF)));
      pair.write(reg::kHold, 1);
      pair.wait_in_pieces(clocks(), 4000);
      pair.write(reg::kHold, 0);
      break;
    case 1:
      pair.write(reg::kControl, card_map::field::kControlAbort);
      break;
    case 2: {
      constexpr std::uint32_t kRatios[] = {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};
      pair.write(kRatios[pair.any(0, 2)], static_cast<std::uint32_t>(pair.any(1, 0x10000)));
      break;
    }
    case 3:
      pair.write(reg::kControl, card_map::field::kControlSnapshot);
      break;
    case 4: {
      // A reset of a clock or more.
      model::CoreModel::Inputs in;
      in.rst = true;
      for (std::uint64_t left = pair.any(1, 3); left != 0; --left) {
        pair.clocked.clock(in);
        pair.jumping.clock(in);
      }
      break;
    }
    case 5:
      pair.clocked.pins = pair.jumping.pins = static_cast<std::uint16_t>(pair.any(0, 0xFFFF));
      break;
    case 6:
      pair.write(reg::kControl, card_map::field::kControlProbeClear);
      break;
    case 7:
      pair.write(reg::kOutputSafe, static_cast<std::uint32_t>(pair.random()));
      pair.write(reg::kInputPolarity, static_cast<std::uint32_t>(pair.any(0, 0xFFFF)));
      break;
    default:
      break;
  }
}

// Random programs; what was compared.
struct Compared {
  std::uint64_t waits = 0;
  std::uint64_t steps = 0;
  std::uint64_t clocks = 0;
  std::uint64_t chord_arcs = 0;
  std::uint64_t marks = 0;
  std::uint64_t probed = 0;
  std::uint64_t underruns = 0;
};

Compared compare_programs(Pair::Of of, std::uint64_t programs, std::uint64_t longest) {
  Compared compared;
  for (std::uint64_t i = 0; i < programs && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("TRAMMEL_SEED=" + std::to_string(seed()) + " program " + std::to_string(i));
    model::CardConfig config;
    std::mt19937_64 random(seed() * 1'000'003 + i);
    config.axes = 1 + static_cast<unsigned>(random() % 8);
    config.idle_level = static_cast<std::uint32_t>(random() & ((1U << 2 * config.axes) - 1));
    if (random() % 2 == 0) config.engines |= card_map::engines::kArcGenerator;
    if (random() % 2 == 0) config.engines |= card_map::engines::kAccumulator8;
    Pair pair(of, config, random());
    Program program(pair);
    program.settings();
    const double paces[] = {1.0001, 1.5, 4, 20, 100, 700};
    const double pace = paces[pair.any(0, 5)];
    for (std::uint64_t part = pair.any(1, 3); part != 0; --part) program.paths_and_pieces(pace);
    for (int part = 0; part < 6 && !::testing::Test::HasFatalFailure(); ++part) {
      pair.wait_in_pieces(pair.any(1, 4000), 4000);
      if (pair.one_in(2)) disturb(pair);
    }
    pair.wait_in_pieces(longest, 30'000);
    if (pair.one_in(2)) program.direct_move();
    pair.wait_in_pieces(longest / 10, 3000);
    compared.waits += pair.waits;
    compared.steps += pair.steps;
    compared.chord_arcs += pair.chord_arcs;
    const std::uint32_t marks = pair.clocked.read(reg::kMarks);
    EXPECT_EQ(pair.jumping.read(reg::kMarks), marks);
    compared.marks += marks;
    // A probe that tripped has latched its time.
    compared.probed += pair.clocked.read(reg::time_lo(card_map::Area::Probe)) != 0 ? 1U : 0U;
    compared.underruns += pair.clocked.read(reg::kUnderruns);
    compared.clocks += pair.one_by_one / 2;
  }
  return compared;
}

bool long_run() { return std::getenv("TRAMMEL_LONG") != nullptr; }

TEST(Run, EqualsClock) {
  const std::uint64_t programs = long_run() ? 4000 : 80;
  const Compared compared = compare_programs(Pair::Of::ClockAndRun, programs, 200'000);
  EXPECT_GT(compared.waits, 20 * programs);
  EXPECT_GT(compared.steps, 20 * programs);
  EXPECT_GT(compared.chord_arcs, programs / 4);
  EXPECT_GT(compared.marks, programs / 5);
  EXPECT_GT(compared.probed, programs / 10);
}

// Jumps that end anywhere between a feed tick and the step of its path tick.
TEST(Run, EqualsClockOnArcsInChords) {
  const std::uint64_t programs = long_run() ? 1000 : 40;
  std::uint64_t steps = 0;
  for (std::uint64_t i = 0; i < programs && !HasFailure(); ++i) {
    SCOPED_TRACE("TRAMMEL_SEED=" + std::to_string(seed()) + " program " + std::to_string(i));
    model::CardConfig config;
    config.engines |= card_map::engines::kArcGenerator;
    config.engines |= card_map::engines::kAccumulator8;
    Pair pair(Pair::Of::ClockAndRun, config, seed() * 1'000'003 + i);
    Program program(pair);
    const double paces[] = {5, 9.7, 31, 120};
    const double pace = paces[i % 4];
    program.arcs(pace);
    for (std::uint64_t left = 1500; left != 0 && !HasFatalFailure(); --left) {
      pair.wait(pair.any(1, static_cast<std::uint64_t>(8 * pace)));
      pair.compare();
    }
    steps += pair.steps;
  }
  EXPECT_GT(steps, 30 * programs);
}

// Holds and overrides so slow that most of the program is a ramp.
TEST(Run, EqualsClockWhileTheRatioSlews) {
  const std::uint64_t programs = long_run() ? 1500 : 30;
  std::uint64_t steps = 0;
  std::uint64_t on_ramps = 0;
  for (std::uint64_t i = 0; i < programs && !HasFailure(); ++i) {
    SCOPED_TRACE("TRAMMEL_SEED=" + std::to_string(seed()) + " program " + std::to_string(i));
    model::CardConfig config;
    if (i % 2 == 0) config.engines |= card_map::engines::kArcGenerator;
    Pair pair(Pair::Of::ClockAndRun, config, seed() * 1'000'003 + i);
    Program program(pair);
    program.settings();
    const double paces[] = {1.5, 7, 40, 300};
    for (int part = 0; part < 3; ++part) program.paths_and_pieces(paces[i % 4]);
    for (int part = 0; part < 60 && !HasFatalFailure(); ++part) {
      constexpr std::uint32_t kRatios[] = {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};
      if (pair.one_in(3)) pair.write(reg::kSlew, static_cast<std::uint32_t>(pair.any(1, 0x400) << pair.any(0, 9)));
      if (pair.one_in(4)) pair.write(reg::kHold, static_cast<std::uint32_t>(pair.any(0, 1)));
      if (pair.one_in(2)) pair.write(kRatios[pair.any(0, 2)], static_cast<std::uint32_t>(pair.any(0, 0x10000)));
      pair.wait_on_ramps(pair.one_in(3) ? pair.any(1, 20'000) : pair.any(1, 500));
      pair.compare();
    }
    steps += pair.steps;
    on_ramps += pair.on_ramps;
  }
  EXPECT_GT(steps, 20 * programs);
  EXPECT_GT(on_ramps, 20'000 * programs);
}

// A jump that ends while a step waits for a reversal: a hold tick that has passed must count when the next one comes.
TEST(Run, EndsWhileAStepWaits) {
  unsigned faults = 0;
  for (std::uint64_t wait = 2000; wait < 3600; wait += 5) {
    model::CardConfig config;
    config.axes = 1;
    Pair pair(Pair::Of::ClockAndRun, config, wait);
    pair.write(reg::dir_setup(0), 300);
    pair.write(reg::dir_hold(0), 300);
    pair.write(reg::kHoldLimit, static_cast<std::uint32_t>(320 + wait % 97));
    const std::int64_t increment = kOnePulse / 100;
    pair.send(command_words(card_map::Opcode::Line, 1, 0, 250, {}, {increment}));
    pair.send(command_words(card_map::Opcode::Line, 1, 1, 140, {}, {-increment}));
    pair.send(command_words(card_map::Opcode::Feed, 0, 2, 390, {{"rate", int128{1} << 61}, {"floor", 1}}));
    pair.wait(wait);
    pair.compare();
    pair.write(reg::kHoldLimit, 1);
    for (int i = 0; i < 8; ++i) {
      pair.wait(1);
      pair.compare();
    }
    faults += pair.clocked.core.outputs().fault != 0 ? 1U : 0U;
    ASSERT_FALSE(HasFatalFailure()) << "wait " << wait;
  }
  EXPECT_GT(faults, 30U);
}

TEST(RestingBlocks, ChangeNothing) {
  const std::uint64_t programs = long_run() ? 1500 : 60;
  const Compared compared = compare_programs(Pair::Of::AllAndResting, programs, 20'000);
  EXPECT_GT(compared.clocks, 22'000 * programs);
  EXPECT_GT(compared.steps, 20 * programs);
  EXPECT_GT(compared.chord_arcs, programs / 4);
  EXPECT_GT(compared.marks, programs / 5);
  EXPECT_GT(compared.probed, programs / 10);
}

}  // namespace
}  // namespace trammel::testing
