// Random paths of each engine for the core, and the number of path ticks that their feed ticks make.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "chord_arc.hpp"
#include "core_bench.hpp"

namespace trammel::testing {

inline constexpr std::uint64_t kEvery16 = std::uint64_t{1} << 60;  // rate: a tick in 16 clocks

// A path that lasts `ticks` feed ticks.
struct Path {
  std::uint64_t ticks = 0;
  std::uint64_t prescale = 0;  // 2^-40 path ticks per feed tick
  std::function<bool(CoreBench&)> send;

  std::uint64_t path_ticks(std::uint64_t feed_ticks) const {
    return static_cast<std::uint64_t>((kOnePulse / 2 + int128{feed_ticks} * static_cast<std::int64_t>(prescale)) >> 40);
  }
};

inline model::CardConfig all_engines() {
  model::CardConfig config;
  config.engines |= card_map::engines::kArcGenerator | card_map::engines::kAccumulator8;
  return config;
}

inline Path random_line(std::mt19937_64& random) {
  const std::uint64_t ticks = 200 + random() % 2000;
  std::vector<std::int64_t> increments;
  for (unsigned n = 0; n < 4; ++n)
    increments.push_back(static_cast<std::int64_t>(random() % kOnePulse) - kOnePulse / 2);
  return {ticks, kOnePulse, [=](CoreBench& bench) { return bench.line(ticks, increments); }};
}

inline Path random_circle(std::mt19937_64& random, bool eight) {
  const auto r = static_cast<std::int64_t>(2 + random() % 30);
  const std::uint64_t ticks = 8 * static_cast<std::uint64_t>(r) * (1 + random() % 20);
  const bool clockwise = random() % 2 != 0;
  const std::int64_t made = eight ? CoreBench::steps_in_eight(r) : 8 * r;
  const std::uint64_t prescale = (static_cast<std::uint64_t>(made) * kOnePulse + ticks / 2) / ticks;
  return {ticks, prescale, [=](CoreBench& bench) { return bench.circle(ticks, r, clockwise, eight); }};
}

inline Path random_chords(std::mt19937_64& random) {
  model::ArcPoints arc;
  const auto r = static_cast<std::int64_t>(20 + random() % 60);
  arc.start = {r, 0};
  arc.end = {0, -r};
  arc.clockwise = random() % 2 != 0;
  const driver::ArcChordCommand command = model::prepare_command(arc, {0, 0, 40});
  return {command.ticks, command.prescale, [=](CoreBench& bench) {
            std::vector<std::uint32_t> words(driver::kMaxCommandWords);
            words.resize(driver::encode(command, bench.number++, words.data()));
            return bench.send(words);
          }};
}

}  // namespace trammel::testing
