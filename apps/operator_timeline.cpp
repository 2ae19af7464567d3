#include "operator_timeline.hpp"

#include <cmath>

#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"

namespace trammel::app {

namespace reg = card_map::reg;

void OperatorTimeline::schedule(sim::TimedBus& bus, std::uint32_t clock_hz) {
  bus.at(0, [this](sim::Engine& engine) {
    engine.write(reg::kRatioFeed, driver::Card::ratio_of(operation_.percent, most_));
    if (!card_map::has_engine(engine.read(reg::kEngines), card_map::engine::kClasses)) return;
    for (const std::uint32_t other : {reg::kRatioRapid, reg::kRatioFixed}) {
      engine.write(other, driver::Card::ratio_of(100, most_));
    }
  });
  for (const OperatorEvent& event : operation_.events) {
    bus.at(static_cast<std::uint64_t>(std::llround(event.seconds * clock_hz)),
           [this, event](sim::Engine& engine) { make(event, engine); });
  }
}

void OperatorTimeline::make(const OperatorEvent& event, sim::Engine& engine) {
  if (event.kind == OperatorEvent::Kind::kOverride) {
    engine.write(reg::kRatioFeed, driver::Card::ratio_of(event.percent, most_));
  } else {
    engine.write(reg::kHold, event.kind == OperatorEvent::Kind::kHold ? 1 : 0);
  }
  made_.push_back({event, engine.cycles()});
}

}  // namespace trammel::app
