// The bus of a simulated card: accesses as an AXI4-Lite master makes them. The cards behind it differ in clock() and
// idle only. Both answer in the same clocks, so an access takes the same time on both.
#pragma once

#include "trammel/driver/errors.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::sim {

class BusEngine : public Engine, private model::CardSteps {
 public:
  std::uint32_t read(std::uint32_t address) override;
  void write(std::uint32_t address, std::uint32_t value) override;
  void write_block(std::uint32_t address, const std::uint32_t* words, std::size_t count,
                   driver::Addressing addressing) override;

  void set_sink(driver::StepSink* sink) override;
  std::uint64_t cycles() const override { return card().cycles(); }
  std::vector<std::int64_t> positions() const override;

 protected:
  virtual void clock(const model::CardModel::Inputs& in) = 0;
  virtual model::CardModel& card() = 0;
  virtual const model::CardModel& card() const = 0;

 private:
  template <class Ready>
  void handshake(const model::CardModel::Inputs& in, Ready ready, std::uint32_t address, driver::Direction direction);
  template <class Valid>
  void wait_for(Valid valid, std::uint32_t address, driver::Direction direction);

  void pin_step(std::uint64_t cycle, unsigned axis, int direction) override;
  void path_step(std::uint64_t command, std::uint64_t tick, unsigned axis, int direction) override;

  driver::StepSink* sink_ = nullptr;
};

// Throws std::invalid_argument for options out of range.
model::CardModel::Config config_of(const EngineOptions& options);

}  // namespace trammel::sim
