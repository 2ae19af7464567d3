// Steps of a card as something outside it sees them: what simulated cards report and recorders take. Plain data.
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
  std::uint64_t tick;     // of its path, from 1: feed ticks of a line, path ticks of an arc
  std::uint8_t axis;
  std::int8_t direction;
  std::uint64_t cycle = 0;  // in which it comes to its shaper
};

// Receives steps in order of time. Called from within bus accesses and waits; must not use the bus or the card.
class StepSink {
 public:
  virtual ~StepSink() = default;
  virtual void pin_step(const PinStep& step) = 0;
  virtual void path_step(const PathStep& step) = 0;
};

}  // namespace trammel::driver
