// A simulated card with a machine behind its pins: an engine (golden model or Verilated card), and a world that the
// card's pulses move and that sets the card's inputs. It is itself an Engine, identical clock by clock to the one
// inside.
//
// Delay of an input. During a wait the engine stops at each clock in which a pin may change. A switch therefore changes
// its pin at the end of the integration step in which the carriage reaches it (at most 20 microseconds, or one clock if
// that is longer); a bounce or an event changes it in its own clock. Accesses are made one by one and are not
// interrupted; a change during an access takes effect when the access has been answered. So the delay is at most one
// integration step and one access. An access to a register takes some ten clocks; an access that starts a move takes
// some hundred.
#pragma once

#include <memory>

#include "trammel/sim/engine.hpp"
#include "trammel/world/world.hpp"

namespace trammel::world {

// Thread-safety: as of sim::Engine, the world included.
class EngineInWorld final : public sim::Engine, private driver::StepSink {
 public:
  // `world` must outlive the object, be at clock 0, and have the card's clock frequency. Throws std::invalid_argument
  // for a world that wires inputs that the card does not have.
  EngineInWorld(std::unique_ptr<sim::Engine> engine, World& world);

  std::size_t transfer(driver::Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return engine_->reports_refusals(); }
  bool has_interrupt() const override { return engine_->has_interrupt(); }
  bool wait_for_interrupt(std::chrono::nanoseconds longest) override;
  std::string hold_origin() const override { return engine_->hold_origin(); }

  void wait(std::uint64_t clocks) override;
  // Sets only inputs that the world does not wire; the world controls the others.
  void set_inputs(std::uint32_t levels) override;
  void set_input(unsigned input, bool level) override;
  void set_emergency_stop(bool pressed) override;  // no effect if the world has the button
  // Resets the card alone: the machine stays in its position, and its time continues.
  void reset() override;
  void set_sink(driver::StepSink* sink) override { sink_ = sink; }
  std::uint64_t cycles() const override { return engine_->cycles(); }
  std::uint32_t step_pins() const override { return engine_->step_pins(); }
  std::optional<std::uint64_t> lockstep_cycles() const override { return engine_->lockstep_cycles(); }
  std::uint64_t comparisons() const override { return engine_->comparisons(); }
  std::vector<std::int64_t> positions() const override { return engine_->positions(); }

 private:
  void pin_step(const driver::PinStep& step) override;
  void path_step(const driver::PathStep& step) override;
  void outputs_changed(const driver::OutputChange& change) override;

  std::uint64_t time() const { return engine_->cycles() + before_reset_; }
  void catch_up();  // advances the world to the card's time, then sets the pins from the world
  void set_pins();

  std::unique_ptr<sim::Engine> engine_;
  World& world_;
  std::uint32_t clock_hz_;
  driver::StepSink* sink_ = nullptr;
  std::uint64_t before_reset_ = 0;  // world's clock at the card's clock 0
  std::uint32_t levels_ = 0;        // levels at the card's pins
  bool emergency_stop_ = false;
};

}  // namespace trammel::world
