// The frame engine behind a bad link: bytes 10 clocks apart; every access is checked against the host's requests
// (tests/support/frame_storm.hpp). The model is not used.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "storm_bench.hpp"

namespace trammel::lockstep {
namespace {

using test::FrameStorm;

class Bench {
 public:
  explicit Bench(std::uint64_t seed)
      : dice_(seed),
        storm_(
            seed, [this](const frames::Bytes& bytes) { return bring(bytes); }, [this] { restart(); }, 20) {
    dut_->byte_i = 0;
    dut_->restart_i = 0;
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
  }

  FrameStorm& storm() { return storm_; }

  // Bodies of random bytes with the length of a request without words, each with its end: only the CRC rejects them.
  // The link still works afterwards.
  void garbage(std::uint64_t frames) {
    for (std::uint64_t i = 0; i < frames; ++i) {
      frames::Bytes body{static_cast<std::uint8_t>(dice_.below(4) & 2U)};
      while (body.size() < frames::kHeaderBytes + frames::kCrcBytes) body.push_back(byte_of_no_meaning());
      body.push_back(frames::kEnd);
      for (const std::uint8_t byte : body) send(byte);
      if (signs_ != 0) throw Mismatch("random bytes were taken for a frame");
    }
    run_storm(storm_, 10);
  }

 private:
  static constexpr unsigned kGap = 10;
  // Longer than any pause of the engine while it has work to do.
  static constexpr unsigned kQuiet = 40;

  frames::Bytes bring(const frames::Bytes& bytes) {
    reply_.clear();
    for (const std::uint8_t byte : bytes) send(byte);
    for (quiet_ = 0; quiet_ < kQuiet;) clock();
    return reply_;
  }
  void send(std::uint8_t byte) {
    dut_->received_i = 1;
    dut_->byte_i = byte;
    clock();
    dut_->received_i = 0;
    for (unsigned i = 1; i < kGap; ++i) clock();
  }
  // Neither an end nor an escape, either of which would change the length.
  std::uint8_t byte_of_no_meaning() {
    for (;;) {
      const auto byte = static_cast<std::uint8_t>(dice_.below(256));
      if (byte != frames::kEnd && byte != frames::kEscape) return byte;
    }
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
      ++signs_;
    }
    if (serve_access(*dut_, inner_, storm_, [] { return 1U; })) {
      quiet_ = 0;
      ++signs_;
    }
    dut_.clock();
  }

  Simulated<Vdut> dut_;
  Dice dice_;
  FrameStorm storm_;
  InnerPort inner_;
  frames::Bytes reply_;
  unsigned quiet_ = 0;
  std::uint64_t signs_ = 0;  // signs of activity: accesses, clocks with a byte to send
};

class Storm : public testing::TestWithParam<int> {};

TEST_P(Storm, NothingRunsWronglyOrTwiceAndTheLinkRecovers) {
  const std::uint64_t seed = seed_from_environment(static_cast<std::uint64_t>(GetParam()));
  // Four such tests: 5 * 10^5 frames together, 10^7 in the long run.
  const std::uint64_t frames = std::min<std::uint64_t>(scaled(125'000), 2'500'000);
  EXPECT_EQ(judge([&] {
              Bench bench(seed);
              run_storm(bench.storm(), frames);
              const FrameStorm::Counts& counts = bench.storm().counts();
              EXPECT_GE(counts.frames, frames);
              EXPECT_GT(counts.requests, frames / 4);
              EXPECT_GT(counts.damaged, frames / 4);
              EXPECT_GT(counts.repeated, frames / 50);
              EXPECT_GT(counts.refused, frames / 100);
              EXPECT_GT(counts.connections, frames / 500);
            }),
            "");
}

// The probability that a random frame passes is 2^-32.
TEST(Garbage, TheCrcHoldsItOff) {
  const std::uint64_t frames = scaled(50'000);
  EXPECT_EQ(judge([&] {
              Bench bench(seed_from_environment(9));
              bench.garbage(frames);
              std::printf("%llu frames of random contents: the engine took 0, by chance %.1e\n",
                          static_cast<unsigned long long>(frames), std::ldexp(static_cast<double>(frames), -32));
            }),
            "");
}

INSTANTIATE_TEST_SUITE_P(Seeds, Storm, testing::Range(1, 5));

}  // namespace
}  // namespace trammel::lockstep
