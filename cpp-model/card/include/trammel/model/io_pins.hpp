// Golden models of the card's inputs and outputs. Bit n is pin n. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

// `pins` of them, 1 .. 16; bits of absent ones are 0.
inline std::uint16_t present_pins(unsigned pins) { return static_cast<std::uint16_t>((1U << pins) - 1); }

// A level at the pin is seen two clocks later, inverted where INPUT_POLARITY says so at once.
class InputPins {
 public:
  // All that the next clock() depends on beside its inputs.
  struct State {
    std::uint16_t last = 0;
    std::uint16_t seen = 0;
    std::uint16_t inverted = 0;
  };

  explicit InputPins(unsigned pins) : present_(present_pins(pins)) {}

  // One rising edge.
  void clock(std::uint16_t pins, const Setting& setting) {
    state_.seen = state_.last;
    state_.last = pins & present_;
    if (setting.set && setting.address == card_map::reg::kInputPolarity)
      state_.inverted = static_cast<std::uint16_t>(setting.data) & present_;
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  std::uint16_t present() const { return present_; }  // the bits of pins that there are
  std::uint16_t level() const { return state_.seen ^ state_.inverted; }

 private:
  std::uint16_t present_ = 0;
  State state_;
};

// Levels that commands set and clear; at a cut those that OUTPUT_SAFE names take its levels.
class OutputPins {
 public:
  // All that the next clock() depends on beside its inputs.
  struct State {
    std::uint16_t level = 0;
    std::uint16_t safe = 0;
    std::uint16_t changes = 0;
  };

  // `idle`: the levels in reset.
  OutputPins(unsigned pins, std::uint16_t idle) : present_(present_pins(pins)) { state_.level = idle & present_; }

  // One rising edge; an output that a change both sets and clears is set. A setting is in force from the next clock on.
  void clock(bool cut, std::uint16_t set, std::uint16_t clear, const Setting& setting) {
    if (cut)
      state_.level = static_cast<std::uint16_t>((state_.level & ~state_.changes) | (state_.safe & state_.changes));
    else
      state_.level = static_cast<std::uint16_t>(((state_.level & ~clear) | set) & present_);
    if (!setting.set || setting.address != card_map::reg::kOutputSafe) return;
    state_.safe = static_cast<std::uint16_t>(setting.data) & present_;
    state_.changes = static_cast<std::uint16_t>(setting.data >> 16) & present_;
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  std::uint16_t level() const { return state_.level; }

 private:
  std::uint16_t present_;
  State state_;
};

}  // namespace trammel::model
