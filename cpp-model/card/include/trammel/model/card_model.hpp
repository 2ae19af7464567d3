// Golden model of the whole card: the core behind an AXI4-Lite port. It equals the RTL at every pin in every clock.
//
// clock() is one rising edge. Not thread-safe; only the constructor reports errors.
#pragma once

#include <cstdint>

#include "trammel/model/axi4_lite_port.hpp"
#include "trammel/model/core_model.hpp"

namespace trammel::model {

class CardModel {
 public:
  using Config = CardConfig;
  using Outputs = CoreModel::Outputs;

  // Pins of the AXI4-Lite port, named as on the card; see Axi4LitePort.
  struct Inputs {
    bool rst = false;  // resets the port at once, the core one clock later (registered)
    bool awvalid = false;
    bool wvalid = false;
    bool bready = false;
    bool arvalid = false;
    bool rready = false;
    std::uint8_t wstrb = 0;
    std::uint32_t awaddr = 0;
    std::uint32_t araddr = 0;
    std::uint32_t wdata = 0;
    std::uint32_t pins = 0;       // inputs of the card, bit n: input n
    bool emergency_stop = false;  // level at its pin
  };

  // Throws std::invalid_argument for numbers out of range.
  explicit CardModel(const Config& config) : state_{CoreModel(config)} {}

  // All that the next clock() depends on besides its inputs.
  struct State {
    CoreModel core;
    Axi4LitePort port{};
    bool reset_due = false;
  };

  // One rising edge.
  void clock(const Inputs& in) { clock_parts(in, ClockEach()); }
  template <class ClockPart>
  void clock_parts(const Inputs& in, const ClockPart& clock_part);

  const State& state() const { return state_; }
  State& state() { return state_; }

  const Axi4LitePort::Outputs& bus() const { return state_.port.outputs(); }
  const Outputs& outputs() const { return state_.core.outputs(); }
  std::uint32_t position(unsigned axis) const { return state_.core.position(axis); }
  unsigned axes() const { return state_.core.config().axes; }
  std::uint64_t cycles() const { return state_.core.cycles(); }
  void set_steps(CardSteps* steps) { state_.core.set_steps(steps); }  // nullptr: none; not owned

 private:
  State state_;
};

template <class ClockPart>
void CardModel::clock_parts(const Inputs& in, const ClockPart& clock_part) {
  const bool reset_now = state_.reset_due;
  state_.reset_due = in.rst;
  const Axi4LitePort::Outputs& port = state_.port.outputs();
  CoreModel::Inputs core;
  core.rst = in.rst;
  core.request = port.request;
  core.write = port.write;
  core.partial = port.partial;
  core.address = port.address;
  core.data = port.data;
  core.pins = in.pins;
  core.emergency_stop = in.emergency_stop;
  const CoreModel::Answer answer = state_.core.answer();
  clock_part(state_.core, core);
  if (reset_now || in.rst)
    return state_.port.reset();  // the pin itself resets the port, and so does its registered copy
  Axi4LitePort::Inputs bus;
  bus.set_master(in);
  bus.ack = answer.ack;
  bus.error = answer.error;
  bus.data = answer.data;
  clock_part(state_.port, bus);
}

}  // namespace trammel::model
