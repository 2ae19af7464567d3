// Commands that the tests of the stream send.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

inline LineCommand line_of(std::uint64_t ticks, std::int64_t pulses = 0) {
  LineCommand line;
  line.ticks = ticks;
  line.mask = 1;
  line.increment[0] = pulses * (std::int64_t{1} << 40) / static_cast<std::int64_t>(ticks);
  return line;
}

// A feed piece with one tick every 16 clocks, unless another rate is given.
inline FeedCommand feed_of(std::uint64_t ticks, std::uint64_t rate = std::uint64_t{1} << 60) {
  FeedCommand feed;
  feed.ticks = ticks;
  feed.rate = rate;
  return feed;
}

inline std::vector<std::uint32_t> words_of(const std::vector<Command>& commands, std::uint8_t number) {
  std::vector<std::uint32_t> words;
  for (const Command& command : commands) {
    encode(command, number++, words);
  }
  return words;
}

}  // namespace trammel::driver
