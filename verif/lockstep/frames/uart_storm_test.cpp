// Serial port and frame engine behind a bad line, at the pins: 8 to 25 clocks per bit, a new rate with each break.
// Every access is checked against the host's requests.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <optional>

#include "storm_bench.hpp"
#include "uart_line.hpp"

namespace trammel::lockstep {
namespace {

using test::FrameStorm;

class Bench {
 public:
  explicit Bench(std::uint64_t seed)
      : dice_(seed),
        storm_(
            seed, [this](const frames::Bytes& bytes) { return bring(bytes); }, [this] { restart(); }, 20) {
    dut_->rst_i = 1;
    dut_->rx_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
    restart();
  }

  FrameStorm& storm() { return storm_; }

 private:
  frames::Bytes bring(const frames::Bytes& bytes) {
    reply_.clear();
    for (const std::uint8_t byte : bytes) line_.send(byte);
    while (line_.busy()) clock();
    const auto longest = static_cast<unsigned>(12 * line_.bit() + 60);
    for (quiet_ = 0; quiet_ < longest;) clock();
    return reply_;
  }
  // A new rate: sometimes 25 clocks per bit (4 Mbaud at 100 MHz), otherwise 8 to 25.
  void restart() {
    line_.set_period(dice_.chance(4) ? 200 : 64 + dice_.below(1360) / 10.0);
    line_.break_line((1 << TRAMMEL_BREAK_BITS) + 10);
    while (line_.busy()) clock();
  }

  void clock() {
    ++quiet_;
    dut_->rx_i = line_.next();
    if (const std::optional<std::uint8_t> byte = line_.take(dut_->tx_o != 0)) {
      reply_.push_back(*byte);
      quiet_ = 0;
    }
    if (serve_access(*dut_, inner_, storm_, [this] { return 1 + dice_.below(8); })) quiet_ = 0;
    dut_.clock();
  }

  Simulated<Vdut> dut_;
  Dice dice_;
  UartLine line_;
  InnerPort inner_;
  frames::Bytes reply_;
  unsigned quiet_ = 0;
  FrameStorm storm_;
};

TEST(UartStorm, NothingRunsWronglyOrTwiceAndTheLinkRecovers) {
  EXPECT_EQ(judge([] { storm_at_pins<Bench>(7, 500); }), "");
}

}  // namespace
}  // namespace trammel::lockstep
