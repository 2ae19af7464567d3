// The pins of the Verilated card alone, with a checker of their own. The emergency stop acts at times that a
// clock-by-clock model cannot represent: outputs change without a clock, and a press that comes and goes between two
// clock edges stops the card. The second subject is the length of pulses, for events in each of their clocks.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "rtl_buses.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/sim/lockstep.hpp"

namespace {

using namespace trammel;
namespace reg = card_map::reg;
namespace field = card_map::field;

// The expectations of the scenario. An unmet one is reported as a mismatch, so that seeded bugs are detected.
class Wishes {
 public:
  explicit Wishes(std::uint64_t seed) : check_("card_pins", seed) {}
  void that(const char* what, std::uint64_t seen, std::uint64_t wanted) {
    check_.next_cycle();
    check_.compare(what, seen, wanted);
  }
  std::uint64_t comparisons() const { return check_.comparisons(); }

 private:
  lockstep::Checker check_;
};

class Card {
 public:
  explicit Card(bool level) : level_(level) {
    dut_->clock_hz_i = 1'000'000;
    dut_->idle_level_i = 0;
    dut_->output_idle_i = 0b0101;
    dut_->emergency_stop_level_i = level;
    dut_->input_i = 0;
    dut_->awvalid_i = dut_->wvalid_i = dut_->bready_i = dut_->arvalid_i = dut_->rready_i = 0;
    press(false);
    dut_->rst_i = 1;
    clocks(3);
    dut_->rst_i = 0;
    clocks(300);
  }

  // Evaluated at once, independent of the clock.
  void press(bool pressed) {
    dut_->emergency_stop_i = pressed == level_;
    dut_->eval();
  }
  void clocks(unsigned count) {
    for (unsigned i = 0; i < count; ++i) clock();
  }
  // One period; then `watch`, if set, receives the pins.
  void clock() {
    dut_.clock();
    if (watch) watch(dut_->step_o, dut_->dir_o);
  }
  std::function<void(unsigned, unsigned)> watch;
  std::uint32_t position(unsigned axis) {
    return static_cast<std::uint32_t>(get(
        dut_->observe_o, up(bus::axis_observe::kPosition, bus::observe::kWidth + bus::axis_observe::kWidth * axis)));
  }
  // The host begins a write and then stops.
  void begin_a_write() { dut_->awvalid_i = 1; }
  void write(std::uint32_t address, std::uint32_t data) {
    dut_->awvalid_i = dut_->wvalid_i = dut_->bready_i = 1;
    dut_->awaddr_i = static_cast<SData>(address);
    dut_->wdata_i = data;
    dut_->wstrb_i = 0xF;
    while (dut_->awready_o == 0) clock();
    clock();
    dut_->awvalid_i = dut_->wvalid_i = 0;
    while (dut_->bvalid_o == 0) clock();
    clock();
  }
  unsigned outputs() { return dut_->output_o; }
  std::uint64_t fault() { return get(dut_->observe_o, bus::observe::kFault); }
  // Half a clock period, so that a press can fall into either half.
  void half(bool high) {
    dut_->clk_i = high;
    dut_->eval();
  }

 private:
  lockstep::Simulated<Vdut> dut_;
  bool level_;
};

constexpr unsigned kIdle = 0b0101;
constexpr unsigned kSafe = 0b0011;  // at the cause output 1 goes on and output 2 off; the others keep their levels

void glitches(bool level) {
  Wishes wish(level ? 1 : 0);
  Card card(level);
  card.write(reg::kOutputSafeCause, 0b0110 << 16 | 0b0010);
  for (const bool high : {false, true}) {
    for (unsigned round = 0; round < 4; ++round) {
      const bool lasts = round % 2 == 1;
      wish.that("outputs before", card.outputs(), round == 0 && !high ? kIdle : kSafe);
      wish.that("fault before", card.fault(), 0);
      card.half(!high);
      card.half(high);
      card.press(true);
      wish.that("outputs without a clock", card.outputs(), kSafe);
      wish.that("fault without a clock", card.fault(), 0);
      if (!lasts) card.press(false);
      wish.that("outputs when the press is over", card.outputs(), kSafe);
      card.half(!high);
      card.half(high);
      card.half(!high);
      card.clocks(5);
      wish.that("fault", card.fault(), field::kFaultEmergencyStop);
      wish.that("outputs in the stop", card.outputs(), kSafe);
      if (lasts) {
        card.write(reg::kFault, field::kFaultEmergencyStop);
        wish.that("fault that was cleared while the pin is active", card.fault(), field::kFaultEmergencyStop);
        card.press(false);
      }
      card.clocks(60);
      wish.that("fault stays", card.fault(), field::kFaultEmergencyStop);
      card.write(reg::kFault, field::kFaultEmergencyStop);
      card.clocks(40);
    }
  }
  EXPECT_EQ(wish.comparisons(), 2U * (4 * 8 + 2));
}

TEST(EmergencyPin, ActiveHigh) {
  EXPECT_EQ(lockstep::judge([] { glitches(true); }), "");
}
TEST(EmergencyPin, ActiveLow) {
  EXPECT_EQ(lockstep::judge([] { glitches(false); }), "");
}

// The pulses at the pins of both axes. Axis 0 has a pulse per step, axis 1 a pin per direction.
class Pulses {
 public:
  void look(unsigned step, unsigned dir) {
    const std::array<bool, 3> now{(step & 1) != 0, (step & 2) != 0, (dir & 2) != 0};
    for (std::size_t pin = 0; pin < now.size(); ++pin) {
      if (now[pin] && high_[pin] == 0) ++begun_[pin];
      if (now[pin])
        ++high_[pin];
      else if (high_[pin] != 0)
        lengths.push_back(std::exchange(high_[pin], 0U));
    }
  }
  bool in_pulse() const { return high_[0] != 0; }
  unsigned begun(unsigned pin) const { return begun_[pin]; }

  std::vector<unsigned> lengths;  // lengths of the completed pulses, clocks

 private:
  std::array<unsigned, 3> high_{};
  std::array<unsigned, 3> begun_{};
};

constexpr unsigned kLength = 12;  // clocks of a pulse
constexpr unsigned kShorter = 3;

// Events that may come during a pulse. MODE is left out, because inverting a pin is an edge.
std::vector<std::function<void(Card&)>> happenings() {
  std::vector<std::function<void(Card&)>> all;
  const auto writes = [&all](std::uint32_t address, std::uint32_t data) {
    all.emplace_back([address, data](Card& card) { card.write(address, data); });
  };
  writes(reg::kControl, field::kControlAbort);
  writes(reg::kControl, field::kControlFlush);
  writes(reg::kControl, field::kControlSnapshot);
  writes(reg::kHold, 1);
  writes(reg::kRatioFeed, 0);
  writes(reg::kSlew, 1);
  writes(reg::kHoldLimit, 1);  // a step fault
  writes(reg::step_length(0), kShorter);
  writes(reg::step_space(0), 0);
  writes(reg::dir_setup(0), 100);
  writes(reg::dir_hold(0), 100);
  writes(reg::kEnable, field::kEnableManual);
  writes(reg::kEnableAxes, 0);
  writes(reg::kDisableCauses, 0x7FFFF);
  writes(reg::kOutputRoles, 0);
  writes(reg::kOutputSafeCause, 0xFFFFFFFF);
  writes(reg::kStopReaction, 0);
  writes(reg::kWatchdog, 1);
  writes(reg::kStreaming, 1);
  writes(reg::kIrqEnable, 0x3FFFFF);
  writes(reg::kStream, 0xFFFFFFFF);
  writes(reg::kStart, 1);
  writes(reg::kSetPlace, 0xFF0000);
  all.emplace_back([](Card& card) { card.press(true); });
  all.emplace_back([](Card& card) {
    card.press(true);
    card.press(false);
  });
  all.emplace_back([](Card& card) {
    card.press(true);
    card.clock();
    card.press(false);
    card.clocks(5);
    card.write(reg::kFault, field::kFaultEmergencyStop);
  });
  all.emplace_back([](Card& card) { card.begin_a_write(); });
  return all;
}

void send(Card& card, const driver::Command& command, std::uint8_t number) {
  std::vector<std::uint32_t> words;
  driver::encode(command, number, words);
  for (const std::uint32_t word : words) card.write(reg::kStream, word);
}

// Both axes run with the drives enabled and no delays; one event comes in clock `at` of a pulse.
unsigned one_course(const std::function<void(Card&)>& happens, unsigned at, Wishes& wish) {
  Card card(true);
  Pulses pulses;
  card.watch = [&pulses](unsigned step, unsigned dir) { pulses.look(step, dir); };
  for (const unsigned axis : {0U, 1U}) {
    card.write(reg::step_length(axis), kLength);
    card.write(reg::step_space(axis), 4);
  }
  card.write(reg::mode(1), 1);
  card.write(reg::kOutputRoles, 1);
  card.write(reg::kEnableAxes, 3);
  send(card, test::feed(4000, 2), 0);
  send(card, test::line(4000, {250, -125}), 1);
  while (pulses.begun(0) < 2 || !pulses.in_pulse()) card.clock();
  card.clocks(at);
  happens(card);
  card.clocks(200);
  for (const unsigned length : pulses.lengths)
    wish.that("length of a pulse", length != kLength && length != kShorter ? length : kLength, kLength);
  const auto made = static_cast<std::uint32_t>(pulses.begun(0));
  wish.that("position of axis 0", card.position(0), made);
  wish.that("position of axis 1", card.position(1), pulses.begun(1) - pulses.begun(2));
  return static_cast<unsigned>(pulses.lengths.size());
}

void in_every_clock_of_a_pulse() {
  Wishes wish(2);
  unsigned pulses = 0;
  unsigned courses = 0;
  for (const auto& happens : happenings()) {
    for (unsigned at = 0; at < kLength + 2; ++at, ++courses) pulses += one_course(happens, at, wish);
  }
  EXPECT_GT(pulses, 5 * courses);
}

TEST(PulseLength, WhateverHappensInEveryClockOfAPulse) { EXPECT_EQ(lockstep::judge(in_every_clock_of_a_pulse), ""); }

}  // namespace
