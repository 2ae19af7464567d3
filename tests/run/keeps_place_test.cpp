// The setting keeps_place of the machine file's axes, as the card receives it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

using ::testing::HasSubstr;

// A card that reports version 3.2 of the register map.
class OldCard final : public driver::Bus {
 public:
  explicit OldCard(driver::Bus& behind) : behind_(behind) {}
  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    const std::size_t made = behind_.transfer(accesses, count);
    for (std::size_t i = 0; i < made; ++i) {
      if (accesses[i].write && accesses[i].address == card_map::reg::kKeepsPlace) ++writes;
      if (!accesses[i].write && accesses[i].address == card_map::reg::kMapVersion) accesses[i].data = 0x30002;
    }
    return made;
  }
  void sleep(std::chrono::nanoseconds time) override { behind_.sleep(time); }
  bool reports_refusals() const override { return behind_.reports_refusals(); }

  unsigned writes = 0;

 private:
  driver::Bus& behind_;
};

machine::Machine machine_with(const std::string& keeping) {
  machine::Machine machine = machine::default_machine();
  for (const char letter : keeping)
    machine::apply_override(machine, std::string("axis.") + letter + ".keeps_place=true");
  return machine;
}

TEST(KeepsPlace, IsSetForTheMotorsOfEachAxis) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{6, 1'000'000, false});
  driver::Card card = driver::Card::open(*engine);
  machine::Machine machine = machine_with("yz");
  machine::apply_override(machine, "axis.y.second_motor=true");  // motors: X Y Z E Y
  configure(card, machine);
  EXPECT_EQ(card.read_keeps_place(), 0x16);
  card.set_keeps_place(0x36);
  configure(card, machine_with("x"));
  EXPECT_EQ(card.read_keeps_place(), 0x31) << "axes 4 and 5 are no motors of this machine";
}

TEST(KeepsPlace, OfBeltsIsThatOfTheirMotors) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, 1'000'000, false});
  driver::Card card = driver::Card::open(*engine);
  machine::Machine machine = machine_with("x");
  machine::apply_override(machine, "kinematics.name='corexy'");
  configure(card, machine);
  EXPECT_EQ(card.read_keeps_place(), 1) << "[axis.x] has the settings of motor A";
}

TEST(KeepsPlace, WhatAnotherMachineFileHasSaidEnds) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, 1'000'000, false});
  driver::Card card = driver::Card::open(*engine);
  configure(card, machine_with("xy"));
  set_keeps_place(card, machine_with(""));
  EXPECT_EQ(card.read_keeps_place(), 0);
}

TEST(KeepsPlace, IsRefusedOnCardsThatKeepNone) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, 1'000'000, false});
  OldCard bus(*engine);
  driver::Card card = driver::Card::open(bus);
  configure(card, machine_with(""));
  set_keeps_place(card, machine_with(""));
  try {
    configure(card, machine_with("z"));
    ADD_FAILURE() << "the card has the map 3.2";
  } catch (const driver::ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("keeps_place of the machine file: the card's map 3.2 keeps no place"));
  }
  EXPECT_EQ(bus.writes, 0U);
}

}  // namespace
}  // namespace trammel::run
