// The functions that SystemC requires of the bundles of pins.hpp, so that they can be the type of a signal.
#pragma once

#include <ostream>
#include <string>
#include <systemc>

#include "pins.hpp"

namespace trammel::platform {

// Calls `visit` with the name and the value of each pin of a bundle.
template <class Visit>
void each_pin(const AxiMaster& b, Visit visit) {
  visit("awvalid", b.awvalid), visit("awaddr", b.awaddr), visit("wvalid", b.wvalid), visit("wdata", b.wdata);
  visit("wstrb", b.wstrb), visit("bready", b.bready), visit("arvalid", b.arvalid), visit("araddr", b.araddr);
  visit("rready", b.rready);
}
template <class Visit>
void each_pin(const AxiCard& b, Visit visit) {
  visit("awready", b.awready), visit("wready", b.wready), visit("bvalid", b.bvalid), visit("bresp", b.bresp);
  visit("arready", b.arready), visit("rvalid", b.rvalid), visit("rdata", b.rdata), visit("rresp", b.rresp);
}
template <class Visit>
void each_pin(const WishboneMaster& b, Visit visit) {
  visit("cyc", b.cyc), visit("stb", b.stb), visit("we", b.we), visit("sel", b.sel), visit("adr", b.adr);
  visit("dat", b.dat);
}
template <class Visit>
void each_pin(const WishboneCard& b, Visit visit) {
  visit("ack", b.ack), visit("err", b.err), visit("stall", b.stall), visit("dat", b.dat);
}
template <class Visit>
void each_pin(const SpiMaster& b, Visit visit) {
  visit("sck", b.sck), visit("cs_n", b.cs_n), visit("mosi", b.mosi);
}
template <class Visit>
void each_pin(const SpiCard& b, Visit visit) {
  visit("miso", b.miso), visit("enable", b.enable);
}

// For any bundle. SystemC finds these functions by the namespace of their arguments.
struct AnyPin {
  template <class Pin>
  void operator()(const char*, const Pin&) const {}
};
template <class Bundle>
auto operator<<(std::ostream& out, const Bundle& bundle) -> decltype(each_pin(bundle, AnyPin()), out) {
  each_pin(bundle, [&out](const char* name, const auto& pin) { out << name << '=' << +pin << ' '; });
  return out;
}
template <class Bundle>
auto sc_trace(sc_core::sc_trace_file* file, const Bundle& bundle, const std::string& name)
    -> decltype(each_pin(bundle, AnyPin())) {
  each_pin(bundle, [&](const char* pin, const auto& value) { sc_core::sc_trace(file, value, name + "." + pin); });
}

}  // namespace trammel::platform
