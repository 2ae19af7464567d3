// Programs that wait for the spindle's speed, on the model's card: the time of the first step after M3, and the end of
// a wait for a speed that is never reached.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "clocks.hpp"
#include "steps.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/run/interrupted.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

using ::testing::HasSubstr;

class SpindleAtSpeed : public testing::Test {
 protected:
  SpindleAtSpeed() {
    engine_->set_sink(&steps_);
    machine::apply_override(machine_, "inputs.spindle_at_speed=5");
    machine::apply_override(machine_, "inputs.closed_level=1");
  }
  void at_speed(double seconds, bool level) {
    bus_.at(static_cast<std::uint64_t>(seconds * kClock),
            [level](sim::Engine& engine) { engine.set_inputs(level ? 1U << 5 : 0); });
  }
  std::string run(const std::string& text) {
    const auto lines = [&text] { return std::make_unique<gcode::TextLines>(text, "s.ngc"); };
    Runner runner(lines, machine_, planner::limits_of(card_.identification()));
    try {
      runner.plan();
      runner.run(card_);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  // Position of X in pulses at a time of the card.
  std::int64_t x(double seconds) const { return steps_.position(0, static_cast<std::uint64_t>(seconds * kClock)); }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  sim::TimedBus bus_{*engine_, kClock, 1e9};
  driver::Card card_ = driver::Card::open(bus_);
  test::Steps steps_;
};

TEST_F(SpindleAtSpeed, ComesBeforeTheCut) {
  at_speed(2, true);
  EXPECT_EQ(run("G0 X1\nM3 S500\nG1 X2 F600\nM2\n"), "");
  EXPECT_EQ(x(1.999), 80) << "the traverse is done, the cut is not begun";
  EXPECT_GT(x(2.1), 80);
  EXPECT_EQ(x(10), 160);
}

TEST_F(SpindleAtSpeed, IsWaitedForBehindTheTimeToSpinUp) {
  machine::apply_override(machine_, "spindle.output=1");
  machine::apply_override(machine_, "spindle.spin_up_s=1");
  at_speed(0, true);
  at_speed(0.5, false);
  at_speed(3, true);
  EXPECT_EQ(run("M3 S500\nG1 X1 F600\nM2\n"), "");
  EXPECT_EQ(x(2.999), 0) << "at the end of the first second the input has fallen";
  EXPECT_GT(x(3.1), 0);
}

TEST_F(SpindleAtSpeed, IsWaitedForAtEachNewSpeed) {
  at_speed(1, true);
  at_speed(1.01, false);
  at_speed(4, true);
  EXPECT_EQ(run("M3 S500\nG1 X0.1 F600\nS600\nG1 X1\nM5\nM2\n"), "");
  EXPECT_EQ(x(3.999), 8);
  EXPECT_EQ(x(10), 80);
}

TEST_F(SpindleAtSpeed, ThatDoesNotComeEndsTheProgram) {
  machine::apply_override(machine_, "spindle.output=1");
  machine::apply_override(machine_, "spindle.at_speed_s=1.5");
  const std::string error = run("G0 X1\nM3 S500\nG1 X2 F600\nM2\n");
  EXPECT_THAT(error, HasSubstr("s.ngc:2: the spindle is not at speed after 1.5 s"));
  EXPECT_EQ(x(100), 80);
  EXPECT_FALSE(card_.read_status().busy);
}

TEST_F(SpindleAtSpeed, IsNothingThatALaserHas) {
  machine::apply_override(machine_, "spindle.output=1");
  machine::apply_override(machine_, "spindle.laser=true");
  EXPECT_EQ(run("M4 S500\nG1 X1 F600\nM2\n"), "");
}

TEST_F(SpindleAtSpeed, AWaitEndsWithAnInterrupt) {
  bool asked = false;
  bus_.at(kClock, [&asked](sim::Engine&) { asked = true; });
  const driver::InterruptScope interrupt([&asked] { return asked; });
  EXPECT_THAT(run("M3 S500\nG1 X2 F600\nM2\n"), HasSubstr("interrupted"));
  EXPECT_EQ(x(100), 0);
}

}  // namespace
}  // namespace trammel::run
