// An SPI master, in clocks of the card: modes 0 and 3, with an SCK period that is not a whole number of clocks.
#pragma once

#include <cstdint>
#include <deque>

#include "trammel/frames/frame.hpp"
#include "trammel/model/spi_port.hpp"

namespace trammel::lockstep {

class SpiMaster {
 public:
  // `period`: clocks of the card, at least 4. Takes effect while idle.
  void set(unsigned mode, double period) {
    idle_sck_ = mode == 3;
    half_ = period / 2;
    if (!busy()) pins_.sck = idle_sck_;
  }
  // One exchange: select, these bytes, deselect. `bits`: bits of the last byte that are sent, 8: all.
  void exchange(const frames::Bytes& bytes, unsigned bits = 8) {
    waiting_ = bytes;
    bits_left_ = static_cast<unsigned>(8 * bytes.size()) - (8 - bits);
    received_.clear();
    at_ = At::Select;
    left_ = 8;
    place_ = 0;
    shift_ = 0;
  }
  bool busy() const { return at_ != At::Idle; }
  // The whole bytes received in the exchange.
  const frames::Bytes& received() const { return received_; }

  // The pins in the next clock. `miso`: its level one set-up time before.
  model::SpiPort::Pins next(bool miso) {
    left_ -= 1;
    while (left_ <= 0 && at_ != At::Idle) step(miso);
    return pins_;
  }

 private:
  enum class At : std::uint8_t { Idle, Select, First, Second, Deselect, Gap };

  void step(bool miso) {
    switch (at_) {
      case At::Idle:
        return;
      case At::Select:
        pins_.cs_n = false;
        left_ += 8;
        at_ = At::First;
        break;
      case At::First:  // falling edge, or before the first rising edge; the bit is output
        if (bits_left_ == 0) {
          // Mode 0 returns to low before the end, mode 3 stays high.
          pins_.sck = idle_sck_;
          at_ = At::Deselect;
          left_ += 8;
          break;
        }
        pins_.sck = false;
        pins_.mosi = (waiting_[place_ / 8] >> (7 - place_ % 8) & 1) != 0;
        left_ += half_;
        at_ = At::Second;
        break;
      case At::Second:  // rising edge: both sides sample their bit
        pins_.sck = true;
        shift_ = static_cast<std::uint8_t>(unsigned{shift_} << 1 | (miso ? 1U : 0U));
        if (++place_ % 8 == 0) received_.push_back(shift_);
        --bits_left_;
        left_ += half_;
        at_ = At::First;
        break;
      case At::Deselect:
        pins_.cs_n = true;
        left_ += 8;
        at_ = At::Gap;
        break;
      case At::Gap:
        at_ = At::Idle;
        break;
    }
  }

  bool idle_sck_ = false;
  double half_ = 2;
  model::SpiPort::Pins pins_;
  At at_ = At::Idle;
  double left_ = 0;  // clocks
  frames::Bytes waiting_;
  frames::Bytes received_;
  unsigned bits_left_ = 0;
  unsigned place_ = 0;
  std::uint8_t shift_ = 0;
};

}  // namespace trammel::lockstep
