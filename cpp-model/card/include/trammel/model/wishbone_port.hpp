// Golden model of the Wishbone B4 port, classic or pipelined, cycle-exact at every port:
// docs/developer/architecture.md. One access at a time goes to the inner port. Not thread-safe.
#pragma once

#include <cstdint>

namespace trammel::model {

class WishbonePort {
 public:
  static constexpr std::uint8_t kAllBytes = 0xF;

  struct Inputs {
    bool cyc = false;
    bool stb = false;
    bool we = false;
    std::uint32_t adr = 0;  // byte address, 12 bits
    std::uint8_t sel = 0;
    std::uint32_t dat = 0;
    // from the inner port
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
  };

  struct Outputs {
    bool ack = false;
    bool err = false;
    bool stall = false;     // pipelined: busy, or reset in the previous clock
    std::uint32_t dat = 0;  // holds until the next answer
    // to the inner port; the other fields hold from `request` to its answer
    bool request = false;
    bool write = false;
    bool partial = false;
    std::uint32_t address = 0;
    std::uint32_t data = 0;
  };

  // Starts in the state after a reset.
  explicit WishbonePort(bool pipelined = false) : pipelined_(pipelined) { out_.stall = pipelined; }

  void reset() { *this = WishbonePort(pipelined_); }

  // One rising edge with reset low.
  void clock(const Inputs& in) {
    const bool asked = in.cyc && in.stb;
    // The master's signals in this clock decide whether somebody still waits for the answer.
    const bool waits = pipelined_ ? in.cyc : asked;
    const bool answered = out_.ack || out_.err;
    const bool take = asked && (pipelined_ ? !out_.stall : !busy_ && !answered);
    if (!waits) given_up_ = true;
    out_.ack = in.ack && !in.error && !given_up_;
    out_.err = in.ack && in.error && !given_up_;
    if (in.ack) {
      out_.dat = in.data;
      busy_ = false;
    }
    out_.request = take;
    if (take) {
      busy_ = true;
      given_up_ = false;
      out_.write = in.we;
      out_.partial = in.we && in.sel != kAllBytes;
      out_.address = in.adr;
      out_.data = in.dat;
    }
    out_.stall = pipelined_ && busy_;
  }

  const Outputs& outputs() const { return out_; }

 private:
  bool pipelined_;
  bool busy_ = false;
  bool given_up_ = true;
  Outputs out_;
};

}  // namespace trammel::model
