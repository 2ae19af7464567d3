#include "operator_timeline.hpp"

#include <cmath>

#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/unit_table.hpp"

namespace trammel::simulation {

namespace reg = card_map::reg;

void OperatorTimeline::schedule(sim::TimedBus& bus, std::uint32_t clock_hz) {
  bus.at(0, [this](sim::Engine& engine) {
    engine.write(reg::kRatioFeed, driver::Card::ratio_of(operation_.percent, max_percent_));
    // The first descriptor of every card is that of the time base.
    const card_map::Descriptor time_base = card_map::descriptor_of(engine.read(reg::descriptor(0)), 0);
    if (!card_map::has_engine(driver::engines_of(time_base), card_map::engine::kClasses)) return;
    engine.write(reg::kRatioRapid, driver::Card::ratio_of(operation_.rapid_percent, max_percent_));
    engine.write(reg::kRatioFixed, driver::Card::ratio_of(100, max_percent_));
  });
  for (const OperatorEvent& event : operation_.events) {
    bus.at(static_cast<std::uint64_t>(std::llround(event.seconds * clock_hz)),
           [this, event](sim::Engine& engine) { make(event, engine); });
  }
}

void OperatorTimeline::make(const OperatorEvent& event, sim::Engine& engine) {
  if (event.kind == OperatorEvent::Kind::kInput) {
    engine.set_input(event.input, event.level);
  } else if (event.kind == OperatorEvent::Kind::kEmergencyStop) {
    engine.set_emergency_stop(event.level);
  } else if (event.kind == OperatorEvent::Kind::kOverride) {
    engine.write(reg::kRatioFeed, driver::Card::ratio_of(event.percent, max_percent_));
  } else {
    engine.write(reg::kHold, event.kind == OperatorEvent::Kind::kHold ? 1 : 0);
  }
  made_.push_back({event, engine.cycles()});
}

}  // namespace trammel::simulation
