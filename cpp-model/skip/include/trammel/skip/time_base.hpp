// Adaptor of the time base. TimeBaseAhead computes its enables over many clocks. See horizon.hpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "trammel/model/time_base.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

class TimeBaseAhead {
 public:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  explicit TimeBaseAhead(const model::TimeBase& block) : block_(block), s_(block.state()) {}

  // The number of clocks for which the functions below are valid, while `in` stays and nothing is set. After the
  // ratio has arrived: all. While it slews: the clocks before it arrives, or enters another 256th (rounded up; 0 is
  // one of its own), which the under-run guard sees. 0 if neither holds yet.
  std::uint64_t clocks_ahead(const model::TimeBase::Inputs& in) const {
    if (s_.goal != block_.goal(in.hold, in.piece_class) || s_.step != block_.step(in.slew_shift)) return 0;
    if (s_.next_ratio != (s_.turn == 1 || s_.turn == 2 ? s_.ratio : model::TimeBase::moved(s_.ratio, s_.goal, s_.step)))
      return 0;
    return slews() ? slewing_clocks() : kNever;
  }

  // The number of enables in the next `clocks` clocks.
  std::uint64_t enabled_in(std::uint64_t clocks) const { return (s_.phase + added_in(clocks)) >> 16; }

  // Clocks up to and including the one of the `enables`-th enable; kNever if the ratio stays 0. enables < 2^47.
  std::uint64_t clocks_for(std::uint64_t enables) const {
    if (enables == 0) return 0;
    const std::uint64_t wanted = (enables << 16) - s_.phase;
    if (slews()) return slewing_clocks_for(wanted);
    if (s_.outputs.ratio == 0) return kNever;
    return (wanted + s_.outputs.ratio - 1) / s_.outputs.ratio;
  }

  // The state after this number of calls of clock().
  model::TimeBase::State after(std::uint64_t clocks) const {
    model::TimeBase::State s = s_;
    if (clocks == 0) return s;
    s.outputs.enable = enabled_in(clocks) != enabled_in(clocks - 1);
    s.phase = static_cast<std::uint32_t>((s_.phase + added_in(clocks)) & 0xFFFF);
    if (clocks >= before_update()) {
      s.ratio = slewed(1 + (clocks - before_update()) / model::TimeBase::kUpdate);
      s.outputs.ratio = s.ratio >> 12;
    }
    s.turn = static_cast<std::uint32_t>((s_.turn + clocks) % model::TimeBase::kUpdate);
    s.next_ratio = s.turn == 1 || s.turn == 2 ? s.ratio : model::TimeBase::moved(s.ratio, s.goal, s.step);
    return s;
  }

 private:
  bool slews() const { return s_.ratio != s_.goal && s_.step != 0; }
  bool falls() const { return s_.goal < s_.ratio; }
  // Clocks that still add the present ratio.
  std::uint64_t before_update() const { return s_.turn == 0 ? 1 : model::TimeBase::kUpdate + 1 - s_.turn; }
  // Clocks before the update that arrives at the goal or leaves the 256th.
  std::uint64_t slewing_clocks() const {
    const std::uint32_t last = (s_.outputs.ratio + 255) / 256 * 256;
    const std::uint32_t first = last == 0 ? 0 : last - 255;
    const std::uint32_t within = falls() ? s_.ratio - (first << 12) : ((last + 1) << 12) - 1 - s_.ratio;
    const std::uint32_t to_goal = falls() ? s_.ratio - s_.goal : s_.goal - s_.ratio;
    const std::uint64_t updates = (within < to_goal ? within : to_goal) / s_.step;
    return before_update() + model::TimeBase::kUpdate * updates - 1;
  }
  // The ratio after this number of updates, none of which arrives.
  std::uint32_t slewed(std::uint64_t updates) const {
    if (!slews()) return s_.ratio;
    const auto way = static_cast<std::uint32_t>(updates * s_.step);
    return falls() ? s_.ratio - way : s_.ratio + way;
  }
  // The amount that the next `clocks` clocks add to the phase.
  std::uint64_t added_in(std::uint64_t clocks) const {
    if (!slews() || clocks <= before_update()) return clocks * s_.outputs.ratio;
    const std::uint64_t later = clocks - before_update();
    const std::uint64_t updates = later / model::TimeBase::kUpdate;
    // The sum of s_.ratio -+ k * s_.step for k = 1 .. updates, counted from the lowest, in 2^-16.
    const std::uint64_t lowest = updates == 0 ? 0 : falls() ? slewed(updates) : slewed(1);
    const std::uint64_t whole = sum_of_quotients(updates, std::uint64_t{1} << 12, s_.step, lowest);
    const std::uint64_t rest = later % model::TimeBase::kUpdate;
    return before_update() * s_.outputs.ratio + model::TimeBase::kUpdate * whole +
           (rest == 0 ? 0 : rest * (slewed(updates + 1) >> 12));
  }
  // The sum of floor((a * i + b) / m) over i = 0 .. n - 1. The whole parts of a / m and b / m are summed directly.
  // The rest counts lattice points under a line; exchanging the axes turns that into the same problem with smaller
  // numbers, so the loop proceeds like Euclid's algorithm for a and m.
  static std::uint64_t sum_of_quotients(std::uint64_t n, std::uint64_t m, std::uint64_t a, std::uint64_t b) {
    std::uint64_t sum = 0;
    for (;;) {
      if (n == 0) return sum;
      sum += n * (n - 1) / 2 * (a / m) + n * (b / m);
      a %= m;
      b %= m;
      const std::uint64_t top = a * n + b;
      if (top < m) return sum;
      n = top / m;
      b = top % m;
      std::swap(a, m);
    }
  }
  // Binary search between the clocks that the smallest and the largest ratio of the 256th would need.
  std::uint64_t slewing_clocks_for(std::uint64_t wanted) const {
    const std::uint64_t largest = (s_.outputs.ratio + 255) / 256 * 256;
    if (largest == 0) return kNever;
    std::uint64_t low = wanted / largest;  // too few, or just enough
    std::uint64_t high = std::min(wanted / (largest - 255) + 1, slewing_clocks());
    while (low < high) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (added_in(middle) >= wanted)
        high = middle;
      else
        low = middle + 1;
    }
    return low;
  }

  const model::TimeBase& block_;
  const model::TimeBase::State& s_;
};

// The enable is constant only at the ratios 0 and 1.
inline std::uint64_t horizon(const model::TimeBase& block, const model::TimeBase::Inputs& in) {
  const model::TimeBase::State& s = block.state();
  const bool arrived = s.ratio == s.goal && s.next_ratio == s.goal && s.outputs.ratio == s.goal >> 12;
  const bool even = s.ratio == 0 ? !s.outputs.enable : s.ratio == 1U << 28 && s.outputs.enable;
  const bool steady = s.goal == block.goal(in.hold, in.piece_class) && s.step == block.step(in.slew_shift);
  return forever_if(!in.setting.set && arrived && even && steady);
}
inline void advance(model::TimeBase& block, const model::TimeBase::Inputs&, std::uint64_t clocks) {
  block.state() = TimeBaseAhead(block).after(clocks);
}

}  // namespace trammel::skip
