#include "trammel/simulation/simulated_card.hpp"

#include <chrono>

#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"

namespace trammel::simulation {

planner::CardLimits limits_of(const sim::EngineOptions& engine) {
  // The model alone has the same identification as the Verilated card and costs less to make.
  const std::unique_ptr<sim::Engine> model = sim::make_model_engine(engine);
  planner::CardLimits card = planner::limits_of(driver::Card::open(*model).identification());
  card.outputs = sim::kOutputs;
  return card;
}

unsigned traced_axes(unsigned axes) { return axes <= 4 ? 4 : 8; }

double clocks_per_second(sim::SimulationOptions options) {
  using Clock = std::chrono::steady_clock;
  constexpr std::int64_t kPulses = 50'000;
  constexpr std::uint64_t kLineClocks = 1'000'000;
  constexpr std::uint64_t kPart = 4096;
  options.trace.reset();
  const std::unique_ptr<sim::Engine> engine = sim::make_engine(options);
  driver::Card card = driver::Card::open(*engine);
  driver::Displacement line{};
  for (unsigned a = 0; a < options.axes; ++a) line[a] = kPulses;
  driver::start_line(card, driver::plan_line_clocks(card.timing(), line, kLineClocks).part(0));
  const std::uint64_t first = engine->cycles();
  const Clock::time_point begun = Clock::now();
  double seconds = 0;
  while (seconds < 0.3 && engine->cycles() - first < kLineClocks) {
    engine->wait(kPart);
    seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  }
  return static_cast<double>(engine->cycles() - first) / seconds;
}

}  // namespace trammel::simulation
