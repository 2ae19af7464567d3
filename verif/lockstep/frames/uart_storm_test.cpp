// Serial port and frame engine behind a bad line, at the pins: 8 to 25 clocks a bit, a new rate with each break; every
// access is judged by what the host has sent.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "byte_ports.hpp"
#include "frame_storm.hpp"
#include "trammel/sim/lockstep.hpp"
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

  void run(std::uint64_t frames) {
    try {
      storm_.run(frames);
      std::printf("%s\n", storm_.text().c_str());
    } catch (const std::logic_error& error) {
      throw Mismatch(error.what());
    }
  }
  const FrameStorm::Counts& counts() const { return storm_.counts(); }

 private:
  frames::Bytes bring(const frames::Bytes& bytes) {
    reply_.clear();
    for (const std::uint8_t byte : bytes) line_.send(byte);
    while (line_.busy()) clock();
    const auto longest = static_cast<unsigned>(12 * line_.bit() + 60);
    for (quiet_ = 0; quiet_ < longest;) clock();
    return reply_;
  }
  // A new rate: from 25 clocks a bit, 4 Mbaud at 100 MHz, to a third of that.
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
    if (dut_->access_o >> 47 != 0) {
      quiet_ = 0;
      const FrameStorm::Answer answer =
          storm_.access((dut_->access_o >> 46 & 1) != 0, static_cast<std::uint32_t>(dut_->access_o >> 32 & 0xFFF),
                        static_cast<std::uint32_t>(dut_->access_o));
      inner_.ask(1 + dice_.below(8), answer.refused, answer.data);
    }
    const InnerPort::Answer answer = inner_.now();
    dut_->ack_i = answer.ack;
    dut_->error_i = answer.error;
    dut_->data_i = answer.data;
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
  const std::uint64_t seed = seed_from_environment(7);
  const std::uint64_t frames = std::min<std::uint64_t>(scaled(10'000), 100'000);
  EXPECT_EQ(judge([&] {
              Bench bench(seed);
              bench.run(frames);
              EXPECT_GE(bench.counts().frames, frames);
              EXPECT_GT(bench.counts().requests, frames / 4);
              EXPECT_GT(bench.counts().damaged, frames / 4);
              EXPECT_GT(bench.counts().connections, frames / 500);
            }),
            "");
}

}  // namespace
}  // namespace trammel::lockstep
