// A path that was dropped in its middle continues after a silent piece that runs while the card is held; through the
// driver's commands, on both engines.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "commands.hpp"
#include "steps.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/sim/engines.hpp"

namespace {

using namespace trammel;
namespace reg = card_map::reg;
namespace field = card_map::field;

class HeldSilence : public testing::TestWithParam<sim::EngineKind> {
 protected:
  HeldSilence() : engine(make(GetParam())) { engine->write(reg::kSlew, 1U << 20); }

  static std::unique_ptr<sim::Engine> make(sim::EngineKind kind) {
    sim::SimulationOptions options;
    options.kind = kind;
    options.clock_hz = 10'000'000;
    return sim::make_engine(options);
  }
  void send(const driver::Command& command) {
    std::array<std::uint32_t, driver::kMaxCommandWords> words{};
    const std::size_t count = driver::encode(command, number_++, words.data());
    for (std::size_t i = 0; i < count; ++i) engine->write(reg::kStream, words[i]);
  }
  void piece(std::uint64_t ticks, bool silent) {
    driver::FeedCommand feed = test::feed(ticks, silent ? 1 : 16);
    feed.silent = silent;
    send(feed);
  }
  void hold() {
    engine->write(reg::kHold, 1);
    while ((engine->read(reg::kStatus) & field::kStatusHeld) == 0) engine->wait(100);
  }
  void drop() {
    engine->write(reg::kControl, field::kControlAbort);
    engine->wait(1000);
    number_ = 0;
  }
  void finish() {
    while ((engine->read(reg::kStatus) & field::kStatusBusy) != 0) engine->wait(1000);
    EXPECT_EQ(engine->read(reg::kFault), 0U);
  }

  std::unique_ptr<sim::Engine> engine;

 private:
  std::uint8_t number_ = 0;
};

TEST_P(HeldSilence, PathGoesOnFromItsMiddle) {
  constexpr std::uint64_t kTicks = 4000;
  constexpr std::uint64_t kDone = 1357;
  const driver::LineCommand line = test::line(kTicks, {900, -411, 7});
  piece(kDone, false);
  send(line);
  engine->wait(kTicks * 16);
  const std::vector<std::int64_t> there = engine->positions();
  EXPECT_EQ(there[0], (900 * kDone + kTicks / 2) / kTicks);
  hold();
  drop();
  piece(kDone, true);
  piece(kTicks - kDone, false);
  send(line);
  send(driver::EndCommand{});
  engine->wait(kTicks);
  EXPECT_EQ(engine->read(reg::kFeedBegun), 2U);
  EXPECT_NE(engine->read(reg::kStatus) & field::kStatusHeld, 0U);
  engine->wait(10'000);
  EXPECT_EQ(engine->positions(), there);
  engine->write(reg::kHold, 0);
  finish();
  const std::vector<std::int64_t> end = engine->positions();
  EXPECT_EQ(std::vector<std::int64_t>(end.begin(), end.begin() + 3), (std::vector<std::int64_t>{900, -411, 7}));
}

INSTANTIATE_TEST_SUITE_P(Engines, HeldSilence, testing::Values(sim::EngineKind::kModel, sim::EngineKind::kRtl),
                         [](const auto& kind) { return kind.param == sim::EngineKind::kRtl ? "Rtl" : "Model"; });

}  // namespace
