// Steps of a card as seen from outside: simulated cards report them, recorders receive them. Plain data.
#pragma once

#include <cstdint>

namespace trammel::driver {

// A leading edge at a STEP pin.
struct PinStep {
  std::uint64_t cycle;
  std::uint8_t axis;
  std::int8_t direction;  // +1 or -1
};

// A step of the path, before the shapers.
struct PathStep {
  std::uint64_t command;  // number of the stream command, not wrapped; 0 in direct mode
  std::uint64_t tick;     // tick of its path, from 1: feed ticks of a line, path ticks of an arc
  std::uint8_t axis;
  std::int8_t direction;
  std::uint64_t cycle = 0;  // clock in which the step reaches its shaper
};

// Outputs that changed at their pins in one clock; bit n: output n.
struct OutputChange {
  std::uint64_t cycle;  // clock in which the pins have their new levels
  std::uint16_t changed;
  std::uint16_t levels;  // levels of all outputs
};

// Receives steps in order of time; the steps of a clock come before its output changes. The calls come from within bus
// accesses and waits; they must not use the bus or the card.
class StepSink {
 public:
  virtual ~StepSink() = default;
  virtual void pin_step(const PinStep& step) = 0;
  virtual void path_step(const PathStep& step) = 0;
  virtual void outputs_changed(const OutputChange& /*change*/) {}
};

}  // namespace trammel::driver
