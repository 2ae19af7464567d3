// The simulated card, with all engines built in (the arc generator too), in two engines: the golden model alone (here),
// and the Verilated card in lockstep with it (rtl_engine.hpp). Both give the same step lists, identical in every cycle,
// and take the same number of clocks per bus access. One thread per engine; several engines may exist at once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/steps.hpp"

namespace trammel::sim {

// Pins of the simulated card: outputs, and inputs that each have a filter and any roles.
inline constexpr unsigned kInputs = 16;
inline constexpr unsigned kOutputs = 4;

struct EngineOptions {
  unsigned axes = 4;                   // 1 .. 8
  std::uint32_t clock_hz = 1'000'000;  // clock frequency that the card reports; 1 cycle is 1 / clock_hz seconds
  bool interrupt = false;              // the card's interrupt line reaches the bus
};

// Options of the model alone, which can simulate any build of the card.
struct ModelOptions : EngineOptions {
  ModelOptions(const EngineOptions& options = {}) : EngineOptions(options) {}  // NOLINT: they are options of the model
  std::uint32_t geometry_depth = 4096;                                         // halfwords
  std::uint32_t feed_depth = 2560;                                             // halfwords
  std::optional<std::uint32_t> engines;                                        // mask of engines; nullopt: all
};

// A card on a simulated bus: a driver::Bus whose sleep() runs clocks. transfer() reports refusals. An access that is
// not answered within 100,000 clocks throws LinkError.
class Engine : public driver::Bus {
 public:
  // For tests: one access each. Throw driver::RefusedError, without a reason, when the card refuses the access.
  std::uint32_t read(std::uint32_t address);
  void write(std::uint32_t address, std::uint32_t value);

  virtual void wait(std::uint64_t clocks) = 0;   // runs `clocks` clocks
  bool wait_or_interrupt(std::uint64_t clocks);  // the same; false: an InterruptScope ended it early
  // Sets the levels at the card's input pins; bit n: input n. An input that was never set is unwired and has its
  // inactive level: 1 if INPUT_POLARITY inverts it, else 0.
  virtual void set_inputs(std::uint32_t levels) = 0;
  virtual void set_input(unsigned input, bool level) = 0;            // sets one input
  virtual void set_emergency_stop(bool pressed) = 0;                 // presses or releases the button
  virtual void reset() = 0;                                          // resets the card, as its reset input does
  virtual void set_sink(driver::StepSink* sink) = 0;                 // nullptr: none; not owned
  virtual std::uint64_t cycles() const = 0;                          // clocks since reset
  virtual std::uint32_t step_pins() const = 0;                       // levels at the first pins (STEP, UP or A)
  virtual std::optional<std::uint64_t> lockstep_cycles() const = 0;  // cycles compared; nullopt: no lockstep
  virtual std::uint64_t comparisons() const = 0;                     // signals compared
  virtual std::vector<std::int64_t> positions() const = 0;           // pulses, by axis: the position counters
};

// The golden model alone; it advances from tick to tick. Throws std::invalid_argument for options out of range.
std::unique_ptr<Engine> make_model_engine(const ModelOptions& options);

}  // namespace trammel::sim
