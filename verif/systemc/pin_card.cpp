#include <Vclassic.h>
#include <Vdut.h>

#include "drive_pins.hpp"
#include "pin_models.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::platform {
namespace {

template <class Dut>
class VerilatedPinCard final : public PinCard {
 public:
  explicit VerilatedPinCard(std::uint32_t clock_hz) { dut_->clock_hz_i = clock_hz; }

  void clock(const CardInputs& in, CardOutputs& out) override {
    drive(in);
    dut_.clock();
    show(out);
  }

 private:
  void drive(const CardInputs& in) {
    drive_shared(*dut_, in);
    dut_->wishbone_i = bits_of(in.wishbone);
    dut_->sck_i = in.spi.sck;
    dut_->cs_n_i = in.spi.cs_n;
    dut_->mosi_i = in.spi.mosi;
    dut_->emergency_stop_level_i = 1;
    dut_->emergency_stop_i = 0;
    dut_->input_i = static_cast<CData>(in.inputs);
  }
  void show(CardOutputs& out) {
    out.axi.awready = dut_->awready_o != 0;
    out.axi.wready = dut_->wready_o != 0;
    out.axi.bvalid = dut_->bvalid_o != 0;
    out.axi.bresp = dut_->bresp_o;
    out.axi.arready = dut_->arready_o != 0;
    out.axi.rvalid = dut_->rvalid_o != 0;
    out.axi.rresp = dut_->rresp_o;
    out.axi.rdata = dut_->rdata_o;
    const QData wishbone = dut_->wishbone_o;
    out.wishbone.ack = (wishbone >> 34 & 1) != 0;
    out.wishbone.err = (wishbone >> 33 & 1) != 0;
    out.wishbone.stall = (wishbone >> 32 & 1) != 0;
    out.wishbone.dat = static_cast<std::uint32_t>(wishbone);
    out.tx = dut_->tx_o != 0;
    out.spi.enable = dut_->miso_enable_o != 0;
    out.spi.miso = dut_->miso_o != 0;
    out.step = dut_->step_o;
    out.dir = dut_->dir_o;
    out.outputs = dut_->output_o;
    out.irq = dut_->irq_o != 0;
  }

  lockstep::Simulated<Dut> dut_{lockstep::kZeros};  // all inputs are 0, straps included
};

}  // namespace

std::unique_ptr<PinCard> make_pin_card(std::uint32_t clock_hz, bool classic) {
  if (classic) return std::make_unique<VerilatedPinCard<Vclassic>>(clock_hz);
  return std::make_unique<VerilatedPinCard<Vdut>>(clock_hz);
}

}  // namespace trammel::platform
