// Errors that the CRC does not detect, for the lengths of frames: the table of the page.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "trammel/frames/frame.hpp"

namespace {

using namespace trammel::frames;

// The effect of a wrong bit on the register, by its distance from the end of the frame. It does not depend on the data.
std::vector<std::uint32_t> effects(std::size_t bits) {
  std::vector<std::uint32_t> effect{1};
  while (effect.size() < bits) {
    effect.push_back(effect.back() >> 1 ^ ((effect.back() & 1) != 0 ? 0xEDB88320U : 0));
  }
  return effect;
}

// The effects of all sets of `size` bits, each combined with `sum`.
template <class Take>
void sets(const std::vector<std::uint32_t>& effect, unsigned size, std::size_t from, std::uint32_t sum, Take& take) {
  if (size == 0) return take(sum);
  for (std::size_t i = from; i < effect.size(); ++i) sets(effect, size - 1, i + 1, sum ^ effect[i], take);
}

// True when every error of at most 2 * half + 1 bits is detected. This is so if all sets of up to `half` bits have
// different effects, and no set of half + 1 bits has one of these effects.
bool sees(std::size_t bytes, unsigned half) {
  const std::vector<std::uint32_t> effect = effects(8 * bytes);
  std::vector<std::uint32_t> small;
  auto keep = [&small](std::uint32_t sum) { small.push_back(sum); };
  for (unsigned size = 0; size <= half; ++size) sets(effect, size, 0, 0, keep);
  std::sort(small.begin(), small.end());
  if (std::adjacent_find(small.begin(), small.end()) != small.end()) return false;
  bool alike = false;
  auto look = [&](std::uint32_t sum) { alike = alike || std::binary_search(small.begin(), small.end(), sum); };
  sets(effect, half + 1, 0, 0, look);
  return !alike;
}

constexpr std::size_t kShortRequest = kHeaderBytes + kCrcBytes;
constexpr std::size_t kShortReply = kHeaderBytes + 4 * kStateWords + kCrcBytes;

TEST(CrcErrors, SevenWrongBitsAreSeenInARequestWithoutWords) { EXPECT_TRUE(sees(kShortRequest, 3)); }

TEST(CrcErrors, FiveWrongBitsAreSeenInAReplyWithoutWords) {
  EXPECT_TRUE(sees(kShortReply, 2));
  EXPECT_FALSE(sees(40, 2)) << "so the search can find one";
}

// Share of frames of `bytes` bytes with more than `seen` wrong bits and a matching CRC.
double let_through(unsigned bytes, unsigned seen, double bit_error_rate) {
  const double bits = 8.0 * bytes;
  double sum = 0;
  for (unsigned wrong = seen + 1; wrong < seen + 40; ++wrong) {
    const double ways = std::lgamma(bits + 1) - std::lgamma(wrong + 1.0) - std::lgamma(bits - wrong + 1);
    sum += std::exp(ways + wrong * std::log(bit_error_rate) + (bits - wrong) * std::log1p(-bit_error_rate));
  }
  return std::ldexp(sum, -32);
}

TEST(CrcErrors, ThePagesTable) {
  const auto rates = [](unsigned bytes, unsigned seen) {
    return fmt::format(" {} | {} | {:.0e} | {:.0e} | {:.0e} |", bytes, seen, let_through(bytes, seen, 1e-4),
                       let_through(bytes, seen, 1e-5), let_through(bytes, seen, 1e-6));
  };
  std::ifstream page(TRAMMEL_FRAMES_PAGE);
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  constexpr unsigned kLongestReply = kMaxReplyBody + kCrcBytes;
  for (const auto& [bytes, seen] : {std::pair<unsigned, unsigned>{kShortRequest, 7},
                                    {kShortReply, 5},
                                    {kShortRequest + 4 * kMaxWords, 4},
                                    {kLongestReply, 4}}) {
    EXPECT_NE(text.find(rates(bytes, seen)), std::string::npos) << rates(bytes, seen);
  }
}

}  // namespace
