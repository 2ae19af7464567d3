// Golden model of the whole card: the core behind an AXI4-Lite port, cycle by cycle the same at every pin.
//
// clock() is one rising edge; run(n) is n edges without bus traffic and leaves exactly the state that n calls of
// clock() leave. Not thread-safe; no errors are reported beside the constructor's.
#pragma once

#include <cstdint>

#include "trammel/model/axi4_lite_port.hpp"
#include "trammel/model/core_model.hpp"

namespace trammel::model {

class CardModel {
 public:
  using Config = CardConfig;
  using Outputs = CoreModel::Outputs;

  // Pins of the AXI4-Lite port, as the card has them; see Axi4LitePort.
  struct Inputs {
    bool rst = false;  // registered: beyond the port it takes effect a clock later
    bool awvalid = false;
    bool wvalid = false;
    bool bready = false;
    bool arvalid = false;
    bool rready = false;
    std::uint8_t wstrb = 0;
    std::uint32_t awaddr = 0;
    std::uint32_t araddr = 0;
    std::uint32_t wdata = 0;
    std::uint16_t pins = 0;  // inputs of the card, bit n: input n
  };

  // Throws std::invalid_argument for numbers out of range.
  explicit CardModel(const Config& config) : core_(config) {}

  // One rising edge.
  void clock(const Inputs& in);
  // `clocks` rising edges with all valid and ready inputs low, with these levels at the card's inputs.
  void run(std::uint64_t clocks, std::uint16_t pins = 0);

  const Axi4LitePort::Outputs& bus() const { return port_.outputs(); }
  const Outputs& outputs() const { return core_.outputs(); }
  std::uint32_t position(unsigned axis) const { return core_.position(axis); }
  unsigned axes() const { return core_.config().axes; }
  std::uint64_t cycles() const { return core_.cycles(); }
  void set_steps(CardSteps* steps) { core_.set_steps(steps); }  // nullptr: none; not owned

 private:
  CoreModel core_;
  Axi4LitePort port_;
  bool reset_due_ = false;
};

}  // namespace trammel::model
