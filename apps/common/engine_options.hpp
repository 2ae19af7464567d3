// Options common to all subcommands with a simulated card.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "card_choice.hpp"
#include "command_line.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::app {

// For options that must be greater than 0; CLI11's own message names the largest double.
CLI::Validator positive();
// For the file names of an SVG picture, a page and a waveform; they refuse names with the suffix of another kind.
CLI::Validator svg_file();
CLI::Validator page_file();
CLI::Validator waveform_file();
// For one signed integer number of pulses.
CLI::Validator pulses();

// For integers in a range; CLI11's own message prints the bounds as 4.29497e+09.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most, const std::string& unit = "");

// Converts an option's FROM:TO in seconds, either of which may be missing, to clocks. Throws UsageError.
std::pair<std::uint64_t, std::uint64_t> window_of(const std::string& option, const std::string& text,
                                                  std::uint32_t clock_hz);

struct EngineChoice {
  std::string engine = "rtl";
  std::optional<std::uint32_t> clock_hz;
  std::optional<std::string> trace;         // the option's file; options() gives the name to write to
  std::optional<std::string> trace_window;  // FROM:TO

  // `default_clock`: text of the default clock that options() uses.
  void add_to(CLI::App& command, const std::string& default_clock = "1000000");
  // Throws UsageError if an option was given together with an external card.
  void refuse_with(const CardChoice& card) const;
  // The engine's options for a card of `axes` (1 to 8). `rtl_clock` and `model_clock` are the default clocks in Hz.
  // Throws UsageError for options that contradict each other.
  sim::SimulationOptions options(unsigned axes, std::uint32_t rtl_clock, std::uint32_t model_clock) const;
};

}  // namespace trammel::app
