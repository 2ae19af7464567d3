#include "engine_speed.hpp"

#include <fmt/format.h>

#include "common/progress_bar.hpp"
#include "trammel/simulation/simulated_card.hpp"

namespace trammel::app {
namespace {

constexpr double kWorthMeasuring = 10e6;  // clocks; fewer take only seconds
constexpr double kLong = 60;              // s
// Two examples needed 43 to 54 bytes per command on a slow bus, with the host's reads of the status.
constexpr double kBytesOfCommand = 45;

}  // namespace

double bus_seconds(double bytes_per_second, std::uint64_t commands) {
  return static_cast<double>(commands) * kBytesOfCommand / bytes_per_second;
}

std::optional<std::string> slow_bus_note(double bytes_per_second, std::uint64_t commands, double planned_seconds) {
  const double seconds = bus_seconds(bytes_per_second, commands);
  if (seconds <= planned_seconds) return std::nullopt;
  return fmt::format(
      "--limit-bus: at {:g} bytes/s the program's {} commands take about {:.0f} s of card time, more than the {:.0f} s "
      "of the motion; it will often wait for commands",
      bytes_per_second, commands, seconds, planned_seconds);
}

std::optional<std::string> long_run_note(const sim::SimulationOptions& options, double card_seconds) {
  const double clocks = card_seconds * options.clock_hz;
  if (options.kind == sim::EngineKind::kModel || clocks < kWorthMeasuring) return std::nullopt;
  const double speed = simulation::clocks_per_second(options);
  if (clocks / speed < kLong) return std::nullopt;
  return fmt::format(
      "the Verilated card will take about {} for {:.0f} M clocks ({:.2f} M clocks/s now{}); --engine "
      "model makes the same steps in less",
      duration_text(clocks / speed), clocks * 1e-6, speed * 1e-6, options.trace ? ", more where it is traced" : "");
}

}  // namespace trammel::app
