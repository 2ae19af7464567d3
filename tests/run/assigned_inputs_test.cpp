// Switches operated by hand, on the model's card: pressed and released, never pressed, stuck.
#include "trammel/run/assigned_inputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "clocks.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

using namespace std::chrono_literals;

class Switches : public testing::Test {
 protected:
  void at(double seconds, std::uint32_t pins) {
    bus_.at(static_cast<std::uint64_t>(seconds * kClock), [pins](sim::Engine& engine) { engine.set_inputs(pins); });
  }
  SwitchResult tried(unsigned input) {
    return try_switch(card_, input, 1s, [this](SwitchStep step) { steps_.push_back(step); });
  }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  sim::TimedBus bus_{*engine_, kClock, 1e9};
  driver::Card card_ = driver::Card::open(bus_);
  std::vector<SwitchStep> steps_;
};

TEST_F(Switches, InputsAndTheirRolesByInput) {
  machine::Machine machine = machine::default_machine();
  EXPECT_TRUE(assigned_inputs(card_).empty());
  machine::apply_override(machine, "inputs.x_limit=5");
  machine::apply_override(machine, "inputs.x_home=5");
  machine::apply_override(machine, "inputs.feed_hold=2");
  configure(card_, machine);
  const std::vector<AssignedInput> inputs = assigned_inputs(card_);
  ASSERT_EQ(inputs.size(), 2U);
  EXPECT_EQ(inputs[0].text(), "input 2 (feed hold)");
  EXPECT_EQ(inputs[1].text(), "input 5 (limit minus of axis 0, limit plus of axis 0, home of axis 0)");
}

TEST_F(Switches, PressedAndReleased) {
  at(0.3, 4);
  at(0.9, 0);
  EXPECT_EQ(tried(2), SwitchResult::kWorks);
  EXPECT_THAT(steps_, testing::ElementsAre(SwitchStep::kPress, SwitchStep::kRelease));
}

TEST_F(Switches, NeverPressed) {
  at(0.3, 2);
  EXPECT_EQ(tried(2), SwitchResult::kNotPressed);
  EXPECT_LT(engine_->cycles(), 2 * kClock);
}

TEST_F(Switches, Stuck) {
  at(0.3, 4);
  EXPECT_EQ(tried(2), SwitchResult::kNotReleased);
}

TEST_F(Switches, ActiveBefore) {
  engine_->set_inputs(4);
  at(0.3, 0);
  EXPECT_EQ(tried(2), SwitchResult::kActiveBefore);
  EXPECT_THAT(steps_, testing::ElementsAre(SwitchStep::kRelease));
}

}  // namespace
}  // namespace trammel::run
