// The rules of the machine's place: who sets it, which events make an axis lose it, and which it survives.
#include "trammel/model/machine_place.hpp"

#include <gtest/gtest.h>

namespace trammel::model {
namespace {

namespace reg = card_map::reg;

constexpr std::uint32_t kAll = 0x0F0F;  // four axes, valid and homed

// A MachinePlace with inputs that keep their values until they are changed.
struct Machine {
  MachinePlace place{4};
  MachinePlace::Inputs in;

  Machine() { set(reg::kSetPlace, 0x000F0003); }
  void clock() { place.clock(in); }
  void set(std::uint32_t address, std::uint32_t data) {
    in.setting = {true, address, data};
    clock();
    in.setting.set = false;
  }
  void step(std::uint8_t axes) {
    in.step = axes;
    clock();
    in.step = 0;
  }
  void cut() {
    in.cut = true;
    clock();
    in.cut = false;
  }
  // A loss is visible two clocks after its event.
  std::uint32_t after_cut() {
    cut();
    in.step = 0;
    clock();
    return place.place();
  }
};

TEST(MachinePlace, TheHostWritesEachAxis) {
  EXPECT_EQ(MachinePlace(4).place(), 0U) << "after reset";
  Machine machine;
  EXPECT_EQ(machine.place.place(), kAll);
  machine.set(reg::kSetPlace, 0x00020001);
  EXPECT_EQ(machine.place.place(), 0x0D0FU) << "axis 1 is valid, not homed";
  machine.set(reg::kSetPlace, 0x00F40000);
  EXPECT_EQ(machine.place.place(), 0x090BU) << "axis 2; absent axes do not count";
}

TEST(MachinePlace, ACutTakesItFromTheAxesThatMove) {
  Machine machine;
  machine.in.runs = true;
  machine.step(0x5);
  machine.clock();
  EXPECT_EQ(machine.after_cut(), 0x0A0AU);
  machine.set(reg::kSetPlace, 0x000F0003);
  EXPECT_EQ(machine.place.place(), kAll) << "the host sets it again";
}

TEST(MachinePlace, AStepInTheClockOfTheCutCounts) {
  Machine machine;
  machine.in.runs = true;
  machine.in.step = 2;
  EXPECT_EQ(machine.after_cut(), 0x0D0DU);
}

TEST(MachinePlace, ACutAtRestTakesNothing) {
  Machine machine;
  machine.in.runs = true;
  machine.step(0xF);
  machine.in.at_rest = true;
  EXPECT_EQ(machine.after_cut(), kAll) << "behind a hold or a ramp";
  machine.in.at_rest = false;
  machine.in.runs = false;
  machine.clock();
  EXPECT_EQ(machine.after_cut(), kAll) << "nothing is under way";
  machine.in.runs = true;
  EXPECT_EQ(machine.after_cut(), kAll) << "the next motion has not begun to step";
}

TEST(MachinePlace, KeepsPlaceNamesAxesThatOutliveACut) {
  Machine machine;
  machine.set(reg::kKeepsPlace, 0x1);
  machine.in.runs = true;
  machine.step(0x3);
  EXPECT_EQ(machine.after_cut(), 0x0D0DU);
  machine.in.drives = 1;
  machine.clock();
  machine.clock();
  EXPECT_EQ(machine.place.place(), 0x0C0CU) << "not a fault of the drive";
}

TEST(MachinePlace, KeepsPlaceCountsForACutInItsClock) {
  Machine machine;
  machine.in.runs = true;
  machine.step(0x3);
  machine.in.cut = true;
  machine.set(reg::kKeepsPlace, 0x1);
  machine.in.cut = false;
  machine.clock();
  EXPECT_EQ(machine.place.place(), 0x0D0DU);
}

TEST(MachinePlace, ALossWinsOverAWriteInItsClockAndInTheNext) {
  Machine machine;
  machine.in.drives = 8;
  machine.set(reg::kSetPlace, 0x000F0003);
  machine.in.drives = 0;
  machine.set(reg::kSetPlace, 0x000F0003);
  EXPECT_EQ(machine.place.place(), 0x0707U);
  machine.set(reg::kSetPlace, 0x000F0003);
  EXPECT_EQ(machine.place.place(), kAll);
}

TEST(MachinePlace, ALossShowsTwoClocksAfterItsEvent) {
  Machine machine;
  machine.in.runs = true;
  machine.step(0x5);
  machine.cut();
  EXPECT_EQ(machine.place.place(), kAll);
  machine.clock();
  EXPECT_EQ(machine.place.place(), 0x0A0AU);
}

}  // namespace
}  // namespace trammel::model
