#include "engine_speed.hpp"

#include <fmt/format.h>

#include <chrono>

#include "progress_bar.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"

namespace trammel::app {
namespace {

constexpr double kWorthMeasuring = 10e6;  // clocks; fewer take seconds
constexpr double kLong = 60;              // s

// Of a card whose axes all move, a step in some 20 clocks: programs are about as busy.
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

}  // namespace

std::optional<std::string> long_run_note(const sim::SimulationOptions& options, double card_seconds) {
  const double clocks = card_seconds * options.clock_hz;
  if (options.kind == sim::EngineKind::kModel || clocks < kWorthMeasuring) return std::nullopt;
  const double speed = clocks_per_second(options);
  if (clocks / speed < kLong) return std::nullopt;
  return fmt::format(
      "the Verilated card will take about {} for {:.0f} M clocks ({:.2f} M clocks/s now{}); --engine "
      "model makes the same steps in less",
      duration_text(clocks / speed), clocks * 1e-6, speed * 1e-6, options.trace ? ", more where it is traced" : "");
}

}  // namespace trammel::app
