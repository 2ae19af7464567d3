// The bus of a simulated card: makes accesses as an AXI4-Lite master does. The cards behind it differ only in
// clock_card() and wait(). Both answer in the same number of clocks, so an access takes the same time on both.
#pragma once

#include "trammel/driver/errors.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::sim {

class BusEngine : public Engine, private model::CardSteps {
 public:
  explicit BusEngine(const EngineOptions& options) : clock_hz_(options.clock_hz), interrupt_(options.interrupt) {}

  std::size_t transfer(driver::Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return true; }
  bool has_interrupt() const override { return interrupt_; }
  bool wait_for_interrupt(std::chrono::nanoseconds longest) override;

  void set_inputs(std::uint32_t levels) override {
    pins_ = levels;
    wired_ = ~std::uint32_t{0};
  }
  void set_input(unsigned input, bool level) override {
    const std::uint32_t pin = std::uint32_t{1} << input;
    pins_ = level ? pins_ | pin : pins_ & ~pin;
    wired_ |= pin;
  }
  void set_emergency_stop(bool pressed) override { emergency_stop_ = pressed; }
  void reset() override;
  void set_sink(driver::StepSink* sink) override;
  std::uint64_t cycles() const override { return card().cycles(); }
  std::uint32_t step_pins() const override { return card().outputs().step; }
  std::vector<std::int64_t> positions() const override;

 protected:
  // One clock.
  virtual void clock_card(const model::CardModel::Inputs& in) = 0;
  // The card's inputs without bus traffic, for wait().
  model::CardModel::Inputs quiet_bus() const {
    model::CardModel::Inputs in;
    in.pins = pins_;
    in.emergency_stop = emergency_stop_;
    return in;
  }
  virtual model::CardModel& card() = 0;
  virtual const model::CardModel& card() const = 0;

  // Records an access for the report of a mismatch.
  virtual void note(const driver::Access& access) = 0;

 private:
  void clock(model::CardModel::Inputs in) {
    in.pins = pins_;
    in.emergency_stop = emergency_stop_;
    clock_card(in);
  }
  bool make(driver::Access& access);
  bool read_register(driver::Access& access);
  bool write_register(const driver::Access& access);
  template <class Ready>
  void handshake(const model::CardModel::Inputs& in, Ready ready, const driver::Access& access);
  template <class Valid>
  void wait_for(Valid valid, const driver::Access& access);

  void pin_step(std::uint64_t cycle, unsigned axis, int direction) override;
  void path_step(std::uint64_t cycle, std::uint64_t command, std::uint64_t tick, unsigned axis, int direction) override;
  void outputs(std::uint64_t cycle, std::uint16_t before, std::uint16_t levels) override;

  std::uint32_t clock_hz_;
  bool interrupt_;
  std::uint32_t pins_ = 0;
  std::uint32_t wired_ = 0;      // inputs that were set; the others follow INPUT_POLARITY
  bool emergency_stop_ = false;  // pin level; the strap makes 1 mean stop
  driver::StepSink* sink_ = nullptr;
};

// Throws std::invalid_argument for options out of range.
model::CardModel::Config config_of(const EngineOptions& options);

}  // namespace trammel::sim
