#include "engine_options.hpp"

#include <cmath>

#include "errors.hpp"

namespace trammel::app {

unsigned card_axes(std::size_t needed) { return needed <= 4 ? 4 : 8; }

CLI::Validator positive() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0;
        const bool number = CLI::detail::lexical_cast(text, value);
        return number && value > 0 && std::isfinite(value) ? std::string()
                                                           : "must be a number greater than 0, not " + text;
      },
      "> 0");
}

void EngineChoice::add_to(CLI::App& command) {
  command
      .add_option("--engine", engine,
                  "rtl: the Verilated card in lockstep with the golden model; model: the model alone")
      ->check(CLI::IsMember({"rtl", "model"}))
      ->capture_default_str();
  command.add_option("--clock", clock_hz, "clock of the simulated card, Hz")
      ->check(CLI::Range(1000.0, 4294967295.0))
      ->type_name("HZ");
  command.add_option("--trace", trace, "waveform of the card as FST file (engine rtl only)")->type_name("FILE");
}

sim::SimulationOptions EngineChoice::options(unsigned axes, std::uint32_t rtl_clock, std::uint32_t model_clock) const {
  sim::SimulationOptions options;
  options.kind = engine == "model" ? sim::EngineKind::kModel : sim::EngineKind::kRtl;
  options.axes = axes;
  options.clock_hz = options.kind == sim::EngineKind::kModel ? model_clock : rtl_clock;
  if (clock_hz > 0) {
    if (clock_hz != std::floor(clock_hz)) throw UsageError("--clock: must be a whole number of Hz");
    options.clock_hz = static_cast<std::uint32_t>(clock_hz);
  }
  if (trace && options.kind == sim::EngineKind::kModel) {
    throw UsageError("--trace: only the rtl engine has waveforms (--engine rtl)");
  }
  options.trace = trace;
  options.rtl_thread = true;
  return options;
}

}  // namespace trammel::app
