#include "input_event.hpp"

#include <fmt/format.h>

#include <cmath>

#include "errors.hpp"
#include "numbers_of_options.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::app {

simulation::OperatorEvent input_event(const std::string& text) {
  constexpr const char* kOption = "--input-at";
  constexpr const char* kForm = "SECONDS:INPUT:LEVEL";
  const auto [at, pin_and_level] = halves(kOption, text, kForm);
  const auto [pin, level] = halves(kOption, pin_and_level, kForm);
  const double seconds = seconds_of(kOption, at, "time");
  if (level != "0" && level != "1") throw UsageError(fmt::format("{}: {} is not a level (0 or 1)", kOption, level));
  using Kind = simulation::OperatorEvent::Kind;
  if (pin == "estop") return {Kind::kEmergencyStop, seconds, 0, 0, level == "1"};
  const auto input = number(pin);
  if (!input || !(*input >= 0) || *input >= sim::kInputs || *input != std::floor(*input)) {
    throw UsageError(fmt::format("{}: {} is not an input of the simulated card (0 to {}, or estop)", kOption, pin,
                                 sim::kInputs - 1));
  }
  return {Kind::kInput, seconds, 0, static_cast<unsigned>(*input), level == "1"};
}

}  // namespace trammel::app
