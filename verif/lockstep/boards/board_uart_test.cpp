// A whole board behind its UART, see whole_board.hpp.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <type_traits>

#include "trammel/sim/lockstep.hpp"
#include "whole_board.hpp"

namespace trammel::lockstep {
namespace {

class Top final : public BoardTop {
 public:
  Top() {
    dut_->input_i = static_cast<std::decay_t<decltype(dut_->input_i)>>(kInputLevels & ((1U << TRAMMEL_INPUTS) - 1));
    dut_->emergency_stop_i = 0;
  }
  Pins clock(bool rx) override {
    dut_->rx_i = rx;
    dut_.clock();
    return {dut_->tx_o != 0, dut_->step_o, dut_->dir_o, dut_->output_o};
  }
  void press(bool pressed) override { dut_->emergency_stop_i = pressed; }

 private:
  Simulated<Vdut> dut_{kZeros};  // the board is in reset from configuration on
};

std::string over_uart(void (*scenario)(BoardTop&, const BoardFacts&)) {
  return judge([scenario] {
    Top top;
    scenario(top, {TRAMMEL_BOARD, TRAMMEL_BOARD_ID, TRAMMEL_CLOCK_HZ, TRAMMEL_AXES, TRAMMEL_INPUTS, TRAMMEL_OUTPUTS,
                   TRAMMEL_ARC_GENERATOR != 0, TRAMMEL_BAUD});
  });
}

TEST(BoardTest, StreamsAndHolds) { EXPECT_EQ(over_uart(streams_and_holds), ""); }
TEST(BoardTest, ObeysCommandsAtTheHighestRate) { EXPECT_EQ(over_uart(obeys_commands), ""); }

}  // namespace
}  // namespace trammel::lockstep
