// The endpoint behind a bad link: with any damage to frames, each request runs once and completely, or not at all.
#include "frame_storm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "trammel/frames/endpoint.hpp"

namespace {

using namespace trammel::frames;
using trammel::test::FrameStorm;

// 10^6 frames, or 10^7 in the long run.
std::uint64_t storm_length() { return std::getenv("TRAMMEL_LONG") == nullptr ? 1'000'000 : 10'000'000; }

enum class Flaw { None, AccessTwice, WordLost, RepeatRuns };

FrameStorm::Counts storm(std::uint64_t seed, std::uint64_t frames, Flaw flaw = Flaw::None) {
  FrameStorm* host = nullptr;
  std::uint64_t writes = 0;
  Endpoint endpoint([&](bool write, std::uint32_t address, std::uint32_t data) {
    const bool flawed = write && ++writes % 1000 == 0;
    if (flawed && flaw == Flaw::WordLost) return Endpoint::Answer{};
    const FrameStorm::Answer answer = host->access(write, address, data);
    if (flawed && flaw == Flaw::AccessTwice) host->access(write, address, data);
    return Endpoint::Answer{answer.refused, answer.data};
  });
  // A card that forgets that it has already run a request.
  std::optional<Endpoint> before;
  const auto card = [&](const Bytes& bytes) {
    Bytes out;
    if (flaw == Flaw::RepeatRuns && writes % 1000 == 0) before = endpoint;
    for (const std::uint8_t byte : bytes) endpoint.take(byte, out);
    if (flaw == Flaw::RepeatRuns && writes % 1000 == 999) endpoint = *before;
    return out;
  };
  FrameStorm frame_storm(seed, card, [&] { endpoint.connect(); });
  host = &frame_storm;
  frame_storm.run(frames);
  std::printf("%s\n", frame_storm.text().c_str());
  return frame_storm.counts();
}

TEST(FrameStorm, NothingRunsWronglyOrTwiceAndTheLinkRecovers) {
  const std::uint64_t frames = storm_length();
  const FrameStorm::Counts counts = storm(1, frames);
  EXPECT_GE(counts.frames, frames);
  // Enough events of each kind for a meaningful test.
  EXPECT_GT(counts.requests, frames / 4);
  EXPECT_GT(counts.damaged, frames / 4);
  EXPECT_GT(counts.repeated, frames / 50);
  EXPECT_GT(counts.refused, frames / 100);
  EXPECT_GT(counts.lost_replies, frames / 50);
  EXPECT_GT(counts.connections, frames / 500);
}

TEST(FrameStorm, FindsACardWithAFlaw) {
  for (const Flaw flaw : {Flaw::AccessTwice, Flaw::WordLost, Flaw::RepeatRuns}) {
    EXPECT_THROW(storm(2, 100'000, flaw), std::logic_error) << static_cast<int>(flaw);
  }
}

// Frames of the right length with random contents. A CRC passes by chance once in 2^32, which is too rare for this
// test. Each half of 16 bits also passes by chance, and must do so at the expected rate.
TEST(Garbage, PassesTheCrcAsOftenAsChanceSays) {
  std::mt19937_64 random(3);
  const unsigned scale = std::getenv("TRAMMEL_LONG") == nullptr ? 1 : 16;
  const unsigned frames = scale << 22;
  unsigned low = 0;
  unsigned high = 0;
  unsigned both = 0;
  for (unsigned i = 0; i < frames; ++i) {
    Crc32 crc;
    for (std::size_t n = 0; n < kHeaderBytes + kCrcBytes; n += 8) {
      std::uint64_t word = random();
      for (unsigned byte = 0; byte < 8; ++byte, word >>= 8) crc.add(static_cast<std::uint8_t>(word));
    }
    const std::uint32_t difference = crc.state() ^ Crc32::kResidue;
    low += (difference & 0xFFFF) == 0 ? 1 : 0;
    high += difference >> 16 == 0 ? 1 : 0;
    both += difference == 0 ? 1 : 0;
  }
  // 64 of each are expected (1,024 in the long run), within five standard deviations.
  const double due = 64.0 * scale;
  EXPECT_NEAR(low, due, 5 * std::sqrt(due));
  EXPECT_NEAR(high, due, 5 * std::sqrt(due));
  EXPECT_EQ(both, 0U);  // 0.001 are expected, or 0.016 in the long run
  std::printf(
      "%u frames of random contents: lower half of the CRC good in %u, upper half in %u (2^-16 of them: %.0f), both in "
      "%u (2^-32: %.3f)\n",
      frames, low, high, due, both, std::ldexp(frames, -32));
}

// Noise with uniformly distributed bytes, which contains END bytes: no access is made, and the next frame works.
TEST(Garbage, IsNoFrame) {
  std::mt19937_64 random(4);
  std::uint64_t accesses = 0;
  Endpoint endpoint([&](bool, std::uint32_t, std::uint32_t) {
    ++accesses;
    return Endpoint::Answer{};
  });
  Bytes out;
  constexpr std::uint64_t kBytes = 40'000'000;
  for (std::uint64_t i = 0; i < kBytes; i += 8) {
    std::uint64_t word = random();
    for (unsigned byte = 0; byte < 8; ++byte, word >>= 8) endpoint.take(static_cast<std::uint8_t>(word), out);
  }
  EXPECT_EQ(accesses, 0U);
  EXPECT_TRUE(out.empty());
  EXPECT_GT(endpoint.dropped(), kBytes / 300);
  Bytes stream{kEnd};
  append_request(stream, Request());
  for (const std::uint8_t byte : stream) endpoint.take(byte, out);
  EXPECT_EQ(accesses, kStateWords);
}

}  // namespace
