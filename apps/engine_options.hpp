// Options that every subcommand with a simulated card shares.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "trammel/sim/engines.hpp"

namespace trammel::app {

// Axes of the simulated card that serves `needed` of them (1 to 8): it is built with 4 and with 8.
unsigned card_axes(std::size_t needed);

// For options that must be greater than 0; CLI11's own message names the largest double.
CLI::Validator positive();

struct EngineChoice {
  std::string engine = "rtl";
  double clock_hz = 0;  // 0: not given
  std::optional<std::string> trace;

  void add_to(CLI::App& command);
  // The engine's options; `rtl_clock` and `model_clock` are the clocks, in Hz, where none was given.
  // Throws UsageError for what does not go together.
  sim::SimulationOptions options(unsigned axes, std::uint32_t rtl_clock, std::uint32_t model_clock) const;
};

}  // namespace trammel::app
