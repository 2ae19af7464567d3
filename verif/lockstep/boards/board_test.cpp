// A board's top, or its card without the PLL, around a stand-in card that only shows its pins. Checks when the reset
// ends, the levels of the pins before that, and the connection of each signal to its pin.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <type_traits>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

// Masks of all pins of a kind.
constexpr std::uint32_t kAxes = (1U << TRAMMEL_AXES) - 1;
constexpr std::uint32_t kInputs = (1U << TRAMMEL_INPUTS) - 1;
constexpr std::uint32_t kOutputs = (1U << TRAMMEL_OUTPUTS) - 1;
constexpr std::uint32_t kResetClocks = (1U << TRAMMEL_RESET_BITS) + 2;
constexpr std::uint64_t kWho = std::uint64_t{TRAMMEL_BOARD_ID ^ 0x78U} << 32 | TRAMMEL_CLOCK_HZ;

// The levels, a bit per pin.
struct Levels {
  std::uint32_t step = TRAMMEL_STEP_IDLE;
  std::uint32_t dir = TRAMMEL_DIR_IDLE;
  std::uint32_t output = TRAMMEL_OUTPUT_IDLE;
};

// The rules of the board. Reset lasts from the loss of the lock until kResetClocks clocks after it is back. The
// stand-in card's pins follow its inputs one clock later, and the board's STEP and DIR follow the card's after one
// more clock. The board's outputs are the card's, and idle in reset; both without a clock.
class Board {
 public:
  void lose_lock() {
    since_ = 0;
    if (TRAMMEL_PINS_AT_ONCE) pins_ = Levels();
  }
  void clock(bool locked, std::uint32_t inputs, bool rx) {
    const bool reset = since_ < kResetClocks;
    pins_ = reset ? Levels() : card_;
    const std::uint32_t output = (rx ? kOutputs : 0U) ^ inputs ^ inputs >> TRAMMEL_OUTPUTS;
    card_ = reset ? Levels() : Levels{inputs & kAxes, ~inputs & kAxes, output & kOutputs};
    told_ = reset ? kWho : told_ << 1 | std::uint64_t{rx};
    if (locked) ++since_;
  }
  void stop(bool pressed) { stop_ = pressed; }
  Levels pins() const {
    Levels now = pins_;
    now.output = since_ < kResetClocks ? Levels().output : card_.output ^ (stop_ ? kOutputs : 0U);
    return now;
  }
  bool tx() const { return (told_ >> 63) != 0; }

 private:
  std::uint64_t since_ = 0;  // clocks since the lock came back
  Levels pins_;
  Levels card_;
  bool stop_ = false;
  std::uint64_t told_ = 0;
};

class BoardUnderTest {
 public:
  explicit BoardUnderTest(std::uint64_t seed) : check_("board", seed), dice_(seed) {}

  void clock() {
    const auto inputs = static_cast<std::uint16_t>(dice_.below(kInputs + 1));
    const bool rx = dice_.chance(2);
    set_lock();
    dut_->input_i = static_cast<std::decay_t<decltype(dut_->input_i)>>(inputs);
    dut_->rx_i = rx;
    dut_.clock();
    board_.clock(locked_, inputs, rx);
    check_.next_cycle();
    compare();
    check_.compare("tx_o", dut_->tx_o, board_.tx());
    if (dice_.chance(4)) press();
#ifdef TRAMMEL_STANDS_HIGH
    check_.compare("stands high", dut_->TRAMMEL_STANDS_HIGH, 1);
#endif
  }
  const Checker& check() const { return check_; }

 private:
#ifdef TRAMMEL_LOCK_IS_AN_INPUT
  // The lock is lost from time to time, between clocks, and sometimes before the previous reset is over.
  void set_lock() {
    const bool before = locked_;
    locked_ = locked_ ? !dice_.chance(dice_.chance(2) ? 3 * kResetClocks : kResetClocks) : dice_.chance(4);
    dut_->locked_i = locked_;
    dut_->eval();
    if (!before || locked_) return;
    check_.event("lock lost");
    board_.lose_lock();
    compare();
  }
#else
  // The stand-in for the PLL locks after eight clocks.
  void set_lock() { locked_ = check_.cycles() >= 8; }
#endif
  // Presses or releases the emergency stop between clocks.
  void press() {
    stop_ = !stop_;
    dut_->emergency_stop_i = stop_;
    dut_->eval();
    board_.stop(stop_);
    compare();
  }
  void compare() {
    check_.compare("step_o", dut_->step_o, board_.pins().step);
    check_.compare("dir_o", dut_->dir_o, board_.pins().dir);
    check_.compare("output_o", dut_->output_o, board_.pins().output);
  }

  Simulated<Vdut> dut_{kZeros};  // the board is in reset from configuration on
  Checker check_;
  Dice dice_;
  Board board_;
  bool locked_ = false;
  bool stop_ = false;
};

void random_pins() {
  BoardUnderTest board(seed_from_environment(1));
  const std::uint64_t clocks = scaled(20 * kResetClocks + 2000);
  for (std::uint64_t i = 0; i < clocks; ++i) board.clock();
  EXPECT_GE(board.check().comparisons(), 4 * clocks);
}

TEST(Board, ResetAndPinsAreThoseOfItsRules) { EXPECT_EQ(judge(random_pins), ""); }

}  // namespace
}  // namespace trammel::lockstep
