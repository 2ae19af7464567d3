// Golden model of the AXI4-Lite port, cycle-exact at every port: docs/developer/architecture.md. The inner port
// receives one access at a time; reads and writes that wait together take turns. Not thread-safe.
#pragma once

#include <cstdint>

namespace trammel::model {

class Axi4LitePort {
 public:
  static constexpr std::uint8_t kOkay = 0;
  static constexpr std::uint8_t kSlaveError = 2;
  static constexpr std::uint8_t kAllStrobes = 0xF;

  struct Inputs {
    bool awvalid = false;
    std::uint32_t awaddr = 0;  // byte address, 12 bits
    bool wvalid = false;
    std::uint32_t wdata = 0;
    std::uint8_t wstrb = 0;
    bool bready = false;
    bool arvalid = false;
    std::uint32_t araddr = 0;  // byte address, 12 bits
    bool rready = false;
    // from the inner port
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;

    // Takes over what a bus master drives, from a struct with fields of the same names.
    template <class Signals>
    void set_master(const Signals& from) {
      awvalid = from.awvalid;
      awaddr = from.awaddr;
      wvalid = from.wvalid;
      wdata = from.wdata;
      wstrb = from.wstrb;
      bready = from.bready;
      arvalid = from.arvalid;
      araddr = from.araddr;
      rready = from.rready;
    }
  };

  struct Outputs {
    bool awready = false;
    bool wready = false;
    bool bvalid = false;
    std::uint8_t bresp = kOkay;  // holds until the next write response
    bool arready = false;
    bool rvalid = false;
    std::uint32_t rdata = 0;  // holds until the next read response
    std::uint8_t rresp = kOkay;
    // to the inner port; the other fields are valid with `request`
    bool request = false;
    bool write = false;
    bool partial = false;
    std::uint32_t address = 0;
    std::uint32_t data = 0;
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    bool busy = false;
    Outputs out;
  };

  void reset() { *this = Axi4LitePort(); }

  // One rising edge with reset low.
  void clock(const Inputs& in) {
    const bool write_waits = in.awvalid && in.wvalid && !state_.out.bvalid;
    const bool read_waits = in.arvalid && !state_.out.rvalid;
    if (in.bready) state_.out.bvalid = false;
    if (in.rready) state_.out.rvalid = false;
    state_.out.request = false;
    state_.out.awready = false;
    state_.out.wready = false;
    state_.out.arready = false;
    if (!state_.busy) {
      take(in, write_waits, read_waits);
    } else if (in.ack) {
      answer(in);
    }
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  void take(const Inputs& in, bool write_waits, bool read_waits) {
    if (!write_waits && !read_waits) return;
    const bool write = write_waits && !(read_waits && state_.out.write);
    state_.busy = true;
    state_.out.request = true;
    state_.out.write = write;
    state_.out.address = write ? in.awaddr : in.araddr;
    state_.out.partial = in.wstrb != kAllStrobes;
    state_.out.data = in.wdata;
    state_.out.awready = write;
    state_.out.wready = write;
    state_.out.arready = !write;
  }

  void answer(const Inputs& in) {
    const std::uint8_t response = in.error ? kSlaveError : kOkay;
    state_.busy = false;
    if (state_.out.write) {
      state_.out.bvalid = true;
      state_.out.bresp = response;
    } else {
      state_.out.rvalid = true;
      state_.out.rresp = response;
      state_.out.rdata = in.data;
    }
  }

  State state_;
};

}  // namespace trammel::model
