#include "lockstep_card.hpp"

namespace trammel::sim {

namespace {

constexpr unsigned kCardSignals = 16;  // of CardModel::Outputs
constexpr unsigned kBusSignals = 8;    // at the AXI4-Lite port
constexpr int kResetClocks = 4;

// Response and data mean something with their valid only.
bool same_bus(const model::Axi4LitePort::Outputs& a, const model::Axi4LitePort::Outputs& b) {
  return a.awready == b.awready && a.wready == b.wready && a.bvalid == b.bvalid && a.arready == b.arready &&
         a.rvalid == b.rvalid && (!a.bvalid || a.bresp == b.bresp) &&
         (!a.rvalid || (a.rdata == b.rdata && a.rresp == b.rresp));
}

}  // namespace

LockstepCard::LockstepCard(std::unique_ptr<VerilatedCard> card, const model::CardModel::Config& config,
                           std::uint64_t seed)
    : card_(std::move(card)), model_(config), checker_("card", seed) {
  model::CardModel::Inputs reset;
  reset.rst = true;
  for (int i = 0; i < kResetClocks; ++i) {
    card_->clock(reset);
    model_.clock(reset);
  }
  // The reset is registered: one more clock under it.
  card_->clock({});
  model_.clock({});
}

void LockstepCard::clock(const model::CardModel::Inputs& in) {
  card_->clock(in);
  model_.clock(in);
  checker_.next_cycle();
  compare();
}

// All signals at once; they are told apart only when something differs.
void LockstepCard::compare() {
  card_->read(ports_);
  bool same = ports_.card == model_.outputs() && same_bus(ports_.bus, model_.bus());
  for (unsigned n = 0; n < model_.axes(); ++n) same = same && ports_.position[n] == model_.position(n);
  comparisons_ += kCardSignals + kBusSignals + model_.axes();
  if (!same) name_difference();
}

void LockstepCard::name_difference() {
  const model::CardModel::Outputs& rtl = ports_.card;
  const model::CardModel::Outputs& golden = model_.outputs();
  checker_.compare("tick_o", rtl.tick, golden.tick);
  checker_.compare("path_swap_o", rtl.path_swap, golden.path_swap);
  checker_.compare("feed_swap_o", rtl.feed_swap, golden.feed_swap);
  checker_.compare("path_tick_o", rtl.path_tick, golden.path_tick);
  checker_.compare("path_step_o", rtl.path_step, golden.path_step);
  checker_.compare("path_dir_o", rtl.path_dir, golden.path_dir);
  checker_.compare("step_o", rtl.step, golden.step);
  checker_.compare("dir_o", rtl.dir, golden.dir);
  checker_.compare("status_o", rtl.status, golden.status);
  checker_.compare("fault_o", rtl.fault, golden.fault);
  checker_.compare("running_o", rtl.running, golden.running);
  checker_.compare("geometry_room_o", rtl.geometry_room, golden.geometry_room);
  checker_.compare("feed_room_o", rtl.feed_room, golden.feed_room);
  checker_.compare("ratio_o", rtl.ratio, golden.ratio);
  checker_.compare("rate_o", rtl.rate, golden.rate);
  checker_.compare("irq_o", rtl.irq, golden.irq);
  const model::Axi4LitePort::Outputs& bus = ports_.bus;
  const model::Axi4LitePort::Outputs& golden_bus = model_.bus();
  checker_.compare("awready_o", bus.awready, golden_bus.awready);
  checker_.compare("wready_o", bus.wready, golden_bus.wready);
  checker_.compare("bvalid_o", bus.bvalid, golden_bus.bvalid);
  checker_.compare("bresp_o", bus.bresp, golden_bus.bresp);
  checker_.compare("arready_o", bus.arready, golden_bus.arready);
  checker_.compare("rvalid_o", bus.rvalid, golden_bus.rvalid);
  checker_.compare("rdata_o", bus.rdata, golden_bus.rdata);
  checker_.compare("rresp_o", bus.rresp, golden_bus.rresp);
  for (unsigned n = 0; n < model_.axes(); ++n) {
    checker_.compare("position_o", ports_.position[n], model_.position(n));
  }
}

}  // namespace trammel::sim
