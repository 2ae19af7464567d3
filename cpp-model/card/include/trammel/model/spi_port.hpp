// Golden model of the SPI port, cycle-exact at every port: docs/developer/architecture.md. Not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/frames/stuffing.hpp"

namespace trammel::model {

class SpiPort {
 public:
  struct Pins {
    bool sck = true;
    bool cs_n = true;
    bool mosi = false;
  };
  struct Inputs {
    Pins pins;
    bool valid = false;  // a byte for the master
    std::uint8_t byte = 0;
  };
  struct Outputs {
    bool miso = true;
    bool miso_enable = false;
    bool byte_valid = false;  // event
    std::uint8_t byte = 0;    // valid with byte_valid
    bool ready = false;       // event: the offered byte is taken
  };

  void reset() { *this = SpiPort(); }

  // One rising edge with reset low.
  void clock(const Inputs& in) {
    const Pins pins = second_;
    out_.byte_valid = out_.ready;
    if (out_.ready) {
      out_.byte = static_cast<std::uint8_t>(unsigned{taken_} << 1 | (pins.mosi ? 1U : 0U));
      given_ = in.valid ? in.byte : frames::kEnd;
      place_ = 0;
    } else if (rises_) {
      taken_ = static_cast<std::uint8_t>(unsigned{taken_} << 1 | (pins.mosi ? 1U : 0U));
      ++place_;
    }
    // After an interruption by CS, a byte that was begun is not sent again from its start: its frame is lost anyway.
    if (rises_) bits_ = out_.ready ? 0 : bits_ + 1;
    if (pins.cs_n) bits_ = 0;
    out_.miso = place_ < 8 && (given_ >> (7 - place_) & 1) != 0;
    out_.miso_enable = !pins.cs_n;
    rises_ = !second_.sck && first_.sck && !first_.cs_n;
    second_ = first_;
    first_ = in.pins;
    out_.ready = rises_ && bits_ == 7;
  }

  const Outputs& outputs() const { return out_; }

 private:
  Pins first_;
  Pins second_;  // levels two clocks ago; `first_`: one clock ago
  bool rises_ = false;
  unsigned bits_ = 0;   // bits taken since the byte began
  unsigned place_ = 0;  // bits of `given_` that were sent
  std::uint8_t taken_ = 0;
  std::uint8_t given_ = frames::kEnd;
  Outputs out_;
};

}  // namespace trammel::model
