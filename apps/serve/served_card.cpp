#include "served_card.hpp"

#include <signal.h>

#include <algorithm>

#include "common/input_event.hpp"
#include "common/terminal.hpp"

namespace trammel::app {
namespace {

constexpr std::uint32_t kServedClock = 1'000'000;
// With LinuxCNC, step times and latency need this clock; the model runs it in real time.
constexpr std::uint32_t kHm2Clock = 10'000'000;

volatile sig_atomic_t g_serving_ended = 0;

void press(sim::Engine& engine, const simulation::OperatorEvent& event) {
  if (event.kind == simulation::OperatorEvent::Kind::kEmergencyStop)
    engine.set_emergency_stop(event.level);
  else
    engine.set_input(event.input, event.level);
}

}  // namespace

std::uint32_t ServeOptions::clock() const { return clock_hz.value_or(hm2 ? kHm2Clock : kServedClock); }

sim::SimulationOptions served_engine(const ServeOptions& options) {
  sim::SimulationOptions engine;
  engine.kind = options.is_model() ? sim::EngineKind::kModel : sim::EngineKind::kRtl;
  engine.axes = options.axes;
  engine.clock_hz = options.clock();
  engine.rtl_thread = true;
  return engine;
}

void say_served(const std::string& text) { tell("note", text); }

void end_serving_at_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_serving_ended = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

bool serving_ended() { return g_serving_ended != 0; }

Switches::Switches(const ServeOptions& options) : clock_hz_(options.clock()) {
  for (const std::string& text : options.input_at) events_.push_back(input_event(text));
  std::stable_sort(events_.begin(), events_.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
}

void Switches::press_due(sim::Engine& engine) {
  for (; next_ < events_.size() && events_[next_].seconds * clock_hz_ <= static_cast<double>(engine.cycles()); ++next_)
    press(engine, events_[next_]);
}

}  // namespace trammel::app
