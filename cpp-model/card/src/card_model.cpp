#include "trammel/model/card_model.hpp"

namespace trammel::model {

void CardModel::clock(const Inputs& in) {
  const bool reset_now = reset_due_;
  reset_due_ = in.rst;
  const Axi4LitePort::Outputs& port = port_.outputs();
  CoreModel::Inputs core;
  core.rst = in.rst;
  core.request = port.request;
  core.write = port.write;
  core.partial = port.partial;
  core.address = port.address;
  core.data = port.data;
  core.pins = in.pins;
  const CoreModel::Answer answer = core_.answer();
  core_.clock(core);
  if (reset_now || in.rst) return port_.reset();  // the port also takes the pin
  Axi4LitePort::Inputs bus;
  bus.awvalid = in.awvalid;
  bus.awaddr = in.awaddr;
  bus.wvalid = in.wvalid;
  bus.wdata = in.wdata;
  bus.wstrb = in.wstrb;
  bus.bready = in.bready;
  bus.arvalid = in.arvalid;
  bus.araddr = in.araddr;
  bus.rready = in.rready;
  bus.ack = answer.ack;
  bus.error = answer.error;
  bus.data = answer.data;
  port_.clock(bus);
}

void CardModel::run(std::uint64_t clocks, std::uint16_t pins) {
  Inputs none;
  none.pins = pins;
  const Axi4LitePort::Inputs no_bus;
  while (clocks != 0) {
    const bool still = !reset_due_ && !core_.answer().ack && port_.quiet(no_bus);
    const std::uint64_t gone = still ? core_.jump(clocks, pins) : 0;
    if (gone == 0) clock(none);
    clocks -= gone == 0 ? 1 : gone;
  }
}

}  // namespace trammel::model
