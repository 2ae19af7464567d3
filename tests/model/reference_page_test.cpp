// What docs/reference/behaviour.md says, tried on the golden model of the whole card over its bus alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/model/card_model.hpp"

namespace {

using namespace trammel;
using card_map::Area;
using card_map::Reason;
using model::CardModel;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::int64_t kOnePulse = std::int64_t{1} << 40;

struct PathStep {
  std::uint64_t tick;
  unsigned axis;
  int direction;
};

class Host : public model::CardSteps {
 public:
  explicit Host(unsigned axes = 4) : card(config_of(axes)) { card.set_steps(this); }

  static CardModel::Config config_of(unsigned axes) {
    CardModel::Config config;
    config.axes = axes;
    return config;
  }

  void pin_step(std::uint64_t cycle, unsigned axis, int direction) override {
    pins.push_back({cycle, axis, direction});
  }
  void path_step(std::uint64_t, std::uint64_t tick, unsigned axis, int direction) override {
    path.push_back({tick, axis, direction});
  }

  bool write(std::uint32_t address, std::uint32_t value, std::uint8_t strobes = 0xF) {
    CardModel::Inputs in;
    in.awvalid = in.wvalid = true;
    in.awaddr = address;
    in.wdata = value;
    in.wstrb = strobes;
    while (!card.bus().awready) card.clock(in);
    card.clock(in);
    in = CardModel::Inputs{};
    in.bready = true;
    while (!card.bus().bvalid) card.clock(in);
    const bool good = card.bus().bresp == 0;
    card.clock(in);
    return good;
  }
  std::uint32_t read(std::uint32_t address) {
    CardModel::Inputs in;
    in.arvalid = true;
    in.araddr = address;
    while (!card.bus().arready) card.clock(in);
    card.clock(in);
    in = CardModel::Inputs{};
    in.rready = true;
    while (!card.bus().rvalid) card.clock(in);
    const std::uint32_t value = card.bus().rdata;
    card.clock(in);
    return value;
  }
  bool send(const driver::Command& command) { return send_as(command, number++); }
  bool send_as(const driver::Command& command, std::uint8_t as) {
    std::vector<std::uint32_t> words;
    driver::encode(command, as, words);
    bool good = true;
    for (const std::uint32_t word : words) good = write(reg::kStream, word) && good;
    return good;
  }
  std::uint32_t refusal() {
    const std::uint32_t value = read(reg::kRefusal);
    write(reg::kRefusal, 1);
    return value;
  }
  Reason reason() { return static_cast<Reason>(refusal() & field::kRefusalReason); }
  void clocks(std::uint64_t count) {
    for (; count != 0; --count) card.clock({});
  }
  void idle(std::uint64_t most = 100000) {
    clocks(20);
    while ((read(reg::kStatus) & field::kStatusBusy) != 0 && most-- > 0) clocks(8);
    EXPECT_EQ(read(reg::kStatus) & field::kStatusBusy, 0U);
  }
  std::int32_t position(unsigned axis) { return static_cast<std::int32_t>(card.position(axis)); }

  // A one-shot move of axis 0 (and 1 as its mirror image).
  void direct(std::uint64_t frequency, std::uint32_t count, std::uint64_t length) {
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
      write(reg::frequency_lo(axis), static_cast<std::uint32_t>(frequency));
      write(reg::frequency_hi(axis), static_cast<std::uint32_t>(frequency >> 32));
      write(reg::count(axis), count);
      write(reg::direction(axis), axis);
    }
    write(reg::kLengthLo, static_cast<std::uint32_t>(length));
    write(reg::kLengthHi, static_cast<std::uint32_t>(length >> 32));
  }

  CardModel card;
  std::vector<PathStep> pins;  // `tick` is the clock
  std::vector<PathStep> path;
  std::uint8_t number = 0;
};

driver::LineCommand line(std::uint64_t ticks, std::int64_t increment) {
  driver::LineCommand result;
  result.ticks = ticks;
  result.mask = 1;
  result.increment[0] = increment;
  return result;
}

driver::FeedCommand feed(std::uint64_t ticks, unsigned clocks_a_tick = 1) {
  driver::FeedCommand result;
  result.ticks = ticks;
  result.rate = clocks_a_tick == 1 ? ~std::uint64_t{0} : (std::uint64_t{1} << 63) / clocks_a_tick * 2;
  return result;
}

constexpr std::uint32_t refusal_of(Reason reason, std::uint32_t number, std::uint32_t address) {
  return static_cast<std::uint32_t>(reason) | number << 8 | address << 16;
}

// A path without its end: 10 ticks of line against 11 of feed at a barrier.
void make_fault(Host& host) {
  host.write(reg::kControl, field::kControlAbort);
  host.number = 0;
  host.send(line(10, 0));
  host.send(feed(11));
  host.send(driver::EndCommand{});
  host.clocks(200);
  ASSERT_EQ(host.read(reg::kFault), field::kFaultTickMismatch);
}

TEST(ReferencePage, AddressesBetweenWordsAreUnknown) {
  Host host;
  for (std::uint32_t offset = 1; offset < 4; ++offset) {
    EXPECT_EQ(host.read(reg::kMagic + offset), 0U);
    EXPECT_EQ(host.refusal(), refusal_of(Reason::UnknownAddress, 0, reg::kMagic + offset));
    EXPECT_FALSE(host.write(reg::kHold + offset, 1));
    EXPECT_EQ(host.refusal(), refusal_of(Reason::UnknownAddress, 0, reg::kHold + offset));
  }
}

TEST(ReferencePage, RefusalsOfTheStream) {
  Host host;
  EXPECT_TRUE(host.send(driver::DwellCommand{1}));
  // The third word of command 1 is wrong: bits 47:40 of the count.
  EXPECT_TRUE(host.write(reg::kStream, 0x01030020));
  EXPECT_TRUE(host.write(reg::kStream, 0x00000000));
  EXPECT_FALSE(host.write(reg::kStream, 0x00000100));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::BadField, 1, reg::kStream));
  EXPECT_FALSE(host.write(reg::kStream, 0x05030020));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::StreamClosed, 1, reg::kStream)) << "the number stays";
  host.write(reg::kControl, field::kControlAbort);
  EXPECT_TRUE(host.write(reg::kStream, 0x00030020));
  EXPECT_TRUE(host.write(reg::kControl, field::kControlFlush)) << "the write itself is not refused";
  EXPECT_EQ(host.refusal(), refusal_of(Reason::Truncated, 0, reg::kControl));
  EXPECT_FALSE(host.write(reg::kStream, 0x00030020));
  EXPECT_EQ(host.reason(), Reason::StreamClosed) << "a flush inside a command closes the stream";
  host.write(reg::kControl, field::kControlAbort);
  EXPECT_TRUE(host.write(reg::kControl, field::kControlFlush));
  EXPECT_EQ(host.refusal(), 0U) << "nothing to flush";
  EXPECT_TRUE(host.write(reg::kStream, 0x00030020));
  EXPECT_TRUE(host.write(reg::kControl, field::kControlFlush | field::kControlAbort));
  EXPECT_EQ(host.refusal(), 0U) << "the abort wins";
  // Padding: a line of one axis has 8 halfwords, a DWELL 5 and one to fill.
  EXPECT_TRUE(host.write(reg::kStream, 0x00030020));
  EXPECT_TRUE(host.write(reg::kStream, 0));
  EXPECT_FALSE(host.write(reg::kStream, 0x00010000));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::BadField, 0, reg::kStream));
}

TEST(ReferencePage, StartsChecksInOrder) {
  Host host;
  host.direct(1, 1, 0);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::BadValue, 0, reg::kStart)) << "LENGTH 0";
  host.direct(kOnePulse + 1, 1, 100);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::BadValue) << "more than a pulse a clock";
  host.direct(0, 1, 100);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::BadValue) << "no frequency for a pulse";
  host.direct(0, 0, 5000);
  EXPECT_TRUE(host.write(reg::kStart, 1)) << "an axis may stand";
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::Busy);
  EXPECT_FALSE(host.write(reg::kStart, 0x10));
  EXPECT_EQ(host.reason(), Reason::BadValue) << "an absent axis, busy or not";
  EXPECT_FALSE(host.write(reg::kStream, 0));
  EXPECT_EQ(host.reason(), Reason::Busy);
  host.write(reg::kControl, field::kControlAbort);
  make_fault(host);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::Faulted);
  EXPECT_FALSE(host.write(reg::kStart, 0));
  EXPECT_EQ(host.reason(), Reason::BadValue);
}

TEST(ReferencePage, SettingsStayWritableInDirectMode) {
  Host host;
  host.direct(0, 0, 50000);
  EXPECT_TRUE(host.write(reg::kStart, 1));
  for (const card_map::Register& entry : card_map::kRegisters) {
    const bool there = card_map::has_engine(host.read(reg::kEngines), entry.engine);
    if (entry.access != card_map::Access::Setting || !there) continue;
    EXPECT_TRUE(host.write(entry.address, host.read(entry.address))) << entry.name;
  }
  EXPECT_NE(host.read(reg::kStatus) & field::kStatusDirect, 0U);
  // The next move's values may be written: this one has its own.
  host.direct(kOnePulse / 100, 3, 1000);
  host.idle();
  EXPECT_EQ(host.position(0), 0);
  EXPECT_TRUE(host.write(reg::kStart, 1));
  host.idle();
  EXPECT_EQ(host.position(0), 3);
}

// LENGTH and COUNT that disagree: never more than COUNT, never less; the move takes the longer of the two.
TEST(ReferencePage, LengthAndCountThatDisagree) {
  const auto run = [](std::uint32_t count, std::uint64_t length) {
    Host host;
    host.direct(kOnePulse / 100, count, length);
    host.write(reg::kHoldLimit, 0xFFFF);
    const std::uint64_t begin = host.card.cycles();
    EXPECT_TRUE(host.write(reg::kStart, 3));
    host.idle();
    EXPECT_EQ(host.position(0), static_cast<std::int32_t>(count));
    EXPECT_EQ(host.position(1), -static_cast<std::int32_t>(count));
    const std::uint64_t last = host.pins.empty() ? begin : host.pins.back().tick;
    return std::make_pair(last - begin, host.card.cycles() - begin);
  };
  // A pulse in 100 clocks: 1000 clocks have 10.
  const auto [agree_last, agree_end] = run(10, 1000);
  EXPECT_LT(agree_last, 1100U);
  const auto [few_last, few_end] = run(4, 1000);
  EXPECT_LT(few_last, 500U) << "the axis stops at its count";
  EXPECT_GE(few_end, 1000U) << "and the move goes on";
  const auto [many_last, many_end] = run(30, 1000);
  EXPECT_GT(many_last, 2900U) << "at the same frequency until the count is made";
  EXPECT_LT(many_end, 3300U);
  EXPECT_LT(agree_end, 1300U);
}

// Ties: half a pulse a tick puts every second tick exactly between two pulses.
TEST(ReferencePage, TiesOfLinesAndOfDirectMoves) {
  const auto ticks_of = [](std::int64_t increment) {
    Host host;
    host.send(line(8, increment));
    host.send(feed(8, 40));
    host.send(driver::EndCommand{});
    host.idle();
    std::vector<std::uint64_t> ticks;
    for (const PathStep& step : host.path) ticks.push_back(step.tick);
    return ticks;
  };
  // x_k = floor(1/2 + k / 2): steps up at the tie, steps down a tick after it.
  EXPECT_EQ(ticks_of(kOnePulse / 2), (std::vector<std::uint64_t>{1, 3, 5, 7}));
  EXPECT_EQ(ticks_of(-kOnePulse / 2), (std::vector<std::uint64_t>{2, 4, 6, 8}));
  Host host;
  host.direct(kOnePulse / 2, 4, 8);
  EXPECT_TRUE(host.write(reg::kStart, 3));
  host.idle();
  ASSERT_EQ(host.path.size(), 8U);
  for (std::size_t i = 0; i < 8; i += 2) {
    EXPECT_EQ(host.path[i].tick, host.path[i + 1].tick) << "an axis and its mirror image step together";
    EXPECT_EQ(host.path[i].direction, -host.path[i + 1].direction);
  }
}

// The page's rule, in its own words, on plain integers.
struct Walk {
  std::int64_t f, gx, gy, hx, hy, left_x, left_y;
  int q;
  bool clockwise;
  bool straight = false;

  bool at_end() const { return q == 0 && left_x == 0 && left_y == 0; }
  std::pair<int, int> step() {
    const int turn = clockwise ? -1 : 1;
    const int sx = gy >= 0 ? -turn : turn;
    const int sy = gx >= 0 ? turn : -turn;
    if (q == 0 && (sx * left_x <= 0 || sy * left_y <= 0)) straight = true;
    std::pair<int, int> s{0, 0};
    if (straight) {
      if (left_x != 0)
        s.first = left_x > 0 ? 1 : -1;
      else
        s.second = left_y > 0 ? 1 : -1;
    } else {
      const bool x_to_zero = sx != (gx >= 0 ? 1 : -1);
      if (x_to_zero == (f >= 0))
        s.first = sx;
      else
        s.second = sy;
    }
    const bool x_sign = gx >= 0;
    const bool y_sign = gy >= 0;
    f += s.first * gx + s.second * gy + (s.first != 0 ? hx : hy);
    gx += 2 * s.first * hx;
    gy += 2 * s.second * hy;
    left_x -= s.first;
    left_y -= s.second;
    if (((gx >= 0) != x_sign || (gy >= 0) != y_sign) && q > 0) --q;
    return s;
  }
};

driver::ArcCommand arc(std::int32_t x, std::int32_t y, std::int32_t end_x, std::int32_t end_y, std::int64_t square,
                       unsigned q, bool clockwise, std::uint64_t path_ticks) {
  driver::ArcCommand result;
  result.clockwise = clockwise;
  result.quadrants = static_cast<std::uint16_t>(q);
  result.end_x = end_x - x;
  result.end_y = end_y - y;
  result.deviation = std::int64_t{x} * x + std::int64_t{y} * y - square;
  result.gradient_x = 2 * x;
  result.gradient_y = 2 * y;
  result.half_x = result.half_y = 1;
  result.path_ticks = path_ticks;
  return driver::with_ticks(result, 4 * path_ticks);
}

// The steps of an arc on the card; FAULT in `fault`.
std::vector<std::pair<int, int>> steps_of(const driver::ArcCommand& command, std::uint32_t& fault) {
  Host host;
  host.send(command);
  host.send(feed(command.ticks, 8));
  host.send(driver::EndCommand{});
  host.idle();
  fault = host.read(reg::kFault);
  std::vector<std::pair<int, int>> steps;
  for (const PathStep& step : host.path) {
    steps.emplace_back(step.axis == 0 ? step.direction : 0, step.axis == 1 ? step.direction : 0);
  }
  return steps;
}

Walk walk_of(const driver::ArcCommand& a) {
  return {static_cast<std::int64_t>(a.deviation),
          static_cast<std::int64_t>(a.gradient_x),
          static_cast<std::int64_t>(a.gradient_y),
          static_cast<std::int64_t>(a.half_x),
          static_cast<std::int64_t>(a.half_y),
          a.end_x,
          a.end_y,
          a.quadrants,
          a.clockwise};
}

// Integer radii put F = 0, the tie, on the way.
TEST(ReferencePage, TheArcRuleStepForStep) {
  for (const bool clockwise : {false, true}) {
    for (const int radius : {5, 13, 25}) {
      const unsigned steps = 8 * static_cast<unsigned>(radius);
      const driver::ArcCommand full = arc(radius, 0, radius, 0, radius * radius, 4, clockwise, steps);
      std::uint32_t fault = 0;
      const auto made = steps_of(full, fault);
      EXPECT_EQ(fault, 0U);
      ASSERT_EQ(made.size(), steps);
      Walk walk = walk_of(full);
      bool ties = false;
      for (const auto& step : made) {
        ties = ties || walk.f == 0;
        EXPECT_EQ(step, walk.step());
      }
      EXPECT_TRUE(walk.at_end());
      EXPECT_TRUE(ties);
    }
  }
}

TEST(ReferencePage, WhatWrongNumbersOfAnArcDo) {
  // A quarter of R = 25, counter-clockwise from (25, 0) to (0, 25): 50 steps and no change of sign, as zero is
  // positive.
  std::uint32_t fault = 0;
  const driver::ArcCommand good = arc(25, 0, 0, 25, 625, 0, false, 50);
  EXPECT_EQ(steps_of(good, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  // path_ticks is only compared with the count; the prescaler decides how many there are.
  driver::ArcCommand other = good;
  other.path_ticks = 1;
  EXPECT_EQ(steps_of(other, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  // Too many path ticks: those at the end make no step. Too few: PATH_INCOMPLETE.
  other.prescale = good.prescale * 2;
  EXPECT_EQ(steps_of(other, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  other.prescale = good.prescale / 2;
  EXPECT_EQ(steps_of(other, fault).size(), 25U);
  EXPECT_EQ(fault, field::kFaultPathIncomplete);
  // Q too large: it goes on round; too small: straight to the end as soon as one coordinate has reached the end's.
  other = good;
  other.quadrants = 1;
  steps_of(other, fault);
  EXPECT_EQ(fault, field::kFaultPathIncomplete);
  // On to (-25, 0): x changes its sign, y ends at zero, which is positive.
  const driver::ArcCommand half = arc(25, 0, -25, 0, 625, 1, false, 100);
  EXPECT_EQ(steps_of(half, fault).size(), 100U);
  EXPECT_EQ(fault, 0U);
  other = half;
  other.quadrants = 0;
  const auto straight = steps_of(other, fault);
  EXPECT_EQ(fault, 0U);
  EXPECT_EQ(straight.size(), 50U);
  for (const auto& step : straight) EXPECT_EQ(step, (std::pair<int, int>{-1, 0}));
}

// Clocks without a tick at a barrier, at a tick a clock: two lines of 4 ticks with a step at the second one each would
// have their steps 4 clocks apart.
TEST(ReferencePage, ABarrierOfNClocksStopsTheTicksForOverheadAndMaxOneN) {
  const auto gap = [](const driver::Command& barrier, unsigned axes) {
    Host host(8);
    host.write(reg::kHold, 1);
    host.clocks(20);
    driver::LineCommand next = line(4, kOnePulse / 4);
    next.mask = static_cast<std::uint8_t>((1U << axes) - 1);
    host.send(line(4, kOnePulse / 4));
    host.send(feed(4));
    host.send(barrier);
    host.send(next);
    host.send(feed(4));
    host.write(reg::kHold, 0);
    host.clocks(3000);
    EXPECT_EQ(host.pins.size(), 2U);
    return host.pins[1].tick - host.pins[0].tick - 4;
  };
  for (unsigned axes = 1; axes <= 8; ++axes) {
    const std::uint64_t overhead = std::max(38U, 22 + 3 * axes);
    EXPECT_EQ(gap(driver::DwellCommand{0}, axes), overhead + 1) << axes;
    EXPECT_EQ(gap(driver::DwellCommand{1}, axes), overhead + 1);
    EXPECT_EQ(gap(driver::DwellCommand{2}, axes), overhead + 2);
    EXPECT_EQ(gap(driver::DwellCommand{1000}, axes), overhead + 1000);
    EXPECT_EQ(gap(driver::EndCommand{}, axes), overhead + 1);
  }
}

TEST(ReferencePage, RecoveryInWhicheverOrder) {
  for (int order = 0; order < 3; ++order) {
    Host host;
    make_fault(host);
    EXPECT_EQ(host.read(reg::kStatus) & (field::kStatusBusy | field::kStatusFaulted), field::kStatusFaulted);
    EXPECT_EQ(host.read(reg::kGeometryRoom), 4096U);
    EXPECT_EQ(host.read(reg::kGeometryBegun), 0U);
    EXPECT_EQ(host.read(reg::fault(Area::Stop)), field::kFaultTickMismatch);
    EXPECT_EQ(host.read(reg::geometry_begun(Area::Stop)), 1U) << "what had begun when it stopped";
    EXPECT_FALSE(host.write(reg::kStream, 0x00030020));
    EXPECT_EQ(host.refusal(), refusal_of(Reason::Faulted, 0, reg::kStream));
    if (order == 0) host.write(reg::kControl, field::kControlAbort);
    host.write(reg::kFault, 0xFFFF);
    if (order == 1) host.write(reg::kControl, field::kControlAbort);
    const std::size_t steps = host.pins.size();
    host.clocks(5000);
    EXPECT_EQ(host.pins.size(), steps) << "clearing starts nothing";
    EXPECT_EQ(host.read(reg::kStatus), 0U);
    host.number = 0;
    EXPECT_TRUE(host.send(line(10, kOnePulse / 10)));
    EXPECT_TRUE(host.send(feed(10)));
    EXPECT_TRUE(host.send(driver::EndCommand{}));
    host.idle();
    EXPECT_EQ(host.read(reg::kStatus), field::kStatusEnded);
    EXPECT_EQ(host.position(0), 1);
  }
}

// Pins of the modes, as axis 0 steps three pulses up and three down.
TEST(ReferencePage, WhichPinIsWhich) {
  const auto pins = [](std::uint32_t mode) {
    Host host;
    host.write(reg::mode(0), mode);
    host.write(reg::step_length(0), 4);
    host.clocks(5);
    host.send(line(3, kOnePulse));
    host.send(line(3, -kOnePulse));
    host.send(feed(6, 100));
    host.send(driver::EndCommand{});
    std::vector<unsigned> seen;
    for (int clock = 0; clock < 2000; ++clock) {
      host.card.clock({});
      const auto& out = host.card.outputs();
      const unsigned now = (out.step & 1U) | (out.dir & 1U) << 1;
      if (seen.empty() || seen.back() != now) seen.push_back(now);
    }
    return seen;
  };
  using Seen = std::vector<unsigned>;  // bit 0 first pin, bit 1 second
  EXPECT_EQ(pins(0), (Seen{0, 1, 0, 1, 0, 1, 0, 2, 3, 2, 3, 2, 3, 2})) << "STEP, and DIR high for negative";
  EXPECT_EQ(pins(1), (Seen{0, 1, 0, 1, 0, 1, 0, 2, 0, 2, 0, 2, 0})) << "first pin up, second down";
  EXPECT_EQ(pins(2), (Seen{0, 1, 3, 2, 3, 1, 0})) << "the first pin leads going up";
  EXPECT_EQ(pins(field::kModeInvertFirst), (Seen{1, 0, 1, 0, 1, 0, 1, 3, 2, 3, 2, 3, 2, 3}));
}

TEST(ReferencePage, TheShapersReversal) {
  Host host;
  host.write(reg::step_length(0), 5);
  host.write(reg::step_space(0), 3);
  host.write(reg::dir_setup(0), 7);
  host.write(reg::dir_hold(0), 9);
  host.write(reg::kHold, 1);
  host.clocks(20);
  host.send(line(1, kOnePulse));
  host.send(line(1, -kOnePulse));
  host.send(feed(2));
  host.send(driver::EndCommand{});
  host.write(reg::kHold, 0);
  host.idle();
  ASSERT_EQ(host.pins.size(), 2U);
  EXPECT_EQ(host.pins[1].tick - host.pins[0].tick, 5U + 3 + 9 + 7 + 12);
}

TEST(ReferencePage, AnswerTimeOfStart) {
  for (unsigned mask = 1; mask < 16; ++mask) {
    Host host;
    host.direct(0, 0, 1);
    host.clocks(300);
    // Against a write that takes 4 clocks at the inner port.
    const std::uint64_t begin = host.card.cycles();
    EXPECT_TRUE(host.write(reg::kStart, mask));
    const std::uint64_t start = host.card.cycles() - begin;
    host.idle();
    const std::uint64_t again = host.card.cycles();
    EXPECT_TRUE(host.write(reg::kHold, 0));
    const std::uint64_t plain = host.card.cycles() - again;
    EXPECT_EQ(start - plain, 38U + 16 * card_map::axes_in(static_cast<std::uint8_t>(mask)) - 4) << mask;
  }
}

TEST(ReferencePage, TheShapersShortestPeriod) {
  for (const std::uint32_t length : {0U, 1U, 5U}) {
    for (const std::uint32_t space : {0U, 1U, 9U}) {
      Host host;
      host.write(reg::step_length(0), length);
      host.write(reg::step_space(0), space);
      host.write(reg::kHold, 1);
      host.clocks(20);
      host.send(line(4, kOnePulse));
      host.send(feed(4));
      host.send(driver::EndCommand{});
      host.write(reg::kHold, 0);
      host.idle();
      ASSERT_EQ(host.pins.size(), 4U);
      const std::uint64_t period = std::max(1U, length) + space + 6 - (length == 0 ? 1 : 0);
      for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(host.pins[i].tick - host.pins[i - 1].tick, period) << length;
    }
  }
}

}  // namespace
