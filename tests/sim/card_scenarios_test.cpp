// The card over its bus, on both engines: programs that must work, and accesses that must be refused. The RTL engine
// also compares RTL and golden model in every cycle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "host.hpp"
#include "steps.hpp"

namespace {

using namespace trammel;
using test::feed;
using test::Host;
using test::line;
using testing::ElementsAre;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint64_t kLong = 10'000'000;

bool same(const std::vector<driver::PinStep>& a, const std::vector<driver::PinStep>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const driver::PinStep& x, const driver::PinStep& y) {
    return x.cycle == y.cycle && x.axis == y.axis && x.direction == y.direction;
  });
}
bool same(const std::vector<driver::PathStep>& a, const std::vector<driver::PathStep>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const driver::PathStep& x, const driver::PathStep& y) {
    return x.command == y.command && x.tick == y.tick && x.axis == y.axis && x.direction == y.direction;
  });
}

std::unique_ptr<sim::Engine> make(sim::EngineKind kind) {
  sim::SimulationOptions options;
  options.kind = kind;
  options.clock_hz = 10'000'000;
  return sim::make_engine(options);
}

class CardScenario : public testing::TestWithParam<sim::EngineKind> {
 protected:
  CardScenario() : card(make(GetParam())), host(*card) { card->set_sink(&steps); }

  void finish() { ASSERT_TRUE(host.wait_idle(kLong)) << "FAULT " << card->read(reg::kFault); }
  std::uint32_t reason() { return card->read(reg::kRefusal) & field::kRefusalReason; }

  std::unique_ptr<sim::Engine> card;
  Host host;
  test::Steps steps;
};

INSTANTIATE_TEST_SUITE_P(Engines, CardScenario, testing::Values(sim::EngineKind::kRtl, sim::EngineKind::kModel),
                         [](const auto& engine) { return engine.param == sim::EngineKind::kRtl ? "Rtl" : "Model"; });

TEST_P(CardScenario, SaysWhatItIs) {
  EXPECT_EQ(card->read(reg::kMagic), card_map::kMagicValue);
  EXPECT_EQ(card->read(reg::kMapVersion), card_map::kMapVersionValue);
  EXPECT_EQ(card->read(reg::kAxes), 4U);
  EXPECT_EQ(card->read(reg::kClockHz), 10'000'000U);
  EXPECT_EQ(card->read(reg::kGeometryRoom), card->read(reg::kGeometryDepth));
  EXPECT_EQ(card->read(reg::kFeedRoom), card->read(reg::kFeedDepth));
}

// Zeng, Zhang & Huang: Lines 1 to 8, v = 5000 lines per second at 10 MHz, so 2000 clocks per line.
TEST_P(CardScenario, MakesThePapersLinesInOneShot) {
  const int lines[][2] = {{20, 40}, {30, 10}, {30, -30}, {-30, 10}, {-30, -30}, {40, 25}, {-39, -36}, {40, 10}};
  std::int64_t x = 0;
  std::int64_t y = 0;
  for (const auto& p : lines) {
    steps.path.clear();
    for (std::uint32_t n = 0; n < 2; ++n) {
      const auto pulses = static_cast<std::uint64_t>(std::abs(p[n]));
      const std::uint64_t frequency = ((pulses << 40) + 1000) / 2000;
      card->write(reg::frequency_lo(n), static_cast<std::uint32_t>(frequency));
      card->write(reg::frequency_hi(n), static_cast<std::uint32_t>(frequency >> 32));
      card->write(reg::count(n), static_cast<std::uint32_t>(pulses));
      card->write(reg::direction(n), p[n] < 0 ? 1U : 0U);
    }
    card->write(reg::kLengthLo, 2000);
    card->write(reg::kLengthHi, 0);
    card->write(reg::kStart, 3);
    EXPECT_THROW(card->write(reg::kStart, 3), driver::RefusedError);
    EXPECT_EQ(reason(), static_cast<std::uint32_t>(card_map::Reason::Busy));
    card->write(reg::kRefusal, 1);
    finish();
    x += p[0];
    y += p[1];
    EXPECT_THAT(card->positions(), ElementsAre(x, y, 0, 0));
    ASSERT_EQ(steps.path.size(), static_cast<std::size_t>(std::abs(p[0]) + std::abs(p[1])));
    // After k clocks |p| k / 2000 pulses, rounded; a backward line is the mirror image.
    std::int64_t made[2] = {0, 0};
    for (const driver::PathStep& step : steps.path) {
      const std::int64_t pulses = std::abs(p[step.axis]);
      ++made[step.axis];
      const auto k = static_cast<std::int64_t>(step.tick);
      EXPECT_LE(std::abs(2000 * made[step.axis] - (pulses * k + 1000)), pulses);
    }
  }
}

TEST_P(CardScenario, LeavesNoGapBetweenLinesOf22Ticks) {
  for (int i = 0; i < 12; ++i) host.send(line(22, {1, 0, 0, 0}));
  host.send(driver::LineCommand{22 * 2, 15, {1 << 30, 1 << 30, 1 << 30, 0}});
  driver::FeedCommand full = feed(22 * 14, 1);
  full.rate = ~std::uint64_t{0};
  host.send(full);
  host.send(driver::EndCommand{});
  finish();
  ASSERT_EQ(steps.pins.size(), 12U);
  for (std::size_t i = 1; i < steps.pins.size(); ++i) EXPECT_EQ(steps.pins[i].cycle - steps.pins[i - 1].cycle, 22U);
  for (const driver::PathStep& step : steps.path) EXPECT_EQ(step.tick, 11U);
  EXPECT_EQ(host.status(), field::kStatusEnded);
}

TEST_P(CardScenario, EndsArcsOnTheirEndPoint) {
  driver::ArcGeometry arc;
  arc.centre_x = -25 * driver::kCentreUnitsPerPulse;
  arc.end_x = -25;
  arc.end_y = 25;
  arc.sweep = 1.5707963267948966;
  arc.axis_x = 2;
  arc.axis_y = 1;
  const driver::ArcCommand command = driver::make_arc(arc, 1000);
  host.send(command);
  host.send(line(100, {5, 0, 0, -7}));
  host.send(feed(1100, 12));
  host.send(driver::EndCommand{});
  finish();
  EXPECT_THAT(card->positions(), ElementsAre(5, 25, -25, -7));
  EXPECT_EQ(steps.path.size(), command.path_ticks + 12);
  EXPECT_EQ(steps.path[command.path_ticks - 1].tick, command.path_ticks);
  EXPECT_EQ(steps.path.back().command, 1U);
}

TEST_P(CardScenario, HoldAndOtherRatioLeaveThePathAsItIs) {
  std::vector<driver::PathStep> straight;
  for (const bool disturbed : {false, true}) {
    steps.path.clear();
    for (int i = 0; i < 6; ++i) host.send(line(150, {40 - 13 * i, 9 * i - 20, i, -i}));
    host.send(feed(900, 9));
    host.send(driver::EndCommand{});
    if (disturbed) {
      card->write(reg::kSlew, 0x20'0000);
      card->write(reg::kRatioFeed, 0x9000);
      card->wait(700);
      card->write(reg::kHold, 1);
      card->wait(3000);
      EXPECT_NE(host.status() & field::kStatusHeld, 0U);
      const auto before = card->positions();
      card->wait(5000);
      EXPECT_EQ(card->positions(), before);
      card->write(reg::kHold, 0);
    }
    finish();
    host.abort();
    if (!disturbed) straight = steps.path;
  }
  ASSERT_FALSE(straight.empty());
  EXPECT_TRUE(same(straight, steps.path));
}

TEST_P(CardScenario, DwellsInRealTime) {
  card->write(reg::kRatioFeed, 0x4000);
  std::uint64_t gaps[2];
  for (const std::uint64_t clocks : {0U, 5000U}) {
    steps.pins.clear();
    host.send(line(40, {1}));
    host.send(feed(40, 30));
    host.send(driver::DwellCommand{clocks});
    host.send(line(40, {1}));
    host.send(feed(40, 30));
    finish();
    ASSERT_EQ(steps.pins.size(), 2U);
    gaps[clocks == 0 ? 0 : 1] = steps.pins[1].cycle - steps.pins[0].cycle;
  }
  // A dwell of 0 clocks lasts one. The phase of the time base moves the second step by less than its period.
  EXPECT_NEAR(static_cast<double>(gaps[1] - gaps[0]), 4999, 4);
}

TEST_P(CardScenario, StopsWhereTicksDoNotFit) {
  host.send(line(100, {50}));
  host.send(feed(60, 20));
  host.send(driver::EndCommand{});
  card->wait(5000);
  EXPECT_EQ(card->read(reg::kFault), field::kFaultTickMismatch);
  const auto stopped = card->positions();
  card->write(reg::kFault, field::kFaultTickMismatch);
  card->wait(2000);
  EXPECT_EQ(card->positions(), stopped);
  EXPECT_EQ(card->read(reg::kFault), 0U);
  host.abort();
  host.send(line(10, {1}));
  host.send(feed(10, 20));
  finish();
  EXPECT_EQ(card->positions()[0], stopped[0] + 1);
}

TEST_P(CardScenario, StopsAtAnArcThatMissesItsEnd) {
  driver::ArcGeometry arc;
  arc.centre_x = -10 * driver::kCentreUnitsPerPulse;
  arc.sweep = 6.283185307179586;
  driver::ArcCommand command = driver::make_arc(arc, 400);
  command.prescale /= 2;
  host.send(command);
  host.send(line(50, {10}));
  host.send(feed(450, 10));
  card->wait(9000);
  EXPECT_EQ(card->read(reg::kFault), field::kFaultPathIncomplete);
  EXPECT_EQ(steps.path.size(), command.path_ticks / 2);
  EXPECT_THROW(card->write(reg::kStart, 1), driver::RefusedError);
}

TEST_P(CardScenario, RefusesWholeCommands) {
  const std::uint32_t room = card->read(reg::kGeometryRoom);
  EXPECT_THROW(card->write(reg::kMagic, 1), driver::RefusedError);
  EXPECT_EQ(reason(), static_cast<std::uint32_t>(card_map::Reason::ReadOnly));
  card->write(reg::kRefusal, 1);
  EXPECT_THROW(
      {
        card->write(reg::kStream, 0x0003'0099);
        card->write(reg::kStream, 0);
      },
      driver::RefusedError);
  EXPECT_EQ(reason(), static_cast<std::uint32_t>(card_map::Reason::UnknownOpcode));
  host.abort();
  card->write(reg::kRefusal, 1);
  std::vector<std::uint32_t> words;
  driver::encode(line(10, {1, 2}), 0, words);
  card->write(reg::kStream, words[0]);
  card->write(reg::kStream, words[1]);
  EXPECT_NE(host.status() & field::kStatusIncomplete, 0U);
  card->write(reg::kControl, field::kControlFlush);
  card->wait(20);
  EXPECT_EQ(reason(), static_cast<std::uint32_t>(card_map::Reason::Truncated));
  EXPECT_EQ(card->read(reg::kGeometryRoom), room);
  EXPECT_TRUE(steps.path.empty());
}

TEST(Engines, MakeTheSameStepsInTheSameCycles) {
  test::Steps steps[2];
  std::uint64_t cycles[2];
  for (const sim::EngineKind kind : {sim::EngineKind::kRtl, sim::EngineKind::kModel}) {
    const auto index = static_cast<std::size_t>(kind == sim::EngineKind::kModel);
    const auto card = make(kind);
    card->set_sink(&steps[index]);
    Host host(*card);
    std::mt19937_64 engine(11);
    host.set_times(4, 2, 1, 3, 1);
    for (int i = 0; i < 12; ++i) {
      test::random_section(
          host, [&engine](std::uint64_t count) { return engine() % count; }, 4);
    }
    cycles[index] = card->cycles();
  }
  EXPECT_EQ(cycles[0], cycles[1]);
  ASSERT_GT(steps[0].pins.size(), 500U);
  EXPECT_TRUE(same(steps[0].pins, steps[1].pins));
  EXPECT_TRUE(same(steps[0].path, steps[1].path));
}

}  // namespace
