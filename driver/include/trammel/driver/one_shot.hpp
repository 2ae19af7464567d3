// One-shot lines: the host computes frequency and pulse count of every axis once and writes them in one block. The
// pulse generators then make the line without further commands.
//
// Source: Zeng, Zhang & Huang, "A New Linear Interpolation Algorithm", (5)-(8): v_y = v (y_e - y_s), v_x = v (x_e -
// x_s), p_y = y_e - y_s, p_x = x_e - x_s, with v in lines per second, that is 1 / duration. Here for up to 8 axes: a
// line of N clocks has FREQUENCY = round(|p| * 2^40 / N), in 2^-40 pulses per clock, and COUNT = |p|. The phase starts
// at one half, so after k clocks floor(1/2 + k * FREQUENCY / 2^40) pulses are made, and after N < 2^40 clocks exactly
// |p|.
//
// All arithmetic is exact (integers). Durations and speeds are those at time base ratio 1; a lower ratio stretches the
// line in time and keeps its path. Planning is pure and thread-safe; functions that take a Card are as thread-safe as
// the card.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Pulses from start to end by axis index; each within +-2^62.
using Displacement = std::array<std::int64_t, card_map::kMaxAxes>;

// Speed along the path: `pulses` per `seconds`, both at least 1. The length of the path is sqrt(sum p^2) pulses.
struct PathSpeed {
  std::uint64_t pulses = 0;
  std::uint32_t seconds = 1;
};

enum class LimitPolicy {
  kRefuse,  // a line too fast for a limit throws ArgumentError
  kSlow,    // the line gets the shortest duration, in whole clocks, that keeps all limits
};

// In addition, the card's own limit applies: one pulse per axis in step length + step space clocks.
struct LineLimits {
  std::array<std::uint64_t, card_map::kMaxAxes> max_velocity{};  // by axis, pulses/s; 0: the card's own limit only
  LimitPolicy policy = LimitPolicy::kRefuse;
};

// Words of the block write that starts a line on a card with `axes` axes: the slots of its axes, LENGTH and START.
constexpr std::size_t one_shot_words(unsigned axes) {
  return (card_map::reg::kStart - card_map::reg::frequency_lo(axes - 1)) / 4 + 1;
}
inline constexpr std::size_t kOneShotWords = one_shot_words(card_map::kMaxAxes);

// A line, or a part of one, that the card makes in one run.
struct OneShotPart {
  std::uint64_t length = 0;                                   // N, clocks, 1 .. 2^40 - 1
  std::array<std::uint64_t, card_map::kMaxAxes> frequency{};  // 2^-40 pulses per clock, 0 .. 2^40
  std::array<std::uint32_t, card_map::kMaxAxes> count{};      // pulses
  std::uint8_t mask = 0;                                      // bit n: axis n takes part
  std::uint8_t negative = 0;                                  // bit n: axis n steps in the negative direction

  // The registers FREQUENCY_LO[7] .. START by rising address; the slots of the axes come in descending order of axes.
  std::array<std::uint32_t, kOneShotWords> words() const;
};

// A line divided into parts of equal length, which the card runs one after another. A line has one part unless it
// exceeds the card's counters (COUNT 32 bits, LENGTH 40). Part i runs from the pulse nearest to i / size() of the line
// to the pulse nearest to (i + 1) / size(), so the pulses of an axis differ by at most one between parts.
class OneShotPlan {
 public:
  std::size_t size() const { return parts_; }
  // Precondition: index < size().
  OneShotPart part(std::size_t index) const;

  // Length of all parts together, clocks. It exceeds the requested length if a limit slowed the line, or by rounding up
  // to whole clocks (per part).
  std::uint64_t clocks() const { return part_clocks_ * parts_; }
  // Whether a limit made the line longer than requested (LimitPolicy::kSlow).
  bool slowed() const { return slowed_; }

 private:
  friend OneShotPlan plan_line_clocks(const CardTiming&, const Displacement&, std::uint64_t, const LineLimits&);

  Displacement displacement_{};
  std::size_t parts_ = 0;
  std::uint64_t part_clocks_ = 0;
  bool slowed_ = false;
};

// Plans a line with a duration, rounded up to whole clocks. Throws ArgumentError when no axis moves, the card lacks an
// axis that moves, the duration is not positive, a limit is exceeded (kRefuse), or the line would take 2^62 clocks or
// more.
OneShotPlan plan_line(const CardTiming& card, const Displacement& displacement, std::chrono::nanoseconds duration,
                      const LineLimits& limits = {});

// The same at a speed along the path: the smallest number of clocks that does not exceed the speed.
OneShotPlan plan_line(const CardTiming& card, const Displacement& displacement, PathSpeed speed,
                      const LineLimits& limits = {});

// The same with a duration in clocks, at least 1.
OneShotPlan plan_line_clocks(const CardTiming& card, const Displacement& displacement, std::uint64_t clocks,
                             const LineLimits& limits = {});

// Starts the part. With direct mode: one transfer of 4 n + 3 writes on a card with n axes. Without it: through the
// card's stream, which is reset (an open Stream must be restarted afterwards). Throws FaultError if the card has a
// fault; RefusedError (without direct mode StateError) if it is not idle. A line is never lost silently.
void start_line(Card& card, const OneShotPart& part);

// Plans a line, starts it and returns the plan. Throws as plan_line(), and ArgumentError if the line has more than one
// part, both before the first access to the bus.
OneShotPlan start_line(Card& card, const Displacement& displacement, std::chrono::nanoseconds duration,
                       const LineLimits& limits = {});
OneShotPlan start_line(Card& card, const Displacement& displacement, PathSpeed speed, const LineLimits& limits = {});

// Runs all parts and returns when the last has ended. Throws HeldError, before anything moves, on a card that holds or
// whose ratio is 0; a later hold is waited out. Throws FaultError. Throws TimeoutError when a part has not ended
// `margin` (card time) after its length at the time base's ratio, not counting holds. Throws StateError when the card
// was reset, or aborted by Card::request_abort().
void run_line(Card& card, const OneShotPlan& plan, std::chrono::nanoseconds margin = std::chrono::seconds(1));

}  // namespace trammel::driver
