// Programs whose stops take longer than what the queues hold: a host that is in time never makes the card hold.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "trammel/run/runner.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

constexpr std::uint32_t kRouterClock = 10'000'000;
constexpr double kBytesPerSecond = 1e6;

// A stop from full speed takes 2 s.
machine::Machine router() {
  machine::Machine machine = machine::default_machine();
  machine.motion.junction_deviation = 0.01;
  for (machine::MachineAxis& axis : machine.axes) {
    axis.steps_per_mm = 20;
    axis.max_velocity = 300;
    axis.max_acceleration = 300;
  }
  return machine;
}

// Each transfer takes a millisecond beside its bytes.
class DistantBus final : public driver::Bus {
 public:
  explicit DistantBus(driver::Bus& bus) : bus_(bus) {}
  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    bus_.sleep(std::chrono::milliseconds(1));
    return bus_.transfer(accesses, count);
  }
  void sleep(std::chrono::nanoseconds time) override { bus_.sleep(time); }
  bool reports_refusals() const override { return bus_.reports_refusals(); }

 private:
  driver::Bus& bus_;
};

std::uint32_t under_runs(const std::string& program) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, kRouterClock, false});
  sim::TimedBus bus(*engine, kRouterClock, kBytesPerSecond);
  DistantBus distant(bus);
  driver::Card card = driver::Card::open(distant);
  const machine::Machine machine = router();
  Runner runner([&] { return std::make_unique<gcode::TextLines>(program, "p.ngc"); }, machine,
                planner::limits_of(card.identification()));
  runner.plan();
  return runner.run(card).under_runs.value_or(1);
}

// Each arc's ramps are many pieces of few ticks. They fill the feed queue, whose ticks are fewer than a stop from the
// quick line takes.
TEST(NoUnderRun, WhereArcsFollowAQuickLine) {
  for (const int length : {5, 20}) {
    std::string program = fmt::format("G0 X{}\nF300 G1 Y0.3\n", length);
    for (int i = 0; i < 8; ++i) {
      program += fmt::format("F{} G{} X{} Y0.3 I0.6\n", i % 2 == 0 ? 300 : 9000, 2 + i % 2, length);
      program += fmt::format("G1 X{}.2\nX{}\n", length, length);
    }
    EXPECT_EQ(under_runs(program + "M2\n"), 0U) << length;
  }
}

}  // namespace
}  // namespace trammel::run
