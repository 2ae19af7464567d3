// Golden model of the time base: the clock enable that carries feed override and feed hold.
//
// Every 4th clock the ratio moves by at most the slew towards its goal (0 while held, else the target of the class),
// never past it.
// Every clock adds the ratio to a 16-bit phase; the carry is the enable. So n clocks at a constant ratio give
// floor((phase + n * ratio) / 2^16) enables, spaced as evenly as whole clocks allow.
// Not thread-safe; no errors are reported: inputs outside their ranges are the caller's mistake.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

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
    turn_ = (turn_ + 1) & 3;
  }

  const Outputs& outputs() const { return outputs_; }

  // True when the ratio has arrived and stays what it is for as long as `hold` and the class stay and nothing is set.
  bool steady(bool hold, std::uint8_t piece_class = card_map::constant::kClassFeed) const {
    return ratio_ == goal(hold, piece_class) && goal_ == ratio_ && next_ratio_ == ratio_ &&
           outputs_.ratio == ratio_ >> 12;
  }

  // Enables that the next `clocks` clocks give; only while steady. clocks < 2^47.
  std::uint64_t enabled_in(std::uint64_t clocks) const { return (phase_ + clocks * outputs_.ratio) >> 16; }

  // Clocks until `enables` more have been given, the last of them included; only while steady. enables < 2^47.
  // kNever when the ratio is 0.
  std::uint64_t clocks_for(std::uint64_t enables) const {
    if (enables == 0) return 0;
    if (outputs_.ratio == 0) return kNever;
    return ((enables << 16) - phase_ + outputs_.ratio - 1) / outputs_.ratio;
  }

  // The same as clock() n times while steady(); n < 2^47. Returns the enables given.
  std::uint64_t advance(std::uint64_t clocks) {
    if (clocks == 0) return 0;
    const std::uint64_t enables = enabled_in(clocks);
    outputs_.enable = enables != enabled_in(clocks - 1);
    phase_ = static_cast<std::uint32_t>((phase_ + clocks * outputs_.ratio) & 0xFFFF);
    turn_ = static_cast<std::uint32_t>((turn_ + clocks) & 3);
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
