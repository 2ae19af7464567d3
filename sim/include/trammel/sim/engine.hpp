// The simulated card, in two engines with the same step lists, cycle by cycle the same numbers: the golden model alone
// (here), and the Verilated card in lockstep with it (rtl_engine.hpp). Both take bus accesses in the same number of
// clocks. One engine, one thread; several engines may live side by side.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/steps.hpp"

namespace trammel::sim {

struct EngineOptions {
  unsigned axes = 4;                   // 1 .. 8
  std::uint32_t clock_hz = 1'000'000;  // what the card says of itself; 1 cycle is 1 / clock_hz seconds
};

// A card on a simulated bus: the driver's Bus, with wait() running clocks.
class Engine : public driver::Bus {
 public:
  virtual void set_sink(driver::StepSink* sink) = 0;                 // nullptr: none; not owned
  virtual std::uint64_t cycles() const = 0;                          // clocks since reset
  virtual std::optional<std::uint64_t> lockstep_cycles() const = 0;  // cycles compared; none for the model alone
  virtual std::uint64_t comparisons() const = 0;                     // signals compared
  virtual std::vector<std::int64_t> positions() const = 0;  // pulses, by axis, as the position counters have them
};

// The golden model alone, going from tick to tick. Throws std::invalid_argument for options out of range.
std::unique_ptr<Engine> make_model_engine(const EngineOptions& options);

}  // namespace trammel::sim
