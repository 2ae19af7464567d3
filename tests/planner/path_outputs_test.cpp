// Outputs that a program switches: OUTPUT commands come at their place between the paths and do not change the paths.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "plan.hpp"

namespace trammel::planner {
namespace {

using ::testing::HasSubstr;

CardLimits card_with(unsigned outputs) {
  CardLimits card;
  card.clock_hz = 1'000'000;
  card.outputs = outputs;
  return card;
}

machine::Machine machine_with_outputs() {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "outputs.m3=0");
  machine::apply_override(machine, "outputs.m4=3");
  machine::apply_override(machine, "outputs.m8=2");
  return machine;
}

std::vector<driver::OutputCommand> outputs_of(const Planned& block) { return commands<driver::OutputCommand>(block); }

bool is(const driver::OutputCommand& output, unsigned set, unsigned clear) {
  return output.set == set && output.clear == clear;
}

TEST(PathOutputs, StandBeforeTheBlockThatTheyComeBefore) {
  const Plan plan =
      plan_text("F1200\nM3\nG1 X10\nM8 X20\nG4 P0.1 M5\nG0 X0\nM9\nM2\n", machine_with_outputs(), card_with(4));
  ASSERT_FALSE(plan.error);
  ASSERT_EQ(plan.blocks.size(), 5U);
  const std::vector<std::pair<unsigned, unsigned>> expected{{1, 8}, {4, 0}, {0, 9}, {0, 0}, {0, 13}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Planned& block = plan.blocks[i];
    const auto [set, clear] = expected[i];
    EXPECT_EQ(block.planned.commands, block.commands.size()) << i;
    ASSERT_EQ(outputs_of(block).size(), (set | clear) != 0 ? 1U : 0U) << i;
    if ((set | clear) == 0) continue;
    EXPECT_TRUE(is(outputs_of(block)[0], set, clear)) << i;
    EXPECT_TRUE(std::holds_alternative<driver::OutputCommand>(block.commands[0])) << i << ": before all others";
  }
}

TEST(PathOutputs, OfSeveralInARowTheLastWins) {
  const Plan plan = plan_text("M3\nM8\nG1 X0 F60\nM4\nM9\nX1\n", machine_with_outputs(), card_with(4));
  ASSERT_EQ(plan.blocks.size(), 2U);
  ASSERT_EQ(outputs_of(plan.blocks[0]).size(), 1U) << "a line that goes nowhere is no path between them";
  EXPECT_TRUE(is(outputs_of(plan.blocks[0])[0], 8, 5));
}

// Chords without a stop, with a word of outputs before each: more words than the look-ahead can hold.
TEST(PathOutputs, ThePlanIsTheSameWithThem) {
  machine::Machine machine = machine_with_outputs();
  machine::apply_override(machine, "motion.window=64");
  std::mt19937 random(1);
  std::string plain = "F3000\n";
  std::string switched = plain;
  for (int i = 0; i < 6000; ++i) {
    const std::string move =
        "G1 X" + std::to_string(i * 0.1) + " Y" + std::to_string(static_cast<double>(random() % 10) * 0.01) + "\n";
    plain += move;
    switched += (i % 2 == 0 ? "M3\nM8\n" : "M5\nM9\n") + move;
  }
  const Plan without = plan_text(plain, machine, card_with(4));
  const Plan with = plan_text(switched, machine, card_with(4));
  ASSERT_EQ(with.blocks.size(), without.blocks.size());
  std::size_t stops = 0;
  for (std::size_t i = 0; i < with.blocks.size(); ++i) {
    std::vector<driver::Command> rest = with.blocks[i].commands;
    if (moves(with.blocks[i].planned.block)) {
      ASSERT_TRUE(std::holds_alternative<driver::OutputCommand>(rest[0])) << i;
      rest.erase(rest.begin());
    }
    ASSERT_EQ(rest.size(), without.blocks[i].commands.size()) << i;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      std::vector<std::uint32_t> a;
      std::vector<std::uint32_t> b;
      driver::encode(rest[k], 0, a);
      driver::encode(without.blocks[i].commands[k], 0, b);
      ASSERT_EQ(a, b) << i << ", " << k;
    }
    ASSERT_EQ(with.blocks[i].planned.seconds, without.blocks[i].planned.seconds) << i;
    stops += with.blocks[i].planned.stop ? 1U : 0U;
  }
  EXPECT_EQ(stops, 1U) << "at the end";
}

TEST(PathOutputs, WhatTheCardCannotSwitchOnIsRefused) {
  const std::string program = "G1 X1 F60\nM4\nX2\nM2\n";
  const Plan none = plan_text(program, machine_with_outputs(), card_with(0));
  ASSERT_TRUE(none.error);
  EXPECT_EQ(none.error->code, gcode::ErrorCode::kNoOutput);
  EXPECT_EQ(none.error->line, 2U);
  EXPECT_THAT(none.error->message, HasSubstr("output 3 of the machine file cannot be switched: the card has no path"));
  EXPECT_EQ(none.blocks.size(), 1U) << "what stands before it is planned";
  const Plan few = plan_text(program, machine_with_outputs(), card_with(3));
  ASSERT_TRUE(few.error);
  EXPECT_THAT(few.error->message, HasSubstr("output 3 of the machine file: the card has 3"));
  EXPECT_FALSE(plan_text(program, machine_with_outputs(), card_with(4)).error);
  // An output that the card lacks is never on, so switching it off needs no command.
  const Plan off = plan_text("M5\nM9\nG1 X1 F60\nM2\n", machine_with_outputs(), card_with(0));
  EXPECT_FALSE(off.error);
  for (const Planned& block : off.blocks) EXPECT_TRUE(outputs_of(block).empty());
}

}  // namespace
}  // namespace trammel::planner
