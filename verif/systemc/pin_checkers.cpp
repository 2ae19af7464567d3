#include <Vcheckers.h>
#include <verilated.h>

#include "drive_pins.hpp"
#include "pin_models.hpp"

namespace trammel::platform {

namespace {

// port_rule_broken() adds its rules here; set while the checkers are evaluated.
thread_local std::vector<std::string>* broken_now = nullptr;

class VerilatedCheckers final : public PortCheckers {
 public:
  VerilatedCheckers() : dut_(make()) {}
  ~VerilatedCheckers() override {
    Verilated::threadContextp(&context_);
    dut_->final();
    dut_.reset();
  }

  // Assertions sample the values from before the edge, so everything that depends on the pins is evaluated first.
  void clock(const CardInputs& in, const CardOutputs& out) override {
    drive(in);
    drive(out);
    dut_->period_i = serial_period_;
    dut_->pipelined_i = pipelined_;
    broken_now = &broken_;
    if (Verilated::threadContextp() != &context_) Verilated::threadContextp(&context_);
    dut_->clk_i = 0;
    dut_->eval();
    dut_->clk_i = 1;
    dut_->eval();
    broken_now = nullptr;
  }

 private:
  // eval() does not select its context itself.
  std::unique_ptr<Vcheckers> make() {
    Verilated::threadContextp(&context_);
    context_.threads(1);
    return std::make_unique<Vcheckers>(&context_);
  }
  void drive(const CardInputs& in) {
    drive_shared(*dut_, in);
    dut_->wishbone_master_i = bits_of(in.wishbone);
    dut_->spi_master_i = bits_of(in.spi);
  }
  void drive(const CardOutputs& out) {
    dut_->awready_i = out.axi.awready;
    dut_->wready_i = out.axi.wready;
    dut_->bvalid_i = out.axi.bvalid;
    dut_->bresp_i = out.axi.bresp;
    dut_->arready_i = out.axi.arready;
    dut_->rvalid_i = out.axi.rvalid;
    dut_->rresp_i = out.axi.rresp;
    dut_->rdata_i = out.axi.rdata;
    dut_->wishbone_card_i = static_cast<CData>(unsigned{out.wishbone.ack} << 2 | unsigned{out.wishbone.err} << 1 |
                                               unsigned{out.wishbone.stall});
    dut_->tx_i = out.tx;
    dut_->spi_card_i = static_cast<CData>(unsigned{out.spi.enable} << 1 | unsigned{out.spi.miso});
  }

  VerilatedContext context_;
  std::unique_ptr<Vcheckers> dut_;
};

}  // namespace

std::unique_ptr<PortCheckers> make_port_checkers() { return std::make_unique<VerilatedCheckers>(); }

}  // namespace trammel::platform

// Called by the checkers' assertions (checkers/*.sv).
extern "C" void port_rule_broken(const char* rule) {
  if (trammel::platform::broken_now != nullptr) trammel::platform::broken_now->emplace_back(rule);
}
