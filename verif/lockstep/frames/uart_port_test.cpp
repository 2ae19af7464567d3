// Lockstep of the serial port: breaks, baud rates that can and cannot be measured, bytes in both directions,
// glitches, bytes without a stop bit, resets at any clock.
#include "trammel/model/uart_port.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "uart_line.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

using model::UartPort;

constexpr unsigned kBreakBits = TRAMMEL_BREAK_BITS;
constexpr std::uint64_t kComparedSignals = 4;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("uart_port", seed), dice_(seed), model_(kBreakBits) { reset(); }

  UartLine& line() { return line_; }
  Dice& dice() { return dice_; }

  void clock() {
    UartPort::Inputs in;
    in.rx = line_.next() != (dice_.chance(glitch_));
    in.valid = offer_ && dice_.chance(offer_);
    in.byte = static_cast<std::uint8_t>(dice_.draw());
    sent_ += in.valid && model_.outputs().ready ? 1U : 0U;
    dut_->rx_i = in.rx;
    dut_->valid_i = in.valid;
    dut_->byte_i = in.byte;
    dut_.clock();
    model_.clock(in);
    check_.next_cycle();
    compare();
  }
  void clocks(std::uint64_t n) {
    for (std::uint64_t i = 0; i < n; ++i) clock();
  }
  // Runs until the line has sent everything.
  void drain() {
    while (line_.busy()) clock();
  }

  // One clock of reset, with random other inputs.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    dut_->rx_i = dice_.chance(2);
    dut_->valid_i = dice_.chance(2);
    dut_.clock();
    dut_->rst_i = 0;
    model_.reset();
    check_.next_cycle();
    compare();
    line_.clear();
  }

  // A glitch in one of `glitch` clocks; a byte is offered to the line in one of `offer` clocks, 0: never.
  void disturb(unsigned glitch, unsigned offer) {
    glitch_ = glitch;
    offer_ = offer;
  }

  Checker& check() { return check_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + received_; }
  std::uint64_t received() const { return received_; }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t breaks() const { return breaks_; }
  std::uint32_t period() const { return model_.period(); }

 private:
  void compare() {
    const UartPort::Outputs& out = model_.outputs();
    check_.compare("tx_o", dut_->tx_o, out.tx);
    check_.compare("restart_o", dut_->restart_o, out.restart);
    check_.compare("ready_o", dut_->ready_o, out.ready);
    check_.compare("received_o", dut_->received_o, out.byte_valid);
    breaks_ += out.restart ? 1U : 0U;
    if (!out.byte_valid) return;
    ++received_;
    check_.compare("byte_o", dut_->byte_o, out.byte);
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  UartPort model_;
  UartLine line_;
  unsigned glitch_ = ~0U;
  unsigned offer_ = 4;
  std::uint64_t received_ = 0;
  std::uint64_t sent_ = 0;
  std::uint64_t breaks_ = 0;
};

constexpr double kBreak = 1 << kBreakBits;

void bytes_at(Bench& bench, double period, unsigned count) {
  bench.line().set_period(period);
  bench.line().break_line(kBreak + 8 + bench.dice().below(50));
  for (unsigned i = 0; i < count; ++i) {
    bench.line().send(static_cast<std::uint8_t>(bench.dice().draw()));
    if (bench.dice().chance(3)) bench.line().hold(true, bench.dice().below(30) / 10.0);
    if (bench.dice().chance(20)) bench.line().hold(false, bench.dice().below(120) / 10.0);
  }
  bench.drain();
}

void random_lines() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  const std::uint64_t length = scaled(400);
  for (std::uint64_t i = 0; i < length; ++i) {
    Dice& dice = bench.dice();
    bench.disturb(dice.chance(3) ? 20 + dice.below(2000) : ~0U, dice.below(8));
    // Rates from too fast to be accepted; 9 bits must be shorter than a break.
    const double most = dice.chance(8) ? 2000 : 300;
    if (dice.chance(6)) bytes_at(bench, 8 + dice.below(20), 1);
    bytes_at(bench, 30 + dice.below(1000) / 1000.0 * most, 20);
    if (dice.chance(4)) bench.clocks(dice.below(200));
    if (dice.chance(6)) bench.reset();
    if (dice.chance(3)) {
      // A reset during a measurement, after which the line continues.
      bench.line().set_period(100);
      bench.line().break_line(kBreak + 8);
      bench.clocks((1 << kBreakBits) + 40 + dice.below(120));
      bench.reset();
      for (unsigned sent = 0; sent < 3; ++sent) bench.line().send(0x55);
      bench.drain();
    }
    if (bench.period() != 0 && bench.period() < 300 && dice.chance(2)) {
      // A reset at a random clock of a byte.
      bench.line().set_period(bench.period());
      bench.line().send(static_cast<std::uint8_t>(dice.draw()));
      bench.clocks(dice.chance(2) ? dice.below(400) : bench.period() * 76 / 64 + dice.below(8));
      bench.reset();
    }
    if (dice.chance(6)) {
      // A break of twice the length counts as one; a reset within a break, or just as it is detected, ends it.
      bench.line().hold(false, 8 * 2.2 * kBreak / 100);
      if (dice.chance(2)) bench.drain();
      bench.clocks(dice.chance(4) ? dice.below(1 << kBreakBits) : (1 << kBreakBits) - 4 + dice.below(12));
      if (dice.chance(2)) bench.reset();
    }
    if (dice.chance(6)) {
      bench.line().hold(false, 40);  // too short for a break, or a break without its byte
      bench.drain();
    }
    if (dice.chance(6)) {
      bytes_at(bench, 100, 3);
      bench.line().clear();  // the line goes high in the middle of a byte or break
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.received(), length * 8);
  EXPECT_GT(bench.sent(), length * 8);
  EXPECT_GT(bench.breaks(), length);
}

// A rate near the end of the counter, one beyond it, and a break that is one clock too short.
void slow_lines() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  bytes_at(bench, 900'000.3, 2);
  EXPECT_NEAR(bench.period(), 900'000, 1);
  EXPECT_GE(bench.received(), 1U);
  EXPECT_GE(bench.sent(), 2U);
  bytes_at(bench, 1'048'574, 1);
  EXPECT_EQ(bench.period(), 1'048'574U);
  for (const double period : {1'048'575.0, 1'048'577.0, 1'100'000.0}) {
    bytes_at(bench, period, 1);
    EXPECT_EQ(bench.period(), 0U);
  }
  bytes_at(bench, 64, 1);
  EXPECT_EQ(bench.period(), 64U);
  bench.line().break_line(kBreak - 1);
  bench.drain();
  EXPECT_EQ(bench.period(), 64U);
  bytes_at(bench, 63, 1);
  EXPECT_EQ(bench.period(), 0U);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

TEST(UartPort, Lines) { EXPECT_EQ(judge(kBreakBits < 16 ? random_lines : slow_lines), ""); }

}  // namespace
}  // namespace trammel::lockstep
