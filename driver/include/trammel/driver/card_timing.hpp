// Timing of a card in clocks, as a planner and the one-shot lines need it. Constants come from the generated card map.
// Pure functions and plain data, thread-safe.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::driver {

// The parameters that determine the timing of a line on a card.
struct CardTiming {
  std::uint32_t clock_hz = 0;
  unsigned axes = 0;
  // Shortest time between two leading edges of an axis, clocks: shortest_pulse_period() of its settings.
  std::array<std::uint32_t, card_map::kMaxAxes> pulse_period{};
};

// Shortest time between two leading edges for the raw settings of an axis, clocks. The step shaper takes additional
// clocks to change from phase to phase, and a length of 0 counts as 1.
constexpr std::uint32_t shortest_pulse_period(std::uint32_t step_length, std::uint32_t step_space) {
  return (step_length == 0 ? 1 : step_length) + step_space + card_map::constant::kShaperTurnoverClocks;
}

// Clocks that the card takes to decode a line of `axes` axes, 1 .. 8: 20 for 4, 32 for 8.
constexpr std::uint32_t decode_clocks(unsigned axes) {
  return card_map::constant::kDecodeClocks + card_map::constant::kDecodeAxisClocks * axes;
}

// Smallest number of ticks of a line, at one tick per clock, at which the next line of `axes` axes (1 .. 8) follows
// without a gap: the decoding time plus two clocks, for start and hand-over.
constexpr std::uint32_t gap_free_ticks(unsigned axes) { return decode_clocks(axes) + 2; }

// The time base's full ratio, 2^-16: every clock is enabled.
inline constexpr std::uint32_t kFullRatio = 0x10000;

// Longest slew from ratio 0 to the full ratio, clocks.
inline constexpr std::uint64_t kSlowestSlew = std::uint64_t{card_map::constant::kSlewClocks}
                                              << card_map::constant::kSlewFractionBits;

// Interval between two polls of the card, clocks: 50 microseconds, at least 64 clocks.
std::uint64_t poll_interval(std::uint32_t clock_hz);

// ceil(time * clock_hz / 10^9): the only conversion from nanoseconds to card clocks. Throws ArgumentError, whose
// message starts with `what`, for a negative time or 2^63 clocks or more.
std::uint64_t clocks_of(std::chrono::nanoseconds time, std::uint32_t clock_hz, const char* what);

// ceil(clocks * 10^9 / clock_hz), saturated to the largest std::chrono::nanoseconds. clock_hz must not be 0.
std::chrono::nanoseconds time_of(std::uint64_t clocks, std::uint32_t clock_hz);

// Clocks of a step time of an axis (`what` names it: step length ...). Throws ArgumentError, which names value and
// limit, unless the result fits the card's register: 0 .. 65535 clocks.
std::uint32_t step_time_clocks(std::chrono::nanoseconds time, std::uint32_t clock_hz, const char* what);

}  // namespace trammel::driver
