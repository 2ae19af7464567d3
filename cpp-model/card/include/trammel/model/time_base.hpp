// Golden model of the time base: the clock enable that carries feed override and feed hold.
//
// Every 4th clock the ratio moves towards its goal by at most one step, never past it. The goal is 0 during a hold,
// otherwise the target of the class. The step is the slew; on cards with classes it is doubled as often as the piece
// in force says, within 28 bits. Every clock adds the ratio to a 16-bit phase; the carry is the enable. So n clocks
// at a constant ratio give floor((phase + n * ratio) / 2^16) enables, spaced as evenly as whole clocks allow.
// Not thread-safe; no errors are reported: the caller must keep the inputs within their ranges.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class TimeBase {
 public:
  struct Inputs {
    bool hold = false;  // slew to 0 instead of the target
    Setting setting;    // RATIO_FEED, RATIO_RAPID, RATIO_FIXED: targets by class; SLEW
    std::uint8_t piece_class = card_map::constant::kClassFeed;  // class that selects the target
    std::uint8_t slew_shift = 0;                                // doublings of the slew, 0 .. 3
  };
  struct Outputs {
    bool enable = false;
    std::uint32_t ratio = 0x10000;  // 2^-16, 0..65536
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::array<std::uint32_t, 3> targets{0x10000, 0x10000, 0x10000};  // ratios by class, 2^-16, 0..65536
    std::uint32_t slew = 0xFFF'FFFF;  // 2^-28 of ratio per update (4 clocks), 28 bits; 0 keeps the ratio
    std::uint32_t step = 0xFFF'FFFF;  // step of the next update
    // Q1.28, at most 1 = 2^28.
    std::uint32_t ratio = 1U << 28;
    std::uint32_t next_ratio = 1U << 28;
    std::uint32_t goal = 1U << 28;
    std::uint32_t phase = 0;
    std::uint32_t turn = 0;
    Outputs outputs;
  };
  static constexpr unsigned kUpdate = card_map::constant::kSlewClocks;  // clocks

  // `doubles`: the card has classes, and so doublings of the slew.
  explicit TimeBase(bool doubles = true) : doubles_(doubles) {}

  // One rising edge. Clocks are counted from reset (the constructor): at clocks 4k the goal is sampled, at 4k - 2 the
  // slew and its doublings (without doublings the slew at 4k + 2), and the ratio that follows from them is in use from
  // clock 4k + 5 on (visible after clock 4k + 4).
  void clock(const Inputs& in) {
    const std::uint32_t sum = state_.phase + state_.outputs.ratio;
    state_.outputs.enable = (sum >> 16) != 0;
    state_.phase = sum & 0xFFFF;
    if (state_.turn == 0) {
      state_.ratio = state_.next_ratio;
      state_.goal = goal(in.hold, in.piece_class);
    } else if (state_.turn == 2) {
      state_.next_ratio = moved(state_.ratio, state_.goal, state_.step);
      if (doubles_) state_.step = step(in.slew_shift);
    }
    state_.outputs.ratio = state_.ratio >> 12;
    state_.turn = (state_.turn + 1) % kUpdate;
    if (in.setting.set) set(in.setting);
  }

  const Outputs& outputs() const { return state_.outputs; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // The ratio to which these inputs lead, in 2^-28; moved() makes one update towards it.
  std::uint32_t goal(bool hold, std::uint8_t piece_class) const { return hold ? 0 : state_.targets[piece_class] << 12; }
  // The slew after its doublings, within 28 bits.
  std::uint32_t step(unsigned slew_shift) const {
    std::uint32_t step = state_.slew;
    for (; doubles_ && slew_shift != 0 && step >> 27 == 0; --slew_shift) step *= 2;
    return step;
  }
  static std::uint32_t moved(std::uint32_t from, std::uint32_t to, std::uint32_t step) {
    if (from < to) return to - from < step ? to : from + step;
    return from - to < step ? to : from - step;
  }

 private:
  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kRatioFeed) state_.targets[card_map::constant::kClassFeed] = setting.data;
    if (setting.address == card_map::reg::kRatioRapid) state_.targets[card_map::constant::kClassRapid] = setting.data;
    if (setting.address == card_map::reg::kRatioFixed) state_.targets[card_map::constant::kClassFixed] = setting.data;
    if (setting.address == card_map::reg::kSlew) state_.slew = setting.data;
    if (!doubles_) state_.step = state_.slew;
  }

  bool doubles_;
  State state_;
};

}  // namespace trammel::model
