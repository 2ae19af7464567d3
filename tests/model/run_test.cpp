// CoreModel::run() against clock(): the same random programs run on two cores, one of which jumps from step to step.
// Outputs, positions and reported steps are compared after waits of random length.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

#include "core_pair.hpp"
#include "random_program.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;

// Filters, roles and reactions to roles; the pins change later.
void give_roles(Pair& pair, unsigned axes) {
  for (std::uint64_t n = pair.any(1, 5); n != 0; --n) {
    constexpr std::uint32_t kKinds[] = {0, 1, 4};
    const auto of_axis = static_cast<std::uint32_t>(8 * kKinds[pair.any(0, 2)] + pair.any(0, axes - 1));
    const std::uint32_t role = pair.one_in(3) ? static_cast<std::uint32_t>(pair.any(48, 51)) : of_axis;
    pair.write(reg::role(role), 1U << pair.any(0, 7));
  }
  for (std::uint64_t n = pair.any(0, 4); n != 0; --n) {
    const auto length = static_cast<std::uint32_t>(pair.one_in(3) ? pair.any(0, 2) : pair.any(0, 60));
    pair.write(reg::input_filter(static_cast<std::uint32_t>(pair.any(0, 7))), length);
  }
  pair.write(reg::kStopCauses, static_cast<std::uint32_t>(pair.random() & 0x60000));
  pair.write(reg::kStopReaction, static_cast<std::uint32_t>(pair.random() & 0x76800));
  pair.write(reg::overtravel(static_cast<std::uint32_t>(pair.any(0, axes - 1))),
             static_cast<std::uint32_t>(pair.any(0, 200)));
}

// Ends that some of the following steps pass; on a third of the cards they are off.
void give_soft_limits(Pair& pair, unsigned axes) {
  for (unsigned n = 0; n < axes; ++n) {
    pair.write(reg::soft_minus(n), static_cast<std::uint32_t>(-static_cast<std::int64_t>(pair.any(0, 6))));
    pair.write(reg::soft_plus(n), static_cast<std::uint32_t>(pair.any(0, 6)));
  }
  pair.write(reg::kSoftLimits, static_cast<std::uint32_t>(pair.one_in(3) ? 0 : pair.any(1, 255)));
}

// Some periods are as short as the way of a step, others longer than any program.
void give_pulses(Pair& pair) {
  for (const std::uint32_t period : {reg::kPwmPeriod0, reg::kPwmPeriod1})
    pair.write(period, static_cast<std::uint32_t>(pair.one_in(3) ? pair.any(100, 700) : pair.any(500, 40'000)));
  pair.write(reg::kPwmOutputs, static_cast<std::uint32_t>(pair.any(0, 15) | pair.any(0, 15) << 16));
}

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
      // A reset of one to three clocks.
      model::CoreModel::Inputs in;
      in.rst = true;
      for (std::uint64_t left = pair.any(1, 3); left != 0; --left) {
        pair.clocked.clock(in);
        pair.jumping.clock(in);
      }
      break;
    }
    case 5:
      pair.clocked.pins = pair.jumping.pins =
          static_cast<std::uint32_t>(pair.one_in(2) ? 1U << pair.any(0, 15) : pair.any(0, 0xFFFF));
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

// Totals of the compared programs.
struct Compared {
  std::uint64_t waits = 0;
  std::uint64_t steps = 0;
  std::uint64_t clocks = 0;
  std::uint64_t chord_arcs = 0;
  std::uint64_t marks = 0;
  std::uint64_t probed = 0;
  std::uint64_t underruns = 0;
  std::uint64_t stopped_by_inputs = 0;  // number of cards
  std::uint64_t stopped_by_soft_limits = 0;
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
    const bool roles = random() % 2 == 0;
    if (roles) config.engines |= card_map::engines::kMachineInputs | card_map::engines::kSoftLimits;
    if (roles) config.inputs = 8;
    const bool pwm = random() % 2 == 0;
    if (pwm) config.engines |= card_map::engines::kPwm;
    Pair pair(of, config, random());
    Program program(pair);
    program.pwm = pwm;
    program.settings();
    if (pwm) give_pulses(pair);
    if (roles) give_roles(pair, config.axes);
    if (roles) give_soft_limits(pair, config.axes);
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
    constexpr std::uint32_t kByInputs = card_map::field::kFaultLimit | card_map::field::kFaultDriveFault |
                                        card_map::field::kFaultProbe | card_map::field::kFaultToolSetter;
    compared.stopped_by_soft_limits +=
        (pair.clocked.read(reg::kFault) & card_map::field::kFaultSoftLimit) != 0 ? 1U : 0U;
    pair.jumping.read(reg::kFault);
    compared.stopped_by_inputs += (pair.clocked.read(reg::kFault) & kByInputs) != 0 ? 1U : 0U;
    pair.jumping.read(reg::kFault);
    compared.waits += pair.waits;
    compared.steps += pair.steps;
    compared.chord_arcs += pair.chord_arcs;
    const std::uint32_t marks = pair.clocked.read(reg::kMarks);
    EXPECT_EQ(pair.jumping.read(reg::kMarks), marks);
    compared.marks += marks;
    // A probe that has tripped has a time.
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
  EXPECT_GT(compared.stopped_by_inputs, programs / 40);
  EXPECT_GT(compared.stopped_by_soft_limits, programs / 40);
  EXPECT_GT(compared.chord_arcs, programs / 4);
  EXPECT_GT(compared.marks, programs / 5);
  EXPECT_GT(compared.probed, programs / 10);
}

// The jumps end at any clock between a feed tick and the step of its path tick.
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

// Holds and overrides with such a slow slew that most of the program is a ramp.
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

// A jump ends while a step waits for a reversal. A wait tick that has passed must count when the next one comes.
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
