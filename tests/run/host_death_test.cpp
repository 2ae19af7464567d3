// The host dies while the card's watchdog is set: the card stops on the path and keeps a fault with the cause. A host
// that lives never trips the watchdog.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "router_programs.hpp"
#include "steps.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::run {
namespace {

namespace field = card_map::field;
constexpr std::chrono::milliseconds kWatchdog(500);

// A host with a program, and the card that it leaves behind.
struct WatchedHost {
  explicit WatchedHost(std::uint64_t last_cycle = ~std::uint64_t{0}) : bus(*engine, last_cycle) {
    engine->set_sink(&steps);
  }
  void run(const std::string& program) {
    driver::Card card = driver::Card::open(bus);
    const machine::Machine machine = router();
    Runner runner([&] { return std::make_unique<gcode::TextLines>(program, "p.ngc"); }, machine,
                  planner::limits_of(card.identification()));
    runner.plan();
    const driver::WatchdogScope watchdog(card, kWatchdog);
    runner.run(card);
  }

  std::unique_ptr<sim::Engine> engine = sim::make_model_engine(sim::EngineOptions{4, kRouterClock, false});
  test::Steps steps;
  DistantBus bus;
};

// Arcs, and a line that takes longer than the watchdog's time, the ramp of a stop and the commands sent ahead.
const std::string& watched_program() {
  static const std::string text = "F6000\nG1 X5 Y3\nG2 X15 Y3 I5\nG1 X195\nG3 X195 Y30 J13.5\nG1 X20\n";
  return text;
}

TEST(HostDeath, AHostThatLivesNeverMeetsTheWatchdog) {
  WatchedHost host;
  host.run(watched_program());
  EXPECT_EQ(host.engine->read(card_map::reg::kFault), 0U);
  EXPECT_EQ(host.engine->read(card_map::reg::kWatchdog), 0U) << "or a card that nobody moves has a fault";
  EXPECT_EQ(host.engine->read(card_map::reg::kUnderruns), 0U);
}

// After the host's death the card acts by its watchdog alone: it makes the same steps as with a living host, up to a
// stop.
void expect_stop_on_path(const test::Steps& whole, std::uint64_t died) {
  WatchedHost host(died);
  ASSERT_THROW(host.run(watched_program()), RunError);
  const std::size_t at_death = host.steps.path.size();
  host.engine->wait(4 * kRouterClock);  // a ramp takes 2 s at most
  driver::Card card = driver::Card::open(*host.engine);
  const driver::Snapshot end = card.read_snapshot();
  EXPECT_EQ(end.faults, field::kFaultWatchdog | field::kFaultLinkLoss);
  EXPECT_FALSE(end.status.busy);
  EXPECT_NE(end.position, card.read_stop_snapshot().position) << "it has gone on for a ramp";
  const std::size_t made = host.steps.path.size();
  EXPECT_GT(made, at_death) << "it was moving";
  ASSERT_LT(made, whole.path.size()) << "it has stopped before the end";
  for (std::size_t i = 0; i < made; ++i) {
    const driver::PathStep& step = host.steps.path[i];
    const driver::PathStep& wanted = whole.path[i];
    ASSERT_EQ(step.command, wanted.command) << i;
    ASSERT_EQ(step.tick, wanted.tick) << i;
    ASSERT_EQ(step.axis, wanted.axis) << i;
    ASSERT_EQ(step.direction, wanted.direction) << i;
  }
  EXPECT_EQ(host.steps.pins.size(), made);
  for (std::size_t axis = 0; axis < 4; ++axis) EXPECT_EQ(end.position[axis], host.steps.position(axis)) << axis;
  host.engine->wait(kRouterClock);
  EXPECT_EQ(host.steps.path.size(), made) << "nothing moves by itself";
}

TEST(HostDeath, TheCardStopsOnThePathWithAFault) {
  WatchedHost living;
  living.run(watched_program());
  const std::uint64_t clocks = living.engine->cycles();
  for (const std::uint64_t twentieth : {2U, 8U, 14U}) {
    SCOPED_TRACE(twentieth);
    ASSERT_NO_FATAL_FAILURE(expect_stop_on_path(living.steps, clocks * twentieth / 20));
  }
}

}  // namespace
}  // namespace trammel::run
