// Every adaptor of trammel::skip: n clocks at once must leave the same complete state as n calls of clock(), and no
// output may change within the horizon. Random inputs drive the blocks into random states; n is around the end of the
// horizon. The test must detect a horizon that is one clock too long for each adaptor, and for adaptors with finite
// horizons it must detect one further clock at the end of such a horizon.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "fields.hpp"
#include "trammel/skip/axis.hpp"
#include "trammel/skip/card_inputs.hpp"
#include "trammel/skip/commands.hpp"
#include "trammel/skip/control.hpp"
#include "trammel/skip/feed_generator.hpp"
#include "trammel/skip/path_engines.hpp"
#include "trammel/skip/sequencer.hpp"
#include "trammel/skip/time_base.hpp"
#include "trammel/skip/underrun_guard.hpp"

namespace trammel::model {
// SnapshotWriter has no state() of its own: compares its visible state.
inline bool operator==(const SnapshotWriter& a, const SnapshotWriter& b) {
  return a.strobe() == b.strobe() && a.busy() == b.busy() && a.area() == b.area() && a.word() == b.word();
}
}  // namespace trammel::model

namespace trammel::testing {
namespace {

using Random = std::mt19937_64;

// Events with probability 1 / `rare`; small and large numbers.
template <class T>
void fill(T& value, Random& random, unsigned rare) {
  if constexpr (std::is_same_v<T, bool>) {
    value = random() % rare == 0;
  } else if constexpr (std::is_integral_v<T>) {
    value = static_cast<T>(random() >> random() % 64);
  } else if constexpr (IsList<T>::value) {
    for (auto& item : value) fill(item, random, rare);
  } else if constexpr (std::is_aggregate_v<T>) {
    std::apply([&](auto&... field) { (fill(field, random, rare), ...); }, fields_of(value));
  }
}

// Number of tested horizons, and of detected clocks beyond a horizon.
struct Tally {
  std::uint64_t finite = 0;  // finite horizons
  std::uint64_t endless = 0;
  std::uint64_t caught = 0;
  std::uint64_t borders = 0;  // those of `caught` at a finite horizon
};

template <class Block>
bool at_once_equals_clocks(const Block& block, const typename Block::Inputs& in, std::uint64_t clocks) {
  Block clocked = block;
  Block skipped = block;
  for (std::uint64_t i = 0; i < clocks; ++i) clocked.clock(in);
  skip::advance(skipped, in, clocks);
  return same(clocked, skipped);
}

template <class Block>
bool outputs_stay(const Block& block, const typename Block::Inputs& in, std::uint64_t clocks) {
  if constexpr (HasOutputs<Block>::value) {
    Block skipped = block;
    skip::advance(skipped, in, clocks);
    return same(block.outputs(), skipped.outputs());
  }
  return true;
}

// `legal` changes random inputs into inputs that the block may get.
template <class Block, class Legal>
void judge(Block block, unsigned rare, const Legal& legal, bool has_finite = false) {
  Random random(1);
  Tally tally;
  for (unsigned i = 0; i < 30'000; ++i) {
    typename Block::Inputs in{};
    fill(in, random, random() % 4 == 0 ? 1'000'000 : rare);
    legal(in, block, random);
    const std::uint64_t horizon = skip::horizon(block, in);
    const std::uint64_t most = std::min<std::uint64_t>(horizon, 300);
    if (horizon != 0) ++(horizon == skip::kForever ? tally.endless : tally.finite);
    for (const std::uint64_t n : {most, most - 1, random() % 300}) {
      if (n > most) continue;
      ASSERT_TRUE(at_once_equals_clocks(block, in, n)) << "try " << i << ": " << n << " clocks of " << horizon;
      ASSERT_TRUE(outputs_stay(block, in, n)) << "try " << i << ": " << n << " clocks of " << horizon;
    }
    if (horizon < 300 && !(at_once_equals_clocks(block, in, horizon + 1) && outputs_stay(block, in, horizon + 1))) {
      ++tally.caught;
      if (horizon != 0) ++tally.borders;
    }
    for (std::uint64_t n = random() % 4 == 0 ? random() % 40 : 1; n != 0; --n) {
      block.clock(in);
      in = {};
      legal(in, block, random);
    }
  }
  EXPECT_GT(tally.endless + tally.finite, 100U);
  EXPECT_GT(tally.caught, 100U) << "a horizon one clock too long";
  if (has_finite) {
    EXPECT_GT(tally.borders, 100U) << "of " << tally.finite << " finite horizons";
  }
}

const auto kAny = [](auto&, const auto&, Random&) {};

// A load-bus target of some block.
std::uint16_t some_target(Random& random) {
  namespace target = model::load_target;
  const unsigned all[] = {target::increment(1),  target::count(1), target::kPrescale,   target::kDeviation,
                          target::kGradientX,    target::kEndX,    target::kPlane,      target::kChordShifts,
                          target::kChordClosing, target::kCommand, target::kChordPlane, target::kChordState};
  return static_cast<std::uint16_t>(all[random() % std::size(all)]);
}

TEST(Skip, StepShaper) {
  judge(
      model::StepShaper(), 9,
      [](auto& in, const auto&, Random& random) {
        in.step_length = in.step_space = in.dir_setup = in.dir_hold = 40;
        in.mode = static_cast<std::uint8_t>(random() % 50 == 0);
      },
      true);
}
TEST(Skip, PulseGenerator) {
  judge(
      model::PulseGenerator(), 9,
      [](auto& in, const auto&, Random& random) {
        in.tick = random() % 2 == 0;
        if (in.load_increment && random() % 2 == 0) in.word &= 0xFF;
      },
      true);
}
TEST(Skip, Axis) {
  judge(model::Axis(1), 30, [](auto& in, const auto&, Random& random) {
    in.load.target = some_target(random);
    in.setting.address = static_cast<std::uint32_t>(card_map::reg::step_space(1) + 4 * (random() % 4));
    in.setting.data %= 30;
  });
}
TEST(Skip, Watchdog) {
  for (std::uint64_t left = 0; left < 40; ++left) {
    model::Watchdog block;
    block.state().left = left;
    const std::uint64_t horizon = skip::horizon(block, {});
    EXPECT_EQ(horizon, left == 0 ? skip::kForever : left - 1);
    for (std::uint64_t n = 0; n <= std::min<std::uint64_t>(horizon, 60); ++n)
      ASSERT_TRUE(at_once_equals_clocks(block, {}, n)) << left << " left, " << n << " clocks";
    EXPECT_EQ(at_once_equals_clocks(block, {}, left), left == 0) << "a clock too many";
    EXPECT_EQ(skip::horizon(block, {true, card_map::reg::kWatchdog, 1}), 0U);
  }
}
TEST(Skip, WaitTimer) {
  judge(
      model::WaitTimer(), 100,
      [](auto& in, const auto&, Random&) {
        in.address = card_map::reg::kHoldLimit;
        in.data = in.data % 200 + 1;
      },
      true);
}
TEST(Skip, TimeBase) {
  judge(model::TimeBase(), 30, [](auto& in, const auto&, Random& random) {
    in.piece_class = static_cast<std::uint8_t>(random() % 20 == 0);
    in.slew_shift = static_cast<std::uint8_t>(random() % 20 == 0 ? random() % 4 : 0);
    in.setting.address = random() % 2 == 0 ? card_map::reg::kRatioFeed : card_map::reg::kRatioRapid;
    in.setting.data = random() % 3 == 0 ? 0 : 0x10000;
  });
}
TEST(Skip, FeedGenerator) {
  judge(model::FeedGenerator(), 9, [](auto& in, const auto&, Random&) { in.load.target %= 7; });
}
TEST(Skip, DeviationAccumulator) {
  judge(
      model::DeviationAccumulator(), 9,
      [](auto& in, const auto& block, Random& random) {
        in.load.target = static_cast<std::uint16_t>(model::load_target::kDeviation + random() % 9);
        in.load.valid = in.load.valid && random() % 4 == 0;
        in.start = in.start && block.state().wait == 0;
      },
      true);
}
TEST(Skip, ArcGenerator) {
  judge(
      model::ArcGenerator(), 9,
      [](auto& in, const auto& block, Random& random) {
        in.load = {};
        in.clear = random() % 500 == 0;
        in.start = block.outputs().loadable && random() % 4 == 0;
        in.tick = block.outputs().ready && random() % 2 == 0;
      },
      true);
}
TEST(Skip, PathEngines) {
  judge(model::PathEngines(), 30, [](auto& in, const auto&, Random& random) {
    in.load.target = some_target(random);
    in.engine %= 3;
  });
}
TEST(Skip, StopControl) {
  judge(model::StopControl(), 9, [](auto& in, const auto&, Random& random) {
    in.step_fault = random() % 50 == 0;
    if (random() % 4 != 0) in.clear = 0;
    in.setting.address = card_map::reg::kHold;
    in.causes.beyond = in.causes.beyond && in.causes.limit;
  });
}
TEST(Skip, LimitCheck) {
  judge(model::LimitCheck(4), 9, [](auto& in, const auto&, Random& random) {
    if (random() % 4 != 0) {
      in.step = 0;
      in.clear = 0;
      in.setting.set = false;
      // The levels as they were during the quiet clocks before.
      in.roles = {};
      in.roles.probe = in.roles.tool_setter = random() % 8 != 0;
    }
    in.setting.address = random() % 2 == 0 ? card_map::reg::kLimitOverride : card_map::reg::overtravel(1);
  });
}
// Positions around the ends; pulses are rare.
TEST(Skip, SoftLimits) {
  judge(model::SoftLimits(5), 9, [](auto& in, const auto&, Random& random) {
    if (random() % 4 != 0) {
      in.counts = 0;
      in.clear = in.setting.set = false;
    }
    for (std::uint32_t& position : in.position) position = static_cast<std::uint32_t>(random() % 4);
    const std::uint32_t registers[] = {card_map::reg::kSoftLimits, card_map::reg::soft_plus(1),
                                       card_map::reg::soft_minus(4)};
    in.setting.address = registers[random() % 3];
  });
}
TEST(Skip, MachinePlace) {
  judge(model::MachinePlace(4), 9, [](auto& in, const auto&, Random& random) {
    if (random() % 4 != 0) {
      in.step = 0;
      in.drives = 0;
    }
    in.setting.address = random() % 3 == 0 ? card_map::reg::kKeepsPlace : card_map::reg::kSetPlace;
    in.setting.data |= 3;
  });
}
TEST(Skip, EmergencyStop) {
  judge(model::EmergencyStop(), 3, [](auto& in, const auto&, Random& random) { in.pin = random() % 8 == 0; });
}
TEST(Skip, DriveEnable) {
  judge(
      model::DriveEnable(4, 1, 2), 9,
      [](auto& in, const auto&, Random& random) {
        if (random() % 8 != 0) in.emergency = false;
        if (random() % 4 != 0) in.fault = 0;
        constexpr std::uint32_t kPlaces[] = {card_map::reg::kEnable,     card_map::reg::kEnableAxes,
                                             card_map::reg::kEnableIdle, card_map::reg::kEnableDelay,
                                             card_map::reg::kStopDelay,  card_map::reg::kDisableCauses};
        in.setting.address = kPlaces[random() % 6];
        in.setting.data %= 16;
      },
      true);
}
TEST(Skip, CardHealth) {
  judge(
      model::CardHealth(), 9,
      [](auto& in, const auto&, Random& random) {
        if (random() % 4 != 0) in.fault = 0;
        const bool pump = random() % 2 == 0;
        in.setting.address = pump ? card_map::reg::kChargePump : card_map::reg::kHealthCauses;
        if (pump) in.setting.data %= 64;
      },
      true);
}
TEST(Skip, ButtonHold) { judge(model::ButtonHold(), 3, kAny); }
TEST(Skip, Probe) {
  judge(model::Probe(), 9, [](auto& in, const auto&, Random& random) {
    in.load.target = some_target(random);
    in.waits = random() % 16 != 0;  // high long enough to take effect
  });
}
TEST(Skip, PathCommands) {
  judge(model::PathCommands({}), 9,
        [](auto& in, const auto&, Random& random) { in.load.target = some_target(random); });
}
// Periods that end within the tested clocks, and motion that starts and stops.
TEST(Skip, PathCommandsWithPwm) {
  model::Pwm::Speed speed;
  judge(
      model::PathCommands({}, true), 60,
      [&](auto& in, const auto&, Random& random) {
        namespace reg = card_map::reg;
        in.load.target = some_target(random);
        if (random() % 3000 == 0) {
          const std::uint32_t addresses[] = {reg::kPwmPeriod0, reg::kPwmPeriod1, reg::kPwmOutputs};
          in.setting = {true, addresses[random() % 3], 100};
          in.setting.data = in.setting.address == reg::kPwmOutputs ? static_cast<std::uint32_t>(random() % 3) * 0x8001
                                                                   : 100 + static_cast<std::uint32_t>(random() % 1500);
        }
        if (random() % 100 == 0) speed.runs = !speed.runs;
        if (random() % 300 == 0) speed.gives = random() % 4 != 0;
        speed.silent = random() % 200 == 0;
        if (random() % 60 == 0) speed.rate = static_cast<std::uint32_t>(random());
        if (random() % 300 == 0) speed.ratio = random() % 3 == 0 ? 0 : 0x10000;
        in.speed = speed;
      },
      true);
}
TEST(Skip, InputPins) {
  judge(model::InputPins(6), 9, [](auto& in, const auto&, Random& random) {
    in.pins = random() % 16 == 0;
    in.setting.address = card_map::reg::kInputPolarity;
  });
}
// Levels change rarely, so that filters reach their ends.
TEST(Skip, InputFilter) {
  std::uint32_t levels = 0;
  judge(
      model::InputFilter(), 9,
      [&](auto& in, const auto& block, Random& random) {
        if (random() % 200 == 0) levels ^= std::uint32_t{1} << random() % 32;
        in.levels = levels;
        in.set = in.set && random() % 4 == 0 && !block.state().clearing;
        in.set_input %= 32;
        in.set_length %= 4;
      },
      true);
}
TEST(Skip, InputFilterThatTellsQuiet) {
  std::uint32_t levels = 0;
  judge(
      model::InputFilter(true), 9,
      [&](auto& in, const auto& block, Random& random) {
        if (random() % 200 == 0) levels ^= std::uint32_t{1} << random() % 32;
        in.levels = levels;
        in.set = in.set && random() % 4 == 0 && !block.state().clearing;
        in.set_input %= 32;
        in.set_length %= 4;
      },
      true);
}
TEST(Skip, Captures) {
  std::uint32_t levels = 0;
  judge(model::Captures(4), 9, [&](auto& in, const auto& block, Random& random) {
    if (random() % 40 == 0) levels ^= std::uint32_t{1} << random() % 4;
    in.raw = in.levels = levels;
    in.quiet = ~0U;
    in.setting.set = random() % 100 == 0;
    in.setting.address = random() % 3 == 0 ? card_map::reg::kCaptureClear
                                           : card_map::reg::capture_select(static_cast<std::uint32_t>(random() % 4));
    in.setting.data = random() % 4 | (random() & 0xF00);
    in.queued = random() % 4 == 0 ? block.passed() : std::uint8_t{0};
    in.captured = random() % 4 == 0 ? block.asks(in) : std::uint8_t{0};
  });
}
TEST(Skip, RoleScan) {
  std::uint32_t levels = 0;
  judge(model::RoleScan(3), 9, [&](auto& in, const auto&, Random& random) {
    if (random() % 200 == 0) levels ^= std::uint32_t{1} << random() % 8;
    in.levels = levels;
    in.set = in.set && random() % 16 == 0;
    in.set_role %= 64;
    in.set_mask = random() & random() & 0xFF;
  });
}
TEST(Skip, CardInputs) {
  std::uint32_t pins = 0;
  judge(
      model::CardInputs(3, 8, model::RegisterFile::kMaxEngines), 9,
      [&](auto& in, const auto& block, Random& random) {
        if (random() % 400 == 0) pins ^= std::uint32_t{1} << random() % 8;
        in.pins = pins;
        in.setting.set = random() % 500 == 0 && !block.state().filter.state().clearing;
        const std::uint32_t address[] = {card_map::reg::kInputPolarity,
                                         card_map::reg::input_filter(static_cast<std::uint32_t>(random() % 8)),
                                         card_map::reg::role(static_cast<std::uint32_t>(random() % 64))};
        in.setting.address = address[random() % 3];
        in.setting.data = in.setting.address == address[1] ? random() % 4 : random() & 0xFF;
      },
      true);
}
TEST(Skip, HalfwordQueue) {
  judge(model::HalfwordQueue(16), 3,
        [](auto& in, const auto& block, Random&) { in.write = in.write && block.free() != 0; });
}
TEST(Skip, QueueWatermarks) {
  judge(model::QueueWatermarks(100, 60), 9, [](auto& in, const auto&, Random& random) {
    in.geometry_room %= 101;
    in.feed_room %= 61;
    in.setting.address = random() % 2 == 0 ? card_map::reg::kGeometryWatermark : card_map::reg::kFeedWatermark;
    in.setting.data %= 100;
  });
}
TEST(Skip, DirectLoader) { judge(model::DirectLoader(4), 30, kAny); }
TEST(Skip, CommandChecker) { judge(model::CommandChecker(4, 0xFF), 9, kAny); }
TEST(Skip, PositionStreaming) {
  judge(model::PositionStreaming(), 9,
        [](auto& in, const auto&, Random&) { in.setting.address = card_map::reg::kStreaming; });
}
TEST(Skip, UnderrunGuard) {
  judge(model::UnderrunGuard(), 30, [](auto& in, const auto&, Random&) {
    in.ratio = 0x10000;
    in.arrival.halfword = 0;
  });
}
TEST(Skip, RegisterFile) {
  judge(model::RegisterFile({}), 30, [](auto& in, const auto&, Random&) {
    in.port = 0;
    in.address &= 0xFFF;
    in.loader_address = 0;
    in.captures &= 0xF;
    in.passed = 0;
  });
}
TEST(Skip, Axi4LitePort) { judge(model::Axi4LitePort(), 3, kAny); }
// The halfword that a fetch is about to take: the first one of a barrier, or a short count.
std::uint16_t word_for(const model::CommandFetch& fetch, Random& random) {
  const int index = fetch.state().arriving[1];
  if (index == 0)
    return static_cast<std::uint16_t>(random() % 2 == 0 ? card_map::Opcode::Dwell : card_map::Opcode::End);
  return index == 1 ? static_cast<std::uint16_t>(random() % 100) : std::uint16_t{0};
}
TEST(Skip, Sequencer) {
  judge(
      model::Sequencer(), 100,
      [](auto& in, const auto& block, Random& random) {
        const bool starts = random() % 8 == 0;
        in.geometry_empty = in.feed_empty = !starts;
        in.payload_ready = in.shadows_free = in.engine_ready = in.engine_done = in.at_rest = true;
        in.geometry_word = word_for(block.state().geometry, random);
        in.feed_word = word_for(block.state().feed, random);
        in.halt = in.drop = in.direct_go = false;
      },
      true);
}

std::uint16_t path_word(const model::CommandFetch& fetch, card_map::Opcode opcode, Random& random) {
  const int index = fetch.state().arriving[1];
  if (index == 0) return static_cast<std::uint16_t>(static_cast<unsigned>(opcode) | 1U << 8);
  return index == 1 ? static_cast<std::uint16_t>(random() % 100) : std::uint16_t{0};
}

// Paths under a feed: each clock that the adaptor counts must end in the same state as clock().
TEST(Skip, SequencerCounts) {
  Random random(1);
  model::Sequencer block;
  unsigned ticks = 0;
  unsigned left_to_clock = 0;
  for (unsigned i = 0; i < 300'000; ++i) {
    model::Sequencer::Inputs in{};
    fill(in, random, 300);
    in.payload_ready = in.shadows_free = in.engine_ready = in.engine_done = in.at_rest = in.enable = true;
    in.geometry_empty = in.feed_empty = random() % 8 != 0;
    in.halt = in.drop = in.direct_go = in.cut = in.wait = false;
    in.cut = block.outputs().mismatch;
    in.feed_tick = random() % 8 == 0;
    in.geometry_word = path_word(block.state().geometry, card_map::Opcode::Line, random);
    in.feed_word = path_word(block.state().feed, card_map::Opcode::Feed, random);
    model::Sequencer counted = block;
    const bool counts = skip::count(counted, in);
    block.clock(in);
    if (!counts) {
      left_to_clock += block.outputs().tick ? 1U : 0U;
      continue;
    }
    ASSERT_TRUE(same(block, counted)) << "clock " << i;
    ticks += block.outputs().tick ? 1U : 0U;
  }
  EXPECT_GT(ticks, 1'000U);
  EXPECT_GT(left_to_clock, 100U) << "last ticks of paths and pieces";
}

}  // namespace
}  // namespace trammel::testing
