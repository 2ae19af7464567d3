// Programs whose stops take longer than what the queues hold: a host that is in time hardly ever makes the card hold,
// and most that die leave a ramp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "router_programs.hpp"
#include "steps.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::run {
namespace {

struct RouterRun {
  std::uint32_t under_runs = 0;
  double planned = 0;  // s
  double seconds = 0;
};

// The program's pins from the last clock of the bus on are the card's own doing.
class RouterCard {
 public:
  explicit RouterCard(std::uint64_t last_cycle = ~std::uint64_t{0})
      : engine_(sim::make_model_engine(sim::EngineOptions{4, kRouterClock, false})), bus_(*engine_, last_cycle) {
    engine_->set_sink(&steps_);
  }
  RouterRun run(const std::string& program) {
    driver::Card card = driver::Card::open(bus_);
    const machine::Machine machine = router();
    Runner runner([&] { return std::make_unique<gcode::TextLines>(program, "p.ngc"); }, machine,
                  planner::limits_of(card.identification()));
    const double planned = runner.plan().seconds;
    const std::uint32_t under_runs = runner.run(card).under_runs.value_or(1);
    return {under_runs, planned, static_cast<double>(engine_->cycles()) / kRouterClock};
  }
  void wait(std::uint64_t seconds) { engine_->wait(seconds * kRouterClock); }
  // The last pulses of an axis took less time than acceleration and a hold's share of it allow, from any speed.
  bool stopped_at_once() const { return at_once(0) || at_once(1); }

 private:
  static constexpr std::size_t kPulses = 8;

  bool at_once(std::size_t axis) const {
    const double least = std::sqrt(2 * (kPulses - 1) / kRouterStepsPerMm / (1.5 * kRouterAcceleration));
    const driver::PinStep* last = nullptr;
    std::size_t intervals = 0;
    for (auto step = steps_.pins.rbegin(); step != steps_.pins.rend(); ++step) {
      if (step->axis != axis) continue;
      if (last == nullptr) last = &*step;
      if (step->direction != last->direction) return false;
      if (intervals++ == kPulses) return static_cast<double>(last->cycle - step->cycle) < least * kRouterClock;
    }
    return false;
  }

  std::unique_ptr<sim::Engine> engine_;
  test::Steps steps_;
  DistantBus bus_;
};

// Each arc's ramps are many pieces of few ticks. They fill the feed queue, whose ticks are fewer than a stop from the
// quick line takes.
TEST(NoUnderRun, WhereArcsFollowAQuickLine) {
  for (const int length : {5, 20}) {
    std::string program = fmt::format("G0 X{}\nF300 G1 Y0.3\n", length);
    for (int i = 0; i < 8; ++i) {
      program += fmt::format("F{} G{} X{} Y0.3 I0.6\n", i % 2 == 0 ? 300 : 9000, 2 + i % 2, length);
      program += fmt::format("G1 X{}.2\nX{}\n", length, length);
    }
    EXPECT_EQ(RouterCard().run(program + "M2\n").under_runs, 0U) << length;
  }
}

bool long_router_run() { return std::getenv("TRAMMEL_LONG") != nullptr; }

// One program of a hundred still holds once.
TEST(NoUnderRun, RandomProgramsHardlyEver) {
  const std::uint64_t programs = long_router_run() ? 10'000 : 50;
  std::uint64_t starved = 0;
  double late = 0;
  double planned = 0;
  for (std::uint64_t seed = 1; seed <= programs; ++seed) {
    const RouterRun run = RouterCard().run(RouterProgram(seed).text());
    starved += run.under_runs != 0 ? 1U : 0U;
    late += run.seconds - run.planned;
    planned += run.planned;
  }
  RecordProperty("starved", std::to_string(starved));
  RecordProperty("seconds_late", fmt::format("{:.3f} of {:.0f}", late, planned));
  EXPECT_LE(starved, programs * 2 / 100);
  EXPECT_LT(late, 0.1 * static_cast<double>(programs));
}

// A stop from full speed takes 2 s and more path than dense queues hold: not every host that dies leaves a ramp.
TEST(NoUnderRun, HostsThatDieMostlyLeaveARamp) {
  const std::uint64_t programs = long_router_run() ? 15 : 2;
  const int deaths = long_router_run() ? 8 : 2;
  std::uint64_t died = 0;
  std::uint64_t at_once = 0;
  for (std::uint64_t seed = 1; seed <= programs; ++seed) {
    const std::string text = RouterProgram(seed).text();
    const double seconds = RouterCard().run(text).seconds;
    for (int death = 0; death < deaths; ++death) {
      RouterCard card(static_cast<std::uint64_t>((death + 0.5) / deaths * seconds * kRouterClock));
      EXPECT_ANY_THROW(card.run(text));  // before the first command it is the driver's error
      card.wait(3);
      ++died;
      at_once += card.stopped_at_once() ? 1U : 0U;
    }
  }
  RecordProperty("at_once", fmt::format("{} of {}", at_once, died));
  EXPECT_LE(2 * at_once, died);
}

}  // namespace
}  // namespace trammel::run
