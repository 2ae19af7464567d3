// Lines made of one pulse train per axis: DDA, one-shot velocity with phase accumulators, and with integer dividers.
// After Zeng, Zhang & Huang, "A New Linear Interpolation Algorithm": p_a pulses on axis a, all trains started
// together. Axis a makes its j-th pulse in the clock (or iteration) in which its accumulator overflows for the j-th
// time. The walk therefore goes from pulse to pulse and not from clock to clock. No errors are reported; not
// thread-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "trammel/interpolation/curve.hpp"

namespace trammel::interpolation {

// The times of an axis's pulses. The line lasts numerator / denominator clocks.
//   accumulators: x_k = floor(preset + k * p / L), so pulse j comes at k = ceil((j - preset) * L / p)
//   dividers:     pulse j at k = j * floor(L / p)
// 2 * numerator < 2^62 and 2 * p * denominator < 2^62.
struct PulseTiming {
  enum class Kind { kAccumulatorHalf, kAccumulatorZero, kDivider };
  Kind kind = Kind::kAccumulatorHalf;
  std::uint64_t numerator = 1;
  std::uint64_t denominator = 1;
};

// The number of pulses of the longest axis.
inline std::uint64_t longest_axis(const Line& line) {
  std::uint64_t longest = 0;
  for (unsigned a = 0; a < line.axes; ++a) {
    const std::int64_t p = line.end[a] - line.start[a];
    longest = std::max(longest, static_cast<std::uint64_t>(p < 0 ? -p : p));
  }
  return longest;
}

// DDA registers have n bits, with 2^n the smallest power of two above the longest axis; the line takes 2^n
// iterations.
inline PulseTiming dda_timing(const Line& line, bool half) {
  const std::uint64_t longest = longest_axis(line);
  std::uint64_t iterations = 1;
  while (iterations <= longest) iterations *= 2;
  return {half ? PulseTiming::Kind::kAccumulatorHalf : PulseTiming::Kind::kAccumulatorZero, iterations, 1};
}

// The second paper's v lines per second at f clocks per second: L = f / v.
inline PulseTiming one_shot_timing(const Options& options, PulseTiming::Kind kind) {
  return {kind, options.clock_hz * options.velocity_divisor, options.velocity};
}

template <unsigned Axes>
class PulseTrainLine {
 public:
  // At most one pulse per clock: p <= L on every axis.
  PulseTrainLine(const Line& line, const PulseTiming& timing) : end_(line.end) {
    next_.fill(kNever);
    total_ = (timing.numerator + timing.denominator - 1) / timing.denominator;
    for (unsigned a = 0; a < Axes; ++a) {
      const std::int64_t displacement = line.end[a] - line.start[a];
      sign_[a] = displacement < 0 ? std::int8_t{-1} : std::int8_t{1};
      left_[a] = static_cast<std::uint64_t>(sign_[a] * displacement);
      if (left_[a] != 0) start(a, timing);
    }
    if (timing.kind != PulseTiming::Kind::kDivider) return;
    total_ = 0;
    for (unsigned a = 0; a < Axes; ++a) total_ = std::max(total_, left_[a] * whole_[a]);
  }

  bool done() const { return earliest() == kNever; }
  // Not to be called when done.
  Step next() {
    time_ = earliest();
    return step(std::make_index_sequence<Axes>{});
  }
  Position position() const {
    Position result = end_;
    for (unsigned a = 0; a < Axes; ++a) result[a] -= sign_[a] * static_cast<std::int64_t>(left_[a]);
    return result;
  }
  // Clocks or iterations since the common start.
  std::uint64_t time() const { return time_; }
  // Accumulators: the line's duration, rounded up to whole clocks. Dividers: the last pulse of the slowest axis.
  std::uint64_t total_time() const { return total_; }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  void start(unsigned a, const PulseTiming& timing) {
    if (timing.kind == PulseTiming::Kind::kDivider) {
      modulus_[a] = 1;
      whole_[a] = timing.numerator / (left_[a] * timing.denominator);
      next_[a] = whole_[a];
      return;
    }
    // Pulse j is at ceil((2j - 1) * L / 2p), or ceil(2j * L / 2p): each further pulse adds 2L / 2p.
    modulus_[a] = 2 * left_[a] * timing.denominator;
    whole_[a] = 2 * timing.numerator / modulus_[a];
    remainder_[a] = 2 * timing.numerator % modulus_[a];
    const bool half = timing.kind == PulseTiming::Kind::kAccumulatorHalf;
    const std::uint64_t first = half ? timing.numerator : 2 * timing.numerator;
    next_[a] = (first + modulus_[a] - 1) / modulus_[a];
    slack_[a] = static_cast<std::int64_t>(next_[a] * modulus_[a] - first);
  }

  // One expression for all axes: a loop over the bytes of a Step stalls on each of them.
  template <std::size_t... Index>
  Step step(std::index_sequence<Index...>) {
    return {{pulse(Index)...}};
  }

  // The direction in which the axis steps at time_, or 0.
  std::int8_t pulse(std::size_t a) {
    // Masks instead of branches, because a branch predictor cannot predict which axis is due next.
    const std::uint64_t due = next_[a] == time_;
    slack_[a] -= static_cast<std::int64_t>(-due & remainder_[a]);
    const std::uint64_t late = static_cast<std::uint64_t>(slack_[a]) >> 63;
    slack_[a] += static_cast<std::int64_t>(-late & modulus_[a]);
    next_[a] += (-due & whole_[a]) + late;
    left_[a] -= due;
    if (left_[a] == 0) next_[a] = kNever;
    return static_cast<std::int8_t>(sign_[a] * static_cast<std::int8_t>(due));
  }

  std::uint64_t earliest() const {
    std::uint64_t first = next_[0];
    for (unsigned a = 1; a < Axes; ++a) first = std::min(first, next_[a]);
    return first;
  }

  Position end_;
  std::uint64_t time_ = 0;
  std::uint64_t total_ = 0;
  std::array<std::uint64_t, Axes> next_{};   // clock of the next pulse
  std::array<std::int64_t, Axes> slack_{};   // (clock - exact time of the pulse) * modulus, >= 0
  std::array<std::uint64_t, Axes> whole_{};  // interval between two pulses in clocks: whole + remainder / modulus
  std::array<std::uint64_t, Axes> remainder_{};
  std::array<std::uint64_t, Axes> modulus_{};
  std::array<std::uint64_t, Axes> left_{};
  std::array<std::int8_t, Axes> sign_{};
};

}  // namespace trammel::interpolation
