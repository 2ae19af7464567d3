#include "bus_engine.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::sim {

namespace {

model::CardModel::Config model_config(const ModelOptions& options) {
  model::CardModel::Config config = config_of(options);
  config.geometry_depth = options.geometry_depth;
  config.feed_depth = options.feed_depth;
  if (options.engines) config.engines = *options.engines;
  return config;
}

class ModelEngine final : public BusEngine {
 public:
  explicit ModelEngine(const ModelOptions& options) : BusEngine(options), card_(model_config(options)) {}

  void wait(std::uint64_t card_clocks) override {
    skip::run(card_, card_clocks, {quiet_bus().pins, quiet_bus().emergency_stop});
  }
  std::optional<std::uint64_t> lockstep_cycles() const override { return std::nullopt; }
  std::uint64_t comparisons() const override { return 0; }

 private:
  void note(const driver::Access&) override {}
  void clock_card(const model::CardModel::Inputs& in) override { skip::clock(card_, in); }
  model::CardModel& card() override { return card_; }
  const model::CardModel& card() const override { return card_; }

  model::CardModel card_;
};

}  // namespace

std::unique_ptr<Engine> make_model_engine(const ModelOptions& options) {
  return std::make_unique<ModelEngine>(options);
}

}  // namespace trammel::sim
