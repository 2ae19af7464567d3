// Two motors on one axis letter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "steps.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/jog.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

std::vector<driver::PinStep> of(const test::Steps& steps, unsigned axis) {
  std::vector<driver::PinStep> result;
  for (const driver::PinStep& step : steps.pins) {
    if (step.axis == axis) result.push_back(step);
  }
  return result;
}

TEST(SecondMotor, MakesItsAxisStepsInTheSameClocks) {
  machine::Machine machine = machine::default_machine();  // motors: X Y Z E
  machine::apply_override(machine, "axis.y.second_motor=true");
  machine::apply_override(machine, "axis.y.second_inverted=true");
  const auto engine = sim::make_model_engine(sim::EngineOptions{5, 1'000'000, false});
  test::Steps steps;
  engine->set_sink(&steps);
  driver::Card card = driver::Card::open(*engine);
  // Lines, and an arc. The arc is sent as lines although X and Y have equal scales.
  Runner runner(
      [] { return std::make_unique<gcode::TextLines>("G1 X2 Y3 F900\nG3 X0 Y1 I-1 J-1\nG0 X0 Y-1\n", "p.ngc"); },
      machine, planner::limits_of(card.identification()));
  runner.plan();
  const Outcome outcome = runner.run(card);
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{0, -80, 0, 0, -80}));
  EXPECT_EQ(outcome.counted, (std::vector<std::int64_t>{0, -80, 0, 0, -80}));
  const auto expect_together = [&] {
    const auto first = of(steps, 1);
    const auto second = of(steps, 4);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(first[i].cycle, second[i].cycle);
      ASSERT_EQ(first[i].direction, second[i].direction);
    }
  };
  EXPECT_GT(of(steps, 1).size(), 240U + 160U);
  expect_together();
  // The second motor has an inversion of its own: its direction is inverted, the first motor's is not.
  EXPECT_EQ(card.parts().registers.read(card_map::reg::mode(1)) & card_map::field::kModeInvertSecond, 0U);
  EXPECT_NE(card.parts().registers.read(card_map::reg::mode(4)) & card_map::field::kModeInvertSecond, 0U);

  MachinePosition position(card.read_snapshot(), machine);
  Jog jog(card, machine, position);
  jog.start({0, 2}, 20);
  jog.wait();
  EXPECT_EQ(position.pulses()[1], 160);
  expect_together();
}

TEST(SecondMotor, HasANameInMessages) {
  machine::Machine machine = machine::default_machine();
  EXPECT_THAT(names_of_card_axes(machine), testing::ElementsAre("X", "Y", "Z", "E"));
  machine::apply_override(machine, "axis.y.second_motor=true");
  machine::apply_override(machine, "axis.e.second_motor=true");
  EXPECT_THAT(names_of_card_axes(machine),
              testing::ElementsAre("X", "Y", "Z", "E", "second motor of Y", "second motor of E"));
}

TEST(SecondMotor, MachineFile) {
  machine::Machine machine = machine::default_machine();
  EXPECT_EQ(machine.motors(), 4U);
  for (const char* letter : {"x", "y", "z", "e"}) {
    machine::apply_override(machine, std::string("axis.") + letter + ".second_motor=true");
  }
  EXPECT_EQ(machine.motors(), 8U);
  EXPECT_THAT(machine.second_motors(), testing::ElementsAre(0, 1, 2, 3));
  const auto error_of = [](machine::Machine changed, const std::string& text) -> std::string {
    try {
      machine::apply_override(changed, text);
    } catch (const machine::MachineError& error) {
      return error.what();
    }
    return "";
  };
  const machine::Machine plain = machine::default_machine();
  EXPECT_THAT(error_of(plain, "axis.x.second_inverted=true"),
              testing::HasSubstr("second_inverted without second_motor"));
  EXPECT_THAT(error_of(plain, "axis.x.second_motor=2"),
              testing::HasSubstr("axis.x.second_motor must be true or false"));
  std::string text = machine::default_machine_text();
  for (const char* name : {"a", "b", "c", "u"}) {
    text += std::string("[axis.") + name +
            "]\nsteps_per_mm=80\nmax_velocity=1\nmax_acceleration=1\nstep_length_ns=1\nstep_space_ns=1\n"
            "direction_setup_ns=1\ndirection_hold_ns=1\ninverted=false\n";
    if (*name != 'u') text += "endless=true\n";
  }
  const machine::Machine eight = machine::parse_machine(text, "m");
  EXPECT_EQ(eight.motors(), 8U);
  EXPECT_THAT(error_of(eight, "axis.x.second_motor=true"), testing::HasSubstr("9 motors, second ones included"));
}

}  // namespace
}  // namespace trammel::run
