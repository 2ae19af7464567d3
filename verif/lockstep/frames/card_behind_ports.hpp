// The card with all four host ports beside its model: compares the pins of ports, axes and outputs in every cycle. The
// rules of each port are judged by checkers that do not know the design (verif/systemc/checkers).
#pragma once

#include <Vdut.h>

#include <memory>

#include "host_pins.hpp"
#include "pin_models.hpp"
#include "spi_master.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/model/host_ports.hpp"
#include "trammel/sim/lockstep.hpp"
#include "uart_link.hpp"

namespace trammel::lockstep {

class CardBehindPorts {
 public:
  static constexpr unsigned kAxes = 4;
  static constexpr unsigned kBreakBits = 10;
  static constexpr std::uint64_t kComparedSignals = 8;

  struct Straps {
    std::uint8_t idle_level = 0;       // {second pins, first pins}
    std::uint8_t output_idle = 0;      // levels of the outputs in reset
    bool emergency_stop_level = true;  // level of the pin that means stop
  };

  CardBehindPorts() : CardBehindPorts(Straps()) {}
  explicit CardBehindPorts(const Straps& straps)
      : emergency_stop(!straps.emergency_stop_level),
        check_("card_with_ports", 0),
        core_(core_config(straps)),
        hosts_(host_config()),
        rules_(platform::make_port_checkers()) {
    dut_->clock_hz_i = 1'000'000;
    dut_->idle_level_i = straps.idle_level;
    dut_->output_idle_i = straps.output_idle;
    dut_->emergency_stop_level_i = straps.emergency_stop_level;
    drive_pins();
    model::CoreModel::Inputs core;
    core.emergency_stop = emergency_stop;
    for (const bool reset : {true, false}) {
      dut_->rst_i = reset;
      core.rst = reset;
      judge_rules();
      dut_.clock();
      core_.clock(core);
    }
  }

  void clock() {
    in.rx = uart.line.next();
    in.spi = spi.next(hosts_.spi().miso);
    uart.take(hosts_.uart().tx);
    drive_pins();
    judge_rules();
    const model::CoreModel::Answer answer = core_.answer();
    core_.clock(core_inputs());
    dut_.clock();
    if (dut_->rst_i != 0 || reset_before_)
      hosts_.reset();
    else
      hosts_.clock(in, {answer.ack, answer.error, answer.data});
    reset_before_ = dut_->rst_i != 0;
    check_.next_cycle();
    compare();
  }

  // One clock of reset, in which no host makes a request.
  void reset() {
    check_.event("reset");
    in.axi = {};
    in.wishbone = {};
    uart.line.clear();
    dut_->rst_i = 1;
    clock();
    dut_->rst_i = 0;
  }

  // For a master at the AXI4-Lite port (AxiHostOf), which leaves resets to reset().
  void run(const model::CardModel::Inputs& inputs, std::uint64_t clocks) {
    in.axi.set_master(inputs);
    pins = inputs.pins;
    emergency_stop = inputs.emergency_stop;
    for (; clocks != 0; --clocks) clock();
  }
  const model::Axi4LitePort::Outputs& bus() const { return hosts_.axi(); }

  const model::HostPorts& hosts() const { return hosts_; }
  std::uint32_t position(unsigned axis) const { return core_.position(axis); }
  const Checker& check() const { return check_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }
  std::uint64_t rises() const { return rises_; }

  UartEnd uart;
  SpiMaster spi;
  model::HostPorts::Inputs in;  // of the buses; set by their masters
  std::uint32_t pins = 0;       // inputs of the card
  bool emergency_stop;          // level at its pin

 private:
  static model::CardConfig core_config(const Straps& straps) {
    model::CardConfig config;
    config.axes = kAxes;
    config.ports = 4;
    config.inputs = 8;
    config.engines = model::RegisterFile::kMaxEngines;
    config.idle_level = straps.idle_level;
    config.output_idle = straps.output_idle;
    config.emergency_stop_level = straps.emergency_stop_level;
    return config;
  }
  static model::HostPorts::Config host_config() { return {true, true, true, true, true, kBreakBits}; }

  void drive_pins() {
    drive_hosts(*dut_, in);
    dut_->input_i = static_cast<CData>(pins);
    dut_->emergency_stop_i = emergency_stop;
  }

  model::CoreModel::Inputs core_inputs() {
    const model::PortArbiter::Inner inner = hosts_.inner();
    model::CoreModel::Inputs core;
    core.rst = dut_->rst_i != 0;
    core.request = inner.access.request;
    core.write = inner.access.write;
    core.partial = inner.access.partial;
    core.port = inner.port;
    core.address = inner.access.address;
    core.data = inner.access.data;
    core.of_session = inner.access.of_session;
    core.new_session = inner.access.new_session;
    core.pins = pins;
    core.emergency_stop = emergency_stop;
    return core;
  }

  // Gives the checkers the RTL's pins from before the edge.
  void judge_rules() {
    platform::CardInputs to;
    to.rst = dut_->rst_i != 0;
    const model::Axi4LitePort::Inputs& a = in.axi;
    to.axi = {a.awvalid,
              a.wvalid,
              a.bready,
              a.arvalid,
              a.rready,
              a.wstrb,
              static_cast<std::uint16_t>(a.awaddr),
              static_cast<std::uint16_t>(a.araddr),
              a.wdata};
    const model::WishbonePort::Inputs& w = in.wishbone;
    to.wishbone = {w.cyc, w.stb, w.we, w.sel, static_cast<std::uint16_t>(w.adr), w.dat};
    to.rx = in.rx;
    to.spi = {in.spi.sck, in.spi.cs_n, in.spi.mosi};
    platform::CardOutputs from;
    from.axi = {dut_->awready_o != 0, dut_->wready_o != 0, dut_->bvalid_o != 0, dut_->arready_o != 0,
                dut_->rvalid_o != 0,  dut_->bresp_o,       dut_->rresp_o,       dut_->rdata_o};
    using namespace bus::wishbone_answer;
    const QData wishbone = dut_->wishbone_o;
    from.wishbone = {get(wishbone, kAck) != 0, get(wishbone, kErr) != 0, get(wishbone, kStall) != 0,
                     static_cast<std::uint32_t>(get(wishbone, kDat))};
    from.tx = dut_->tx_o != 0;
    from.spi = {dut_->miso_o != 0, dut_->miso_enable_o != 0};
    rules_->clock(to, from);
  }

  void compare() {
    const std::vector<std::string>& broken = rules_->broken();
    check_.compare(broken.empty() ? "broken rules" : broken.front().c_str(), broken.size(), 0U);
    const model::CoreModel::Outputs& out = core_.outputs();
    check_.compare("AXI4-Lite handshakes and responses", axi_shown(*dut_), axi_shown(hosts_.axi()));
    check_.compare("tx_o", dut_->tx_o, hosts_.uart().tx);
    check_.compare("miso_o and miso_enable_o", unsigned{dut_->miso_enable_o} << 1 | dut_->miso_o,
                   unsigned{hosts_.spi().miso_enable} << 1 | unsigned{hosts_.spi().miso});
    check_.compare("Wishbone ack, err, stall", wishbone_shown(dut_->wishbone_o), wishbone_shown(hosts_.wishbone()));
    check_.compare("step_o and dir_o", dut_->step_o << kAxes | dut_->dir_o, out.step << kAxes | out.dir);
    check_.compare("irq_o", dut_->irq_o, out.irq);
    check_.compare("output_o", dut_->output_o, out.output);
    if (hosts_.axi().rvalid) {
      check_.compare("rdata_o", dut_->rdata_o, hosts_.axi().rdata);
      ++more_;
    }
    rises_ += (out.step & ~step_before_ & 1) != 0 ? 1U : 0U;
    step_before_ = out.step;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  model::CoreModel core_;
  model::HostPorts hosts_;
  std::unique_ptr<platform::PortCheckers> rules_;
  bool reset_before_ = false;
  std::uint32_t step_before_ = 0;
  std::uint64_t rises_ = 0;
  std::uint64_t more_ = 0;
};

}  // namespace trammel::lockstep
