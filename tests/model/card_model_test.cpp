// CardModel::run() against clock(): the same programs run on two cards, one of which jumps from tick to tick.
#include "trammel/model/card_model.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core_bench.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/skip/card.hpp"

namespace {

using namespace trammel;
using model::CardModel;
namespace reg = card_map::reg;

// A card with a host; `skips` selects how it spends idle time.
class Card {
 public:
  explicit Card(bool skips, const CardModel::Config& config = {}) : skips_(skips), model_(config) {
    model_.set_steps(&steps);
  }

  void write(std::uint32_t address, std::uint32_t value) {
    CardModel::Inputs in;
    in.awvalid = in.wvalid = true;
    in.awaddr = address;
    in.wdata = value;
    in.wstrb = 0xF;
    while (!model_.bus().awready) model_.clock(in);
    model_.clock(in);
    in = CardModel::Inputs{};
    while (!model_.bus().bvalid) model_.clock(in);
    ASSERT_EQ(model_.bus().bresp, 0) << "write to " << address;
    in.bready = true;
    model_.clock(in);
  }
  void send(const driver::Command& command) {
    std::vector<std::uint32_t> words;
    driver::encode(command, number_++, words);
    for (const std::uint32_t word : words) write(reg::kStream, word);
  }
  void wait(std::uint64_t clocks) {
    if (skips_) {
      skip::run(model_, clocks);
    } else {
      for (; clocks != 0; --clocks) model_.clock(CardModel::Inputs{});
    }
  }
  const CardModel& model() const { return model_; }
  trammel::testing::StepRecorder steps;

 private:
  bool skips_;
  CardModel model_;
  std::uint8_t number_ = 0;
};

class Pair {
 public:
  template <class Action>
  void both(Action action) {
    action(clocked);
    action(skipping);
    compare();
  }
  void compare() const {
    ASSERT_EQ(clocked.model().cycles(), skipping.model().cycles());
    ASSERT_TRUE(clocked.model().outputs() == skipping.model().outputs()) << "cycle " << clocked.model().cycles();
    for (unsigned n = 0; n < clocked.model().axes(); ++n) {
      ASSERT_EQ(clocked.model().position(n), skipping.model().position(n)) << "cycle " << clocked.model().cycles();
    }
    ASSERT_EQ(clocked.steps.pins, skipping.steps.pins);
    ASSERT_EQ(clocked.steps.path, skipping.steps.path);
  }
  Card clocked{false};
  Card skipping{true};
};

driver::LineCommand line(std::uint64_t ticks, std::int64_t pulses_x, std::int64_t pulses_y) {
  driver::LineCommand result;
  result.ticks = ticks;
  result.mask = 3;
  const auto n = static_cast<std::int64_t>(ticks);
  constexpr std::int64_t kOnePulse = std::int64_t{1} << 40;
  result.increment[0] = pulses_x * kOnePulse / n;
  result.increment[1] = pulses_y * kOnePulse / n;
  return result;
}

// Waits of many lengths, so that the jumps end at all kinds of clocks.
void wait_in_pieces(Pair& pair, std::mt19937_64& random, std::uint64_t clocks) {
  while (clocks != 0) {
    const std::uint64_t piece = std::min<std::uint64_t>(clocks, 1 + random() % (random() % 4 == 0 ? 4000 : 90));
    pair.both([piece](Card& card) { card.wait(piece); });
    if (::testing::Test::HasFatalFailure()) return;
    clocks -= piece;
  }
}

// Steps name the command of their path. Commands that take no time are commands of the stream, too, but the card does
// not count them as begun.
TEST(CardModelRun, StepsNameTheirCommandBehindCommandsThatTakeNoTime) {
  const driver::Command instant[] = {driver::OutputCommand{1, 0}, driver::MarkCommand{},
                                     driver::PwmCommand{0, 1000, false, 0, 0}};
  for (std::size_t i = 0; i < std::size(instant); ++i) {
    SCOPED_TRACE(i);
    CardModel::Config config;
    config.engines |= card_map::engines::kPathCommands | card_map::engines::kPwm;
    Card card(false, config);
    card.send(line(40, 4, 0));
    card.send(instant[i]);
    card.send(instant[i]);
    card.send(line(40, 4, 0));
    driver::FeedCommand piece;
    piece.ticks = 80;
    piece.rate = std::uint64_t{1} << 60;
    card.send(piece);
    card.send(driver::EndCommand{});
    card.wait(20'000);
    std::vector<std::uint64_t> commands;
    for (const auto& step : card.steps.path) commands.push_back(std::get<0>(step));
    EXPECT_EQ(commands, (std::vector<std::uint64_t>{0, 0, 0, 0, 3, 3, 3, 3}));
  }
}

TEST(CardModelRun, EqualsClockForRandomPrograms) {
  std::mt19937_64 random(7);
  for (int program = 0; program < 30; ++program) {
    Pair pair;
    SCOPED_TRACE(program);
    const auto ratio = static_cast<std::uint32_t>(random() % 2 == 0 ? 0x10000 : 0x3000 + random() % 0xD001);
    pair.both([ratio](Card& card) { card.write(reg::kRatioFeed, ratio); });
    const double pace = random() % 3 == 0 ? 20 : 60 + static_cast<double>(random() % 500);
    std::uint64_t total = 0;
    for (int path = 0; path < 4; ++path) {
      const std::uint64_t ticks = 20 + random() % 300;
      const auto span = static_cast<std::int64_t>(ticks / 10 + 1);
      const std::int64_t x = static_cast<std::int64_t>(random()) % span;
      const std::int64_t y = static_cast<std::int64_t>(random()) % span;
      driver::Command command = line(ticks, x, y);
      total += ticks;
      if (random() % 3 == 0) {
        driver::ArcGeometry arc;
        arc.centre_x = -10 * driver::kCentreUnitsPerPulse;
        arc.sweep = 6.283185307179586;
        arc.clockwise = random() % 2 == 0;
        command = driver::make_arc(arc, ticks + 80);
        total += 80;
      }
      pair.both([&command](Card& card) { card.send(command); });
    }
    for (std::uint64_t left = total; left != 0;) {
      const std::uint64_t ticks = std::min(left, 1 + random() % 400);
      driver::FeedCommand piece;
      piece.ticks = ticks;
      piece.rate = static_cast<std::uint64_t>(0x1p64 / pace);
      piece.floor = static_cast<std::uint32_t>(0x1p32 / pace / 3);
      if (random() % 2 == 0) {
        piece.acceleration = static_cast<std::int64_t>(random()) / static_cast<std::int64_t>(pace * pace * 900);
        piece.jerk = piece.acceleration / -97;
      }
      pair.both([&piece](Card& card) { card.send(piece); });
      left -= ticks;
    }
    const std::uint64_t dwell = random() % 500;
    pair.both([dwell](Card& card) { card.send(driver::DwellCommand{dwell}); });
    pair.both([](Card& card) { card.send(driver::EndCommand{}); });
    wait_in_pieces(pair, random, 3000);
    pair.both([](Card& card) { card.write(reg::kSlew, 0x8000); });
    pair.both([](Card& card) { card.write(reg::kHold, 1); });
    wait_in_pieces(pair, random, 9000);
    pair.both([](Card& card) { card.write(reg::kHold, 0); });
    for (int i = 0; i < 400 && !HasFatalFailure() && (pair.clocked.model().outputs().status & 1) != 0; ++i) {
      wait_in_pieces(pair, random, 4000);
    }
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_EQ(pair.clocked.model().outputs().status, card_map::field::kStatusEnded) << "ended, and nothing else";
    ASSERT_EQ(pair.clocked.model().outputs().fault, 0U);
    ASSERT_FALSE(pair.clocked.steps.path.empty());
  }
}

}  // namespace
