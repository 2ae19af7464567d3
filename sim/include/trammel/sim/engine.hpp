// The simulated card (with all that is built, the arc generator too), in two engines with the same step lists, cycle by
// cycle the same numbers: the golden model alone (here), and the Verilated card in lockstep with it (rtl_engine.hpp).
// Both take bus accesses in the same number of clocks. One engine, one thread; several engines may live side by side.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/steps.hpp"

namespace trammel::sim {

// Pins of the simulated card: inputs, each with a filter and any roles, and outputs.
inline constexpr unsigned kInputs = 16;
inline constexpr unsigned kOutputs = 4;

struct EngineOptions {
  unsigned axes = 4;                   // 1 .. 8
  std::uint32_t clock_hz = 1'000'000;  // what the card says of itself; 1 cycle is 1 / clock_hz seconds
  bool interrupt = false;              // the card's interrupt line reaches the bus
};

// The model can be any build of the card.
struct ModelOptions : EngineOptions {
  ModelOptions(const EngineOptions& options = {}) : EngineOptions(options) {}  // NOLINT: they are options of the model
  std::uint32_t geometry_depth = 4096;                                         // halfwords
  std::uint32_t feed_depth = 2560;                                             // halfwords
  std::optional<std::uint32_t> engines;                                        // mask; all that are built without it
};

// A card on a simulated bus: the driver's Bus, with sleep() running clocks. A refused access shows in transfer(). An
// access that is not answered within 100,000 clocks is a LinkError.
class Engine : public driver::Bus {
 public:
  // For tests, one access at a time. Throws driver::RefusedError, without a reason, for what the card refuses.
  std::uint32_t read(std::uint32_t address);
  void write(std::uint32_t address, std::uint32_t value);

  virtual void wait(std::uint64_t clocks) = 0;   // runs so many clocks
  bool wait_or_interrupt(std::uint64_t clocks);  // likewise; false: a driver::InterruptScope has ended it early
  // Levels at the card's input pins from now on; bit n: input n. An input that has got none is unwired and stands at
  // its inactive level: where INPUT_POLARITY inverts it, at 1.
  virtual void set_inputs(std::uint32_t levels) = 0;
  virtual void set_input(unsigned input, bool level) = 0;            // the others stay
  virtual void set_emergency_stop(bool pressed) = 0;                 // as by the button at its pin
  virtual void reset() = 0;                                          // as by the card's reset input
  virtual void set_sink(driver::StepSink* sink) = 0;                 // nullptr: none; not owned
  virtual std::uint64_t cycles() const = 0;                          // clocks since reset
  virtual std::uint32_t step_pins() const = 0;                       // levels at the first pins; bit n: axis n
  virtual std::optional<std::uint64_t> lockstep_cycles() const = 0;  // cycles compared; none for the model alone
  virtual std::uint64_t comparisons() const = 0;                     // signals compared
  virtual std::vector<std::int64_t> positions() const = 0;  // pulses, by axis, as the position counters have them
};

// The golden model alone, going from tick to tick. Throws std::invalid_argument for options out of range.
std::unique_ptr<Engine> make_model_engine(const ModelOptions& options);

}  // namespace trammel::sim
