// The driver and the runner of programs, unchanged, over the UART pins of the HX8K board's top: the whole of it as it
// is synthesised, but for what stands for PLL and pins. What is judged are the steps at the pins.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/lockstep.hpp"
#include "uart_link.hpp"

namespace trammel::lockstep {
namespace {

using namespace std::chrono_literals;

constexpr unsigned kAxes = 4;
constexpr std::uint64_t kClock = 60'000'000;
constexpr double kBreak = 1 << 20 | 1 << 10;  // clocks

// The board with a host's serial line at its pins and a motor at each pair of pins.
class Board {
 public:
  Board() {
    dut_->input_i = 0;
    dut_->rx_i = 1;
    // The PLL's lock and the reset after it.
    for (unsigned i = 0; i < 2000; ++i) clock();
  }
  void clock() {
    dut_->rx_i = uart.line.next();
    dut_.clock();
    ++cycles_;
    uart.take(dut_->tx_o);
    outputs_seen_ |= dut_->output_o;
    const std::uint32_t rises = dut_->step_o & ~step_;
    step_ = dut_->step_o;
    if (rises == 0) return;
    for (unsigned axis = 0; axis < kAxes; ++axis) {
      if ((rises >> axis & 1) == 0) continue;
      motor_.at(axis) += (dut_->dir_o >> axis & 1) != 0 ? -1 : 1;
    }
  }
  std::uint64_t cycles() const { return cycles_; }
  std::array<std::int64_t, kAxes> motors() const { return motor_; }
  std::uint32_t outputs_seen() const { return outputs_seen_; }  // those that were ever high

  UartEnd uart;

 private:
  Simulated<Vdut> dut_;
  std::uint64_t cycles_ = 0;
  std::uint32_t step_ = 0;
  std::uint32_t outputs_seen_ = 0;
  std::array<std::int64_t, kAxes> motor_{};
};

class BoardTest : public testing::Test {
 protected:
  driver::Card& connect(double baud) {
    const UartLink::Rate rate{kClock, baud, kBreak};
    link_ = std::make_unique<UartLink>(
        board_.uart, rate, [this] { board_.clock(); }, [this] { return board_.cycles(); });
    bus_ = std::make_unique<driver::FrameBus>(*link_);
    card_ = std::make_unique<driver::Card>(driver::Card::open(*bus_));
    return *card_;
  }
  Board board_;
  std::unique_ptr<UartLink> link_;
  std::unique_ptr<driver::FrameBus> bus_;
  std::unique_ptr<driver::Card> card_;
};

TEST_F(BoardTest, SaysWhoItIsAt115200Baud) {
  driver::Card& card = connect(115'200);
  EXPECT_EQ(card.identification().axes, kAxes);
  EXPECT_EQ(card.identification().clock_hz, kClock);
  const driver::Build build = card.build();
  EXPECT_EQ(build.id, 0x1234ABCDU);
  EXPECT_TRUE(build.dirty);
  EXPECT_EQ(build.board, 1U);
  EXPECT_EQ(bus_->counts().sent_again, 0U);
}

TEST_F(BoardTest, MakesALineAndStreamsAProgramAt2Megabaud) {
  driver::Card& card = connect(2e6);
  driver::run_line(card, driver::plan_line(card.timing(), {200, -100, 50, 7}, 5ms));
  EXPECT_EQ(board_.motors(), (std::array<std::int64_t, kAxes>{200, -100, 50, 7}));

  machine::Machine machine = machine::default_machine();
  for (const char* const axis : {"x", "y", "z"}) {
    machine::apply_override(machine, "axis." + std::string(axis) + ".max_velocity=200");
    machine::apply_override(machine, "axis." + std::string(axis) + ".max_acceleration=20000");
  }
  machine::apply_override(machine, "outputs.m3=2");
  // Lines, an arc, an output.
  const auto text = std::make_shared<const std::string>(
      "G21 G90 G17\nM3\nG1 X1 Y0.5 F12000\nG1 X1.5 Y0.25\nG2 X2.5 Y0.25 I0.5\nG1 X3 Y-0.5 Z0.25\nM2\n");
  const run::ProgramLines lines = [text] { return std::make_unique<gcode::TextLines>(*text, "board.ngc"); };
  run::Runner runner(lines, machine, planner::limits_of(card.identification()));
  runner.plan();
  const run::Outcome outcome = runner.run(card);
  EXPECT_EQ(outcome.counted, (std::vector<std::int64_t>{240, -40, 20, 0}));
  EXPECT_EQ(board_.motors(), (std::array<std::int64_t, kAxes>{440, -140, 70, 7}));
  EXPECT_EQ(board_.outputs_seen(), 1U << 2);
  EXPECT_EQ(outcome.under_runs.value_or(0), 0U);
  EXPECT_EQ(bus_->counts().sent_again, 0U);
}

}  // namespace
}  // namespace trammel::lockstep
