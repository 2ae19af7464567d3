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
  explicit InputPins(unsigned pins) : present_(present_pins(pins)) {}

  // One rising edge.
  void clock(std::uint16_t pins, const Setting& setting) {
    seen_ = last_;
    last_ = pins & present_;
    if (setting.set && setting.address == card_map::reg::kInputPolarity)
      inverted_ = static_cast<std::uint16_t>(setting.data) & present_;
  }

  std::uint16_t level() const { return seen_ ^ inverted_; }
  // Clocks with these levels at the pins change nothing.
  bool quiet(std::uint16_t pins) const { return (pins & present_) == last_ && last_ == seen_; }

 private:
  std::uint16_t present_;
  std::uint16_t last_ = 0;
  std::uint16_t seen_ = 0;
  std::uint16_t inverted_ = 0;
};

// Levels that commands set and clear; at a cut those that OUTPUT_SAFE names take its levels.
class OutputPins {
 public:
  // `idle`: the levels in reset.
  OutputPins(unsigned pins, std::uint16_t idle) : present_(present_pins(pins)), level_(idle & present_) {}

  // One rising edge; an output that a change both sets and clears is set. A setting is in force from the next clock on.
  void clock(bool cut, std::uint16_t set, std::uint16_t clear, const Setting& setting) {
    if (cut)
      level_ = static_cast<std::uint16_t>((level_ & ~changes_) | (safe_ & changes_));
    else
      level_ = static_cast<std::uint16_t>(((level_ & ~clear) | set) & present_);
    if (!setting.set || setting.address != card_map::reg::kOutputSafe) return;
    safe_ = static_cast<std::uint16_t>(setting.data) & present_;
    changes_ = static_cast<std::uint16_t>(setting.data >> 16) & present_;
  }

  std::uint16_t level() const { return level_; }

 private:
  std::uint16_t present_;
  std::uint16_t level_;
  std::uint16_t safe_ = 0;
  std::uint16_t changes_ = 0;
};

}  // namespace trammel::model
