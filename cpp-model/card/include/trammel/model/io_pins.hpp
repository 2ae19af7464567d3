// Golden models of the card's inputs and outputs. Bit n is pin n. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

// The mask of `pins` pins, 1 .. 32; bits of absent pins are 0.
inline std::uint32_t present_pins(unsigned pins) { return static_cast<std::uint32_t>((std::uint64_t{1} << pins) - 1); }

// The level of a pin is seen two clocks later. INPUT_POLARITY inverts the seen level at once.
class InputPins {
 public:
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint32_t last = 0;
    std::uint32_t seen = 0;
    std::uint32_t inverted = 0;
  };
  struct Inputs {
    std::uint32_t pins = 0;
    Setting setting;
  };

  explicit InputPins(unsigned pins) : present_(present_pins(pins)) {}

  // One rising edge.
  void clock(const Inputs& in) {
    state_.seen = state_.last;
    state_.last = in.pins & present_;
    if (in.setting.set && in.setting.address == card_map::reg::kInputPolarity)
      state_.inverted = in.setting.data & present_;
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  std::uint32_t present() const { return present_; }  // mask of the pins that the card has
  std::uint32_t level() const { return state_.seen ^ state_.inverted; }

 private:
  std::uint32_t present_ = 0;
  State state_;
};

// The output levels that commands set and clear. At a cut, the outputs that OUTPUT_SAFE names take its levels. At a
// cause and at a cut, those that OUTPUT_SAFE_CAUSE names take its levels, with priority. The emergency stop's latch
// forces the levels of OUTPUT_SAFE_CAUSE at the pins.
class OutputPins {
 public:
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint16_t level = 0;
    std::uint16_t safe = 0;
    std::uint16_t changes = 0;
    std::uint16_t cause_safe = 0;
    std::uint16_t cause_changes = 0;
  };

  // `idle`: the levels in reset.
  OutputPins(unsigned pins, std::uint16_t idle) : present_(static_cast<std::uint16_t>(present_pins(pins))) {
    state_.level = idle & present_;
  }

  // One rising edge; an output that a change both sets and clears is set. A setting is in force from the next clock on.
  void clock(bool cut, bool caused, std::uint16_t set, std::uint16_t clear, const Setting& setting) {
    if (cut)
      state_.level = static_cast<std::uint16_t>((state_.level & ~state_.changes) | (state_.safe & state_.changes));
    else
      state_.level = static_cast<std::uint16_t>(((state_.level & ~clear) | set) & present_);
    if (cut || caused) state_.level = at_cause(state_.level);
    if (!setting.set) return;
    const auto levels = static_cast<std::uint16_t>(setting.data & present_);
    const auto changes = static_cast<std::uint16_t>(setting.data >> 16 & present_);
    if (setting.address == card_map::reg::kOutputSafe) {
      state_.safe = levels;
      state_.changes = changes;
    } else if (setting.address == card_map::reg::kOutputSafeCause) {
      state_.cause_safe = levels;
      state_.cause_changes = changes;
    }
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  // At the pins; `latched`: the emergency stop's latch is set.
  std::uint16_t level(bool latched) const { return latched ? at_cause(state_.level) : state_.level; }
  // True if a cause changes no level.
  bool safe() const { return at_cause(state_.level) == state_.level; }

 private:
  std::uint16_t at_cause(std::uint16_t level) const {
    return static_cast<std::uint16_t>((level & ~state_.cause_changes) | (state_.cause_safe & state_.cause_changes));
  }

  std::uint16_t present_;
  State state_;
};

// The signals that the roles of outputs follow.
struct OutputRoleLevels {
  bool enabled = false;   // the drives are enabled
  bool released = false;  // the brake is released
  bool pump = false;      // the charge pump's wave
  bool healthy = false;   // the card is healthy
};

// An output with a role follows the role instead of its level. It has its idle level while the role is inactive, and
// the other level while the role is active.
class OutputRoles {
 public:
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint16_t enable = 0;
    std::uint16_t brake = 0;
    std::uint16_t pump = 0;
    std::uint16_t healthy = 0;
  };

  // `idle`: the levels in reset.
  OutputRoles(unsigned pins, std::uint16_t idle)
      : present_(static_cast<std::uint16_t>(present_pins(pins))), idle_(static_cast<std::uint16_t>(idle & present_)) {}

  // One rising edge.
  void clock(const Setting& setting) {
    if (!setting.set) return;
    const auto low = static_cast<std::uint16_t>(setting.data & present_);
    const auto high = static_cast<std::uint16_t>(setting.data >> 16 & present_);
    if (setting.address == card_map::reg::kOutputRoles) {
      state_.enable = low;
      state_.brake = high;
    } else if (setting.address == card_map::reg::kHealthRoles) {
      state_.pump = low;
      state_.healthy = high;
    }
  }

  const State& state() const { return state_; }
  // Levels at the pins. The emergency stop's latch disables the drives and sets the brakes.
  std::uint16_t pins(std::uint16_t level, const OutputRoleLevels& roles, bool latched) const {
    const unsigned all = state_.enable | state_.brake | state_.pump | state_.healthy;
    unsigned active = (roles.pump ? state_.pump : 0U) | (roles.healthy ? state_.healthy : 0U);
    if (!latched) active |= (roles.enabled ? state_.enable : 0U) | (roles.released ? state_.brake : 0U);
    return static_cast<std::uint16_t>((level & ~all) | ((idle_ ^ active) & all));
  }

 private:
  std::uint16_t present_;
  std::uint16_t idle_;
  State state_;
};

}  // namespace trammel::model
