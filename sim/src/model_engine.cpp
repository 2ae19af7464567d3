#include "bus_engine.hpp"

namespace trammel::sim {

namespace {

class ModelEngine final : public BusEngine {
 public:
  explicit ModelEngine(const EngineOptions& options) : card_(config_of(options)) {}

  void wait(std::uint64_t card_clocks) override { card_.run(card_clocks); }
  std::optional<std::uint64_t> lockstep_cycles() const override { return std::nullopt; }
  std::uint64_t comparisons() const override { return 0; }

 private:
  void clock(const model::CardModel::Inputs& in) override { card_.clock(in); }
  model::CardModel& card() override { return card_; }
  const model::CardModel& card() const override { return card_; }

  model::CardModel card_;
};

}  // namespace

std::unique_ptr<Engine> make_model_engine(const EngineOptions& options) {
  return std::make_unique<ModelEngine>(options);
}

}  // namespace trammel::sim
