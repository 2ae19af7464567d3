// Golden model of the AXI4-Lite port, cycle-exact at every port: docs/developer/architecture.md.
// One access at a time goes to the inner port; reads and writes that wait together take turns. Not thread-safe.
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
  };

  struct Outputs {
    bool awready = false;
    bool wready = false;
    bool bvalid = false;
    std::uint8_t bresp = kOkay;  // holds from answer to answer
    bool arready = false;
    bool rvalid = false;
    std::uint32_t rdata = 0;  // as bresp
    std::uint8_t rresp = kOkay;
    // to the inner port; the others mean something with `request`
    bool request = false;
    bool write = false;
    bool partial = false;
    std::uint32_t address = 0;
    std::uint32_t data = 0;
  };

  void reset() { *this = Axi4LitePort(); }

  // One rising edge with reset low.
  void clock(const Inputs& in) {
    const bool write_waits = in.awvalid && in.wvalid && !out_.bvalid;
    const bool read_waits = in.arvalid && !out_.rvalid;
    if (in.bready) out_.bvalid = false;
    if (in.rready) out_.rvalid = false;
    out_.request = false;
    out_.awready = false;
    out_.wready = false;
    out_.arready = false;
    if (!busy_) {
      take(in, write_waits, read_waits);
    } else if (in.ack) {
      answer(in);
    }
  }

  const Outputs& outputs() const { return out_; }

  // True when clocks with these same inputs change nothing.
  bool quiet(const Inputs& in) const {
    const bool handshakes = out_.request || out_.awready || out_.arready;
    const bool waits = (in.awvalid && in.wvalid) || in.arvalid;
    const bool leaves = (out_.bvalid && in.bready) || (out_.rvalid && in.rready);
    return !handshakes && !waits && !leaves && !(busy_ && in.ack);
  }

 private:
  void take(const Inputs& in, bool write_waits, bool read_waits) {
    if (!write_waits && !read_waits) return;
    const bool write = write_waits && !(read_waits && out_.write);
    busy_ = true;
    out_.request = true;
    out_.write = write;
    out_.address = write ? in.awaddr : in.araddr;
    out_.partial = in.wstrb != kAllStrobes;
    out_.data = in.wdata;
    out_.awready = write;
    out_.wready = write;
    out_.arready = !write;
  }

  void answer(const Inputs& in) {
    const std::uint8_t response = in.error ? kSlaveError : kOkay;
    busy_ = false;
    if (out_.write) {
      out_.bvalid = true;
      out_.bresp = response;
    } else {
      out_.rvalid = true;
      out_.rresp = response;
      out_.rdata = in.data;
    }
  }

  bool busy_ = false;
  Outputs out_;
};

}  // namespace trammel::model
