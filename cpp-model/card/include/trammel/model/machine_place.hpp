// Golden model of the machine's place: the axes that are at the positions that the host assumes (POSITION_VALID), and
// the axes that were homed (HOMED). The host writes both. An axis loses both at a fault of its drive. Unless
// KEEPS_PLACE names it, it also loses them at a cut while it moves, and when its drive is disabled. An axis counts as
// moving from its first step on, while a piece or a direct move is under way at a ratio other than 0. Losses are
// judged one clock after their event. Bit n of a mask is axis n. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class MachinePlace {
 public:
  struct Inputs {
    Setting setting;            // KEEPS_PLACE, SET_PLACE
    bool cut = false;           // a cut, or the closing before it
    bool at_rest = false;       // the ratio is 0
    bool runs = false;          // a piece or a direct move is under way
    std::uint8_t step = 0;      // steps on the path
    std::uint8_t drives = 0;    // levels: drive faults
    std::uint8_t disabled = 0;  // events: the axis's drive is disabled
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint8_t valid = 0;
    std::uint8_t homed = 0;
    std::uint8_t keeps = 0;
    std::uint8_t moved = 0;  // has made a step since the motion under way began
    // Inputs of the previous clock.
    std::uint8_t drives = 0;
    std::uint8_t disabled = 0;
    bool cut = false;  // there was a cut at a ratio other than 0
  };

  explicit MachinePlace(unsigned axes = card_map::kMaxAxes) : present_(static_cast<std::uint8_t>((1U << axes) - 1)) {}

  // One rising edge. A write in clock c takes effect at c + 1, a loss at c + 2. A loss therefore wins over a write in
  // its own clock and in the next one, and obeys a KEEPS_PLACE written in its own clock.
  void clock(const Inputs& in) {
    const std::uint8_t lost = lost_now();
    if (in.setting.set) set(in.setting);
    state_.valid &= static_cast<std::uint8_t>(~lost);
    state_.homed &= static_cast<std::uint8_t>(~lost);
    state_.moved = moved_with(in);
    state_.drives = in.drives & present_;
    state_.disabled = in.disabled & present_;
    state_.cut = cuts(in);
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  // The register PLACE.
  std::uint32_t place() const {
    return std::uint32_t{state_.valid} << card_map::field::kPlacePositionValidShift |
           std::uint32_t{state_.homed} << card_map::field::kPlaceHomedShift;
  }
  // True if clocks with these inputs change nothing, however many pass.
  bool rests(const Inputs& in) const {
    const auto known = static_cast<std::uint8_t>(state_.valid | state_.homed);
    const bool settled = moved_with(in) == state_.moved && (in.drives & present_) == state_.drives &&
                         (in.disabled & present_) == state_.disabled && cuts(in) == state_.cut;
    return !in.setting.set && settled && (lost_now() & known) == 0;
  }

 private:
  static bool cuts(const Inputs& in) { return in.cut && !in.at_rest; }
  std::uint8_t moved_with(const Inputs& in) const {
    return in.runs ? static_cast<std::uint8_t>(state_.moved | in.step) : std::uint8_t{0};
  }
  // The axes that lose their place, judged from the events of the previous clock.
  std::uint8_t lost_now() const {
    const unsigned stopped = state_.cut ? state_.moved : 0U;
    return static_cast<std::uint8_t>(state_.drives | ((stopped | state_.disabled) & ~state_.keeps));
  }

  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kKeepsPlace)
      state_.keeps = static_cast<std::uint8_t>(setting.data & present_);
    if (setting.address != card_map::reg::kSetPlace) return;
    const auto named = static_cast<std::uint8_t>(setting.data >> card_map::field::kSetPlaceAxesShift & present_);
    write(state_.valid, named, (setting.data & card_map::field::kSetPlacePositionValid) != 0);
    write(state_.homed, named, (setting.data & card_map::field::kSetPlaceHomed) != 0);
  }

  static void write(std::uint8_t& mask, std::uint8_t named, bool value) {
    mask = static_cast<std::uint8_t>((mask & ~named) | (value ? named : 0));
  }

  std::uint8_t present_;
  State state_;
};

}  // namespace trammel::model
