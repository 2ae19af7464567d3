// From the role of an input to the last pulse: the latencies in the table of docs/reference/behaviour.md, for every
// clock between two steps; and which conditions stop, hold or do nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "trammel/model/halfword_queue.hpp"
#include "trammel/model/motion_core.hpp"

namespace trammel::model {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Opcode;

constexpr unsigned kStepEvery = 16;  // clocks

// A motion core on a line of its first axis, with a step every kStepEvery clocks.
class MovingCore {
 public:
  explicit MovingCore(bool backwards = false) : core(2, 0, card_map::engines::kMachineInputs) {
    command(geometry_, Opcode::Line, 1, {{"increment", backwards ? -(std::int64_t{1} << 40) : std::int64_t{1} << 40}});
    command(feed_, Opcode::Feed, 0, {{"rate", std::int64_t{1} << (64 - 4)}, {"floor", 1}});
    set(reg::kSlew, 0x40000);  // 4,096 clocks from full ratio to rest
    run(2'000);
  }

  void clock() {
    in.geometry_empty = geometry_.outputs().empty;
    in.geometry_word = geometry_.outputs().word;
    in.feed_empty = feed_.outputs().empty;
    in.feed_word = feed_.outputs().word;
    HalfwordQueue::Inputs geometry;
    HalfwordQueue::Inputs feed;
    geometry.read = core.sequencer().geometry_read();
    feed.read = core.sequencer().feed_read();
    geometry.clear = feed.clear = core.stop().cut;
    core.clock(in);
    geometry_.clock(geometry);
    feed_.clock(feed);
    ++now;
    if (core.position(0) != position_) last_step = now;
    if (core.stop().fault != 0 && latched == 0) latched = now;
    if (core.stop().hold && held == 0) held = now;
    position_ = core.position(0);
  }
  void run(unsigned clocks) {
    for (; clocks != 0; --clocks) clock();
  }
  void set(std::uint32_t address, std::uint32_t data) {
    in.setting = {true, address, data};
    clock();
    in.setting = {};
  }
  void clear_faults() {
    in.clear_fault = ~0U;
    clock();
    in.clear_fault = 0;
  }
  std::int32_t position() const { return static_cast<std::int32_t>(core.position(0)); }

  MotionCore core;
  MotionCore::Inputs in;
  std::uint64_t now = 0;
  std::uint64_t last_step = 0;
  std::uint64_t latched = 0;
  std::uint64_t held = 0;

 private:
  static void command(HalfwordQueue& queue, Opcode opcode, std::uint8_t mask,
                      const std::vector<std::pair<std::string, std::int64_t>>& values) {
    constexpr std::uint64_t kTicks = 100'000;
    const card_map::Command& layout = *card_map::find_command(static_cast<std::uint8_t>(opcode));
    std::vector<std::uint16_t> words{
        static_cast<std::uint16_t>(static_cast<unsigned>(opcode) | static_cast<unsigned>(mask) << 8),
        static_cast<std::uint16_t>(kTicks), static_cast<std::uint16_t>(kTicks >> 16), 0};
    words.resize(card_map::queue_halfwords(layout, mask), 0);
    for (const auto& [name, value] : values) {
      const auto found = std::find_if(layout.fields.begin(), layout.fields.begin() + layout.field_count,
                                      [&name = name](const card_map::Field& f) { return f.name == name; });
      for (unsigned i = 0; i < found->halfwords; ++i)
        words[4U + found->offset + i] = static_cast<std::uint16_t>(value >> std::min(16U * i, 63U));
    }
    HalfwordQueue::Inputs in;
    in.write = true;
    for (const std::uint16_t word : words) {
      in.word = word;
      queue.clock(in);
    }
    in = {};
    in.commit = true;
    queue.clock(in);
    queue.clock({});
  }

  HalfwordQueue geometry_{256};
  HalfwordQueue feed_{256};
  std::uint32_t position_ = 0;
};

struct Latency {
  std::uint64_t latch = 0;  // longest, in clocks from the level of the role
  std::uint64_t hold = 0;
  std::uint64_t last_step = 0;
};

// The longest latency over all clocks between two steps.
template <class Event>
Latency latency(std::uint32_t reaction, const Event& event) {
  Latency longest;
  for (unsigned phase = 0; phase < kStepEvery; ++phase) {
    MovingCore moving(true);
    moving.set(reg::kStopReaction, reaction);
    moving.set(reg::kStopCauses, field::kStopCausesProbe | field::kStopCausesToolSetter);
    moving.set(reg::overtravel(0), 0xFFFF);
    moving.run(100 + phase);
    const std::uint64_t begin = moving.now;
    event(moving.in.roles);
    moving.run(10'000);
    const auto longer = [begin](std::uint64_t& than, std::uint64_t at) {
      if (at > begin) than = std::max(than, at - begin);
    };
    longer(longest.latch, moving.latched);
    longer(longest.hold, moving.held);
    longer(longest.last_step, moving.last_step);
  }
  return longest;
}

TEST(MachineStops, LatenciesAreThoseOfThePage) {
  const auto drive = [](InputRoles& roles) { roles.drive_fault = 1; };
  const auto limit = [](InputRoles& roles) { roles.limit_minus = 1; };
  const auto probe = [](InputRoles& roles) { roles.probe = true; };
  const auto button = [](InputRoles& roles) { roles.feed_hold = true; };
  constexpr std::uint32_t kRamp = 0x66CFF;
  constexpr std::uint64_t kToStep = kStepEvery - 1;  // a limit waits for the next step
  constexpr std::uint64_t kRest = 4'096 + 100;       // clocks: SLEW from full ratio to rest
  const auto expect = [](const Latency& found, std::uint64_t latch, std::uint64_t hold, std::uint64_t last) {
    EXPECT_EQ(found.latch, latch);
    EXPECT_EQ(found.hold, hold);
    if (hold == 0)
      EXPECT_EQ(found.last_step, last);
    else
      EXPECT_TRUE(found.last_step > last - 400 && found.last_step <= last) << found.last_step;
  };
  for (const auto& event : {+drive, +probe}) {
    expect(latency(0, event), 2, 0, 15);
    expect(latency(kRamp, event), 2, 3, kRest);
  }
  expect(latency(0, +limit), kToStep + 2, 0, kToStep + 6);
  expect(latency(kRamp, +limit), kToStep + 2, kToStep + 3, kToStep + kRest);
  expect(latency(kRamp, +button), 0, 2, kRest);
}

// The ramp continues for OVERTRAVEL steps into the switch; the next step is made too, and so are those in progress.
TEST(MachineStops, ARampEndsWithItsOvertravel) {
  for (const unsigned overtravel : {0U, 1U, 7U, 40U}) {
    MovingCore moving(true);
    moving.set(reg::kStopReaction, field::kStopReactionLimit);
    moving.set(reg::overtravel(0), overtravel);
    moving.run(500);
    const std::int32_t before = moving.position();
    moving.in.roles.limit_minus = 1;
    moving.run(10'000);
    EXPECT_EQ(moving.core.stop().fault, field::kFaultLimit);
    EXPECT_EQ(moving.core.state().limits.limit_state(), 1U);
    EXPECT_TRUE(moving.core.state().stop.stopped());
    EXPECT_GE(before - moving.position(), static_cast<std::int32_t>(overtravel) + 1);
    EXPECT_LE(before - moving.position(), static_cast<std::int32_t>(overtravel) + 3);
  }
}

TEST(MachineStops, AMoveAwayFromTheSwitchGoesOn) {
  MovingCore moving(false);
  moving.in.roles.limit_minus = 1;
  const std::int32_t before = moving.position();
  moving.run(1'600);
  EXPECT_EQ(moving.core.stop().fault, 0U);
  EXPECT_EQ(moving.position() - before, 100);
}

TEST(MachineStops, ClearingMovesNothingAndALastingDriveFaultStays) {
  MovingCore moving;
  moving.in.roles.drive_fault = 2;
  moving.run(10'000);
  const std::int32_t at = moving.position();
  moving.clear_faults();
  moving.run(5);
  EXPECT_EQ(moving.core.stop().fault, field::kFaultDriveFault);
  EXPECT_EQ(moving.core.state().limits.limit_state(), 2U << field::kLimitStateDriveFaultShift);
  moving.in.roles.drive_fault = 0;
  moving.run(5);
  moving.clear_faults();
  moving.run(5'000);
  EXPECT_EQ(moving.core.stop().fault, 0U);
  EXPECT_EQ(moving.position(), at);
}

TEST(MachineStops, ButtonAndHoldMustBothBeFree) {
  MovingCore moving;
  const auto moves = [&moving] {
    moving.run(6'000);
    const std::int32_t at = moving.position();
    moving.run(1'000);
    return moving.position() != at;
  };
  const auto press_cycle_start = [&moving] {
    moving.in.roles.cycle_start = true;
    moving.clock();
    moving.in.roles.cycle_start = false;
  };
  EXPECT_TRUE(moves());
  moving.in.roles.feed_hold = true;
  moving.clock();
  moving.in.roles.feed_hold = false;
  EXPECT_FALSE(moves());
  moving.set(reg::kHold, 1);
  press_cycle_start();
  EXPECT_FALSE(moves()) << "cycle start releases what the button held, not HOLD";
  moving.in.roles.feed_hold = true;
  moving.clock();
  moving.in.roles.feed_hold = false;
  moving.set(reg::kHold, 0);
  EXPECT_FALSE(moves()) << "HOLD releases nothing that the button held";
  press_cycle_start();
  EXPECT_TRUE(moves());
  EXPECT_EQ(moving.core.stop().fault, 0U);
}

}  // namespace
}  // namespace trammel::model
