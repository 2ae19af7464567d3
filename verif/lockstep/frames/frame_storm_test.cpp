// The frame engine behind a bad link: bytes 10 clocks apart, every access judged by what the host has sent
// (tests/support/frame_storm.hpp). The model takes no part in it.
#include "frame_storm.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "byte_ports.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::lockstep {
namespace {

using test::FrameStorm;

class Bench {
 public:
  explicit Bench(std::uint64_t seed)
      : check_("frame_engine", seed),
        storm_(
            seed, [this](const frames::Bytes& bytes) { return bring(bytes); }, [this] { restart(); }, 20) {
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
  }

  void run(std::uint64_t frames) {
    try {
      storm_.run(frames);
    } catch (const std::logic_error& error) {
      throw Mismatch(error.what());
    }
  }
  const FrameStorm::Counts& counts() const { return storm_.counts(); }

 private:
  static constexpr unsigned kGap = 10;
  // Longer than the engine ever goes without a sign while it has something to do.
  static constexpr unsigned kQuiet = 40;

  frames::Bytes bring(const frames::Bytes& bytes) {
    reply_.clear();
    for (const std::uint8_t byte : bytes) {
      dut_->byte_i = static_cast<SData>(0x100U | byte);
      clock();
      dut_->byte_i = 0;
      for (unsigned i = 1; i < kGap; ++i) clock();
    }
    for (quiet_ = 0; quiet_ < kQuiet;) clock();
    return reply_;
  }
  void restart() {
    dut_->restart_i = 1;
    clock();
    dut_->restart_i = 0;
  }

  void clock() {
    ++quiet_;
    dut_->ready_i = 1;
    if (dut_->valid_o) {
      reply_.push_back(dut_->byte_o);
      quiet_ = 0;
    }
    if (dut_->access_o >> 47 != 0) {
      quiet_ = 0;
      const FrameStorm::Answer answer =
          storm_.access((dut_->access_o >> 46 & 1) != 0, static_cast<std::uint32_t>(dut_->access_o >> 32 & 0xFFF),
                        static_cast<std::uint32_t>(dut_->access_o));
      inner_.ask(1, answer.refused, answer.data);
    }
    const InnerPort::Answer answer = inner_.now();
    dut_->ack_i = answer.ack;
    dut_->error_i = answer.error;
    dut_->data_i = answer.data;
    dut_.clock();
  }

  Simulated<Vdut> dut_;
  Checker check_;
  FrameStorm storm_;
  InnerPort inner_;
  frames::Bytes reply_;
  unsigned quiet_ = 0;
};

class Storm : public testing::TestWithParam<int> {};

TEST_P(Storm, NothingRunsWronglyOrTwiceAndTheLinkRecovers) {
  const std::uint64_t seed = seed_from_environment(static_cast<std::uint64_t>(GetParam()));
  // Four of them: 10^6 frames, 10^7 in the long run.
  const std::uint64_t frames = std::min<std::uint64_t>(scaled(250'000), 2'500'000);
  EXPECT_EQ(judge([&] {
              Bench bench(seed);
              bench.run(frames);
              const FrameStorm::Counts& counts = bench.counts();
              EXPECT_GE(counts.frames, frames);
              EXPECT_GT(counts.requests, frames / 4);
              EXPECT_GT(counts.damaged, frames / 4);
              EXPECT_GT(counts.repeated, frames / 50);
              EXPECT_GT(counts.refused, frames / 100);
              EXPECT_GT(counts.connections, frames / 500);
            }),
            "");
}

INSTANTIATE_TEST_SUITE_P(Seeds, Storm, testing::Range(1, 5));

}  // namespace
}  // namespace trammel::lockstep
