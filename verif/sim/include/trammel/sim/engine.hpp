// The simulated card, in two engines with the same step lists, cycle by cycle the same numbers:
// kRtl is the Verilated card in lockstep with the golden model, kModel the golden model alone, going from tick to tick.
// Both take bus accesses in the same number of clocks. Several engines may live side by side. An engine is not
// thread-safe: one thread at a time calls it, and only that one sees its steps and exceptions, also where the engine
// keeps a thread of its own (EngineOptions::rtl_thread).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trammel/driver/bus.hpp"

namespace trammel::sim {

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
};

// Receives steps in order of time. Called from within bus accesses and idle(); must not use the engine.
class StepSink {
 public:
  virtual ~StepSink() = default;
  virtual void pin_step(const PinStep& step) = 0;
  virtual void path_step(const PathStep& step) = 0;
};

enum class EngineKind { kRtl, kModel };

struct EngineOptions {
  EngineKind kind = EngineKind::kRtl;
  unsigned axes = 4;                   // 1 .. 8
  std::uint32_t clock_hz = 1'000'000;  // what the card says of itself; 1 cycle is 1 / clock_hz seconds
  std::optional<std::string> trace;    // FST file, kRtl only
  std::uint64_t seed = 1;              // named in the report of a mismatch
  bool rtl_thread = false;             // kRtl: the Verilated card in a thread of its own; not with a trace
};

// A card on a simulated bus: the driver's Bus, with wait() running clocks. A mismatch throws lockstep::Mismatch out
// of the call during which it was found: an access, wait(), lockstep_cycles() or comparisons(), at most some thousand
// clocks late. With a trace it is found at once. One that is found only when the engine is destroyed ends the process
// with its report: who wants to catch it asks for lockstep_cycles() first.
class Engine : public driver::Bus {
 public:
  virtual void set_sink(StepSink* sink) = 0;                         // nullptr: none; not owned
  virtual std::uint64_t cycles() const = 0;                          // clocks since reset
  virtual std::optional<std::uint64_t> lockstep_cycles() const = 0;  // cycles compared; none for the model alone
  virtual std::uint64_t comparisons() const = 0;                     // signals compared
  virtual std::vector<std::int64_t> positions() const = 0;  // pulses, by axis, as the position counters have them
};

// Throws std::invalid_argument for options out of range.
std::unique_ptr<Engine> make_engine(const EngineOptions& options);

}  // namespace trammel::sim
