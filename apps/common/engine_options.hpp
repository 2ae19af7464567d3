// Options that every subcommand with a simulated card shares.
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
// The name of a picture that will be SVG, of a page or of a waveform: refuses names of other kinds of files.
CLI::Validator svg_file();
CLI::Validator page_file();
CLI::Validator waveform_file();
// One of an option's whole numbers of pulses, with its sign.
CLI::Validator pulses();

// For whole numbers between two others; CLI11's own message has them as 4.29497e+09.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most, const std::string& unit = "");

// An option's FROM:TO in seconds, either of which may be missing, in clocks. Throws UsageError.
std::pair<std::uint64_t, std::uint64_t> window_of(const std::string& option, const std::string& text,
                                                  std::uint32_t clock_hz);

struct EngineChoice {
  std::string engine = "rtl";
  std::optional<std::uint32_t> clock_hz;
  std::optional<std::string> trace;         // the option's file; who writes it is told a name by options()
  std::optional<std::string> trace_window;  // FROM:TO

  // `default_clock` says what options() gets.
  void add_to(CLI::App& command, const std::string& default_clock = "1000000");
  // Throws UsageError where something was chosen: the card is another.
  void refuse_with(const CardChoice& card) const;
  // The engine's options for a card of `axes` (1 to 8); `rtl_clock` and `model_clock` are the clocks, in Hz, where none
  // was given; `trace_file` is where the waveform goes, if one was asked for.
  // Throws UsageError for what does not go together.
  sim::SimulationOptions options(unsigned axes, std::uint32_t rtl_clock, std::uint32_t model_clock) const;
};

}  // namespace trammel::app
