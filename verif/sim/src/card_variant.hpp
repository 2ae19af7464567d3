// One variant of the Verilated card; instantiated once for each Verilated class, in a file of its own.
#pragma once

#include "lockstep.hpp"
#include "verilated_card.hpp"

namespace trammel::sim {

template <class Dut, unsigned kAxes>
class CardVariant : public VerilatedCard {
 public:
  explicit CardVariant(std::uint32_t clock_hz) { dut_->clock_hz_i = clock_hz; }

  void clock(const model::CardModel::Inputs& in) override {
    dut_->rst_i = in.rst;
    dut_->awvalid_i = in.awvalid;
    dut_->awaddr_i = static_cast<std::uint16_t>(in.awaddr);
    dut_->wvalid_i = in.wvalid;
    dut_->wdata_i = in.wdata;
    dut_->wstrb_i = in.wstrb;
    dut_->bready_i = in.bready;
    dut_->arvalid_i = in.arvalid;
    dut_->araddr_i = static_cast<std::uint16_t>(in.araddr);
    dut_->rready_i = in.rready;
    dut_.clock();
  }

  void read(Ports& ports) override {
    model::CardModel::Outputs& card = ports.card;
    card.step = dut_->step_o;
    card.dir = dut_->dir_o;
    card.irq = dut_->irq_o;
    card.tick = dut_->tick_o;
    card.path_tick = dut_->path_tick_o;
    card.path_swap = dut_->path_swap_o;
    card.feed_swap = dut_->feed_swap_o;
    card.path_step = dut_->path_step_o;
    card.path_dir = dut_->path_dir_o;
    card.geometry_room = dut_->geometry_room_o;
    card.feed_room = dut_->feed_room_o;
    card.status = dut_->status_o;
    card.fault = dut_->fault_o;
    card.running = dut_->running_o;
    card.ratio = dut_->ratio_o;
    card.rate = dut_->rate_o;
    model::Axi4LitePort::Outputs& bus = ports.bus;
    bus.awready = dut_->awready_o;
    bus.wready = dut_->wready_o;
    bus.bvalid = dut_->bvalid_o;
    bus.bresp = dut_->bresp_o;
    bus.arready = dut_->arready_o;
    bus.rvalid = dut_->rvalid_o;
    bus.rdata = dut_->rdata_o;
    bus.rresp = dut_->rresp_o;
    for (unsigned n = 0; n < kAxes; ++n) ports.position[n] = dut_->position_o[n];
  }

 protected:
  lockstep::Simulated<Dut> dut_;
};

}  // namespace trammel::sim
