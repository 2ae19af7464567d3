// Golden model of the time base: the clock enable that carries feed override and feed hold.
//
// Every 4th clock the ratio moves by at most the slew towards its goal (0 while held, else the target of the class),
// never past it.
// Every clock adds the ratio to a 16-bit phase; the carry is the enable. So n clocks at a constant ratio give
// floor((phase + n * ratio) / 2^16) enables, spaced as evenly as whole clocks allow.
// Not thread-safe; no errors are reported: inputs outside their ranges are the caller's mistake.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class TimeBase {
 public:
  struct Inputs {
    bool hold = false;  // slew to 0 instead of the target
    Setting setting;    // RATIO_FEED, RATIO_RAPID, RATIO_FIXED: targets by class; SLEW
    std::uint8_t piece_class = card_map::constant::kClassFeed;  // whose target it is
  };
  struct Outputs {
    bool enable = false;
    std::uint32_t ratio = 0x10000;  // 2^-16, 0..65536
  };
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  static constexpr unsigned kUpdate = card_map::constant::kSlewClocks;  // clocks

  // One rising edge. Clocks are counted from reset (the constructor): at clocks 4k the goal is sampled, at 4k + 2 the
  // slew, and the ratio that follows from them is in use from clock 4k + 5 on (visible after clock 4k + 4).
  void clock(const Inputs& in) {
    step(in.hold, in.piece_class);
    if (in.setting.set) set(in.setting);
  }
  // The same without a setting.
  void step(bool hold, std::uint8_t piece_class = card_map::constant::kClassFeed) {
    const std::uint32_t sum = phase_ + outputs_.ratio;
    outputs_.enable = (sum >> 16) != 0;
    phase_ = sum & 0xFFFF;
    if (turn_ == 0) {
      ratio_ = next_ratio_;
      goal_ = goal(hold, piece_class);
    } else if (turn_ == 2) {
      next_ratio_ = moved(ratio_, goal_, slew_);
    }
    outputs_.ratio = ratio_ >> 12;
    turn_ = (turn_ + 1) % kUpdate;
  }

  const Outputs& outputs() const { return outputs_; }

  // Clocks that the functions below can go, while `hold` and the class stay and nothing is set: all of them when the
  // ratio has arrived; while it slews those before it arrives, or comes into another 256th (rounded up; 0 is one by
  // itself), which the under-run guard sees. 0 where it does neither yet.
  std::uint64_t clocks_ahead(bool hold, std::uint8_t piece_class = card_map::constant::kClassFeed) const {
    if (goal_ != goal(hold, piece_class)) return 0;
    if (next_ratio_ != (turn_ == 1 || turn_ == 2 ? ratio_ : moved(ratio_, goal_, slew_))) return 0;
    return slews() ? slewing_clocks() : kNever;
  }

  // For up to clocks_ahead(), and below 2^47.

  // Enables that the next `clocks` clocks give.
  std::uint64_t enabled_in(std::uint64_t clocks) const { return (phase_ + added_in(clocks)) >> 16; }

  // Clocks until `enables` more have been given, the last of them included; kNever when the ratio stays 0. enables <
  // 2^47.
  std::uint64_t clocks_for(std::uint64_t enables) const {
    if (enables == 0) return 0;
    const std::uint64_t wanted = (enables << 16) - phase_;
    if (slews()) return slewing_clocks_for(wanted);
    if (outputs_.ratio == 0) return kNever;
    return (wanted + outputs_.ratio - 1) / outputs_.ratio;
  }

  // The same as clock() n times. Returns the enables given.
  std::uint64_t advance(std::uint64_t clocks) {
    if (clocks == 0) return 0;
    const std::uint64_t enables = enabled_in(clocks);
    outputs_.enable = enables != enabled_in(clocks - 1);
    phase_ = static_cast<std::uint32_t>((phase_ + added_in(clocks)) & 0xFFFF);
    if (clocks >= before_update()) {
      ratio_ = slewed(1 + (clocks - before_update()) / kUpdate);
      outputs_.ratio = ratio_ >> 12;
    }
    turn_ = static_cast<std::uint32_t>((turn_ + clocks) % kUpdate);
    next_ratio_ = turn_ == 1 || turn_ == 2 ? ratio_ : moved(ratio_, goal_, slew_);
    return enables;
  }

 private:
  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kRatioFeed) targets_[card_map::constant::kClassFeed] = setting.data;
    if (setting.address == card_map::reg::kRatioRapid) targets_[card_map::constant::kClassRapid] = setting.data;
    if (setting.address == card_map::reg::kRatioFixed) targets_[card_map::constant::kClassFixed] = setting.data;
    if (setting.address == card_map::reg::kSlew) slew_ = setting.data;
  }

  std::uint32_t goal(bool hold, std::uint8_t piece_class) const { return hold ? 0 : targets_[piece_class] << 12; }

  bool slews() const { return ratio_ != goal_ && slew_ != 0; }
  bool falls() const { return goal_ < ratio_; }
  // Clocks that add the ratio as it stands.
  std::uint64_t before_update() const { return turn_ == 0 ? 1 : kUpdate + 1 - turn_; }
  // Before the update that arrives or leaves the 256th.
  std::uint64_t slewing_clocks() const {
    const std::uint32_t last = (outputs_.ratio + 255) / 256 * 256;
    const std::uint32_t first = last == 0 ? 0 : last - 255;
    const std::uint32_t within = falls() ? ratio_ - (first << 12) : ((last + 1) << 12) - 1 - ratio_;
    const std::uint32_t to_goal = falls() ? ratio_ - goal_ : goal_ - ratio_;
    const std::uint64_t updates = (within < to_goal ? within : to_goal) / slew_;
    return before_update() + kUpdate * updates - 1;
  }
  // The ratio after so many updates, none of which arrives.
  std::uint32_t slewed(std::uint64_t updates) const {
    if (!slews()) return ratio_;
    const auto way = static_cast<std::uint32_t>(updates * slew_);
    return falls() ? ratio_ - way : ratio_ + way;
  }

  // What the next `clocks` clocks add to the phase.
  std::uint64_t added_in(std::uint64_t clocks) const {
    if (!slews() || clocks <= before_update()) return clocks * outputs_.ratio;
    const std::uint64_t later = clocks - before_update();
    const std::uint64_t updates = later / kUpdate;
    // Of ratio_ -+ k * slew_, k = 1 .. updates, counted from the lowest, in 2^-16.
    const std::uint64_t lowest = updates == 0 ? 0 : falls() ? slewed(updates) : slewed(1);
    const std::uint64_t whole = sum_of_quotients(updates, std::uint64_t{1} << 12, slew_, lowest);
    const std::uint64_t rest = later % kUpdate;
    return before_update() * outputs_.ratio + kUpdate * whole + (rest == 0 ? 0 : rest * (slewed(updates + 1) >> 12));
  }

  // The sum of (a * i + b) / m, each rounded down, over i = 0 .. n - 1: whole parts apart, what is left counts the
  // lattice points under a line, which are those beside it with the axes changed; so it goes down as the greatest
  // common divisor of a and m does.
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

  // Between what the least and the largest ratio of the 256th would need.
  std::uint64_t slewing_clocks_for(std::uint64_t wanted) const {
    const std::uint64_t largest = (outputs_.ratio + 255) / 256 * 256;
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

  static std::uint32_t moved(std::uint32_t from, std::uint32_t to, std::uint32_t step) {
    if (from < to) return to - from < step ? to : from + step;
    return from - to < step ? to : from - step;
  }

  std::array<std::uint32_t, 3> targets_{0x10000, 0x10000, 0x10000};  // ratios by class, 2^-16, 0..65536
  std::uint32_t slew_ = 0xFFF'FFFF;  // 2^-28 of ratio an update (4 clocks), 28 bits; 0 keeps the ratio
  // Q1.28, at most 1 = 2^28.
  std::uint32_t ratio_ = 1U << 28;
  std::uint32_t next_ratio_ = 1U << 28;
  std::uint32_t goal_ = 1U << 28;
  std::uint32_t phase_ = 0;
  std::uint32_t turn_ = 0;
  Outputs outputs_;
};

}  // namespace trammel::model
