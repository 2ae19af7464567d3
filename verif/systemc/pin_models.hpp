// The Verilated models behind plain classes: the card with all four host ports, and the checkers of their rules. Both
// are independent of SystemC; one thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pins.hpp"

namespace trammel::platform {

class PinCard {
 public:
  virtual ~PinCard() = default;
  // One rising edge with these levels at the inputs; the outputs are those after it.
  virtual void clock(const CardInputs& in, CardOutputs& out) = 0;
};
// `classic`: the Wishbone port takes classic cycles; otherwise pipelined ones.
std::unique_ptr<PinCard> make_pin_card(std::uint32_t clock_hz, bool classic);

// The rules, and their names, are those of checkers/*.sv.
class PortCheckers {
 public:
  virtual ~PortCheckers() = default;
  // One rising edge, with the levels at the pins just before it.
  virtual void clock(const CardInputs& in, const CardOutputs& out) = 0;

  // The broken rules in order, once per violation.
  const std::vector<std::string>& broken() const { return broken_; }
  void clear() { broken_.clear(); }
  // Straps: clocks per 8 bits on the serial line, 0: unknown; the Wishbone port is pipelined.
  void set_serial_period(std::uint32_t clocks) { serial_period_ = clocks; }
  void set_pipelined(bool pipelined) { pipelined_ = pipelined; }

 protected:
  std::vector<std::string> broken_;
  std::uint32_t serial_period_ = 0;
  bool pipelined_ = true;
};
std::unique_ptr<PortCheckers> make_port_checkers();

}  // namespace trammel::platform
