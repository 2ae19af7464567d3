#include "rtl_engine.hpp"

#include <stdexcept>

#include "bus_engine.hpp"
#include "lockstep_card.hpp"

namespace trammel::sim {

namespace {

using model::CardModel;

class RtlEngine final : public BusEngine {
 public:
  RtlEngine(std::unique_ptr<VerilatedCard> card, const SimulationOptions& options)
      : BusEngine(options),
        card_(std::move(card), config_of(options), options.seed, options.trace ? 1 : LockstepCard::kBatch,
              options.rtl_thread && !options.trace ? RtlThread::kOwn : RtlThread::kCallers) {}

  void wait(std::uint64_t card_clocks) override { card_.run(quiet_bus(), card_clocks); }
  std::optional<std::uint64_t> lockstep_cycles() const override {
    card_.settle();
    return card_.cycles();
  }
  std::uint64_t comparisons() const override {
    card_.settle();
    return card_.comparisons();
  }

 private:
  void note(const driver::Access& access) override {
    if (access.write) {
      card_.event("write to", access.address);
      card_.event("written", access.data);
    } else {
      card_.event("read", access.address);
    }
  }
  void clock_card(const CardModel::Inputs& in) override { card_.run(in, 1); }
  CardModel& card() override { return card_.model(); }
  const CardModel& card() const override { return card_.model(); }

  mutable LockstepCard card_;  // mutable: a query of the comparisons makes the RTL catch up
};

}  // namespace

std::unique_ptr<Engine> make_engine(const SimulationOptions& options) {
  if (options.kind == EngineKind::kModel) {
    if (options.trace) throw std::invalid_argument("a trace needs the RTL engine");
    return make_model_engine(options);
  }
  return make_rtl_engine(make_verilated_card(config_of(options).axes, {options.clock_hz, 0}, options.trace), options);
}

std::unique_ptr<Engine> make_rtl_engine(std::unique_ptr<VerilatedCard> card, const SimulationOptions& options) {
  return std::make_unique<RtlEngine>(std::move(card), options);
}

}  // namespace trammel::sim
