#include "engine_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "errors.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::app {
CLI::Validator positive() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0;
        const bool number = CLI::detail::lexical_cast(text, value);
        if (number && value > 0 && std::isfinite(value)) return std::string();
        return "must be a number greater than 0 without its unit, as 150 or 0.5, not " + text;
      },
      "> 0");
}

namespace {
// Refuses names with a suffix in `others`.
CLI::Validator file_of(const char* what, const char* suffix, std::vector<std::string> others) {
  return CLI::Validator(
      [what, suffix, others = std::move(others)](const std::string& text) {
        const std::filesystem::path name(text);
        std::string end = name.extension().string();
        std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
        if (std::find(others.begin(), others.end(), end) == others.end()) return std::string();
        return fmt::format("{}, not {}: name it {}", what, end.substr(1),
                           std::filesystem::path(name.stem()).replace_extension(suffix).string());
      },
      "");
}
}  // namespace

CLI::Validator svg_file() {
  return file_of("the picture is SVG", "svg",
                 {".png", ".jpg", ".jpeg", ".gif", ".bmp", ".webp", ".pdf", ".eps", ".html"});
}

CLI::Validator page_file() {
  return file_of("the page is HTML", "html", {".pdf", ".png", ".jpg", ".svg", ".md", ".txt", ".json", ".csv"});
}

CLI::Validator waveform_file() {
  return file_of("the waveform is FST", "fst", {".vcd", ".evcd", ".lxt", ".lxt2", ".lx2", ".vzt", ".ghw", ".wlf"});
}

CLI::Validator pulses() {
  return CLI::Validator(
      [](const std::string& text) {
        std::int64_t value = 0;
        if (CLI::detail::lexical_cast(text, value)) return std::string();
        return "must be whole numbers of pulses, as 2000,-1000, not " + text;
      },
      "");
}

std::pair<std::uint64_t, std::uint64_t> window_of(const std::string& option, const std::string& text,
                                                  std::uint32_t clock_hz) {
  const auto refuse = [&](const char* why) { throw UsageError(fmt::format("{} {}: {}", option, text, why)); };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) refuse("must be FROM:TO, seconds of card time");
  const auto clocks = [&](const std::string& part, std::uint64_t missing) {
    if (part.empty()) return missing;
    double seconds = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), seconds);
    if (error != std::errc{} || end != part.data() + part.size() || !(seconds >= 0) || seconds > 1e9) {
      refuse("must be FROM:TO, seconds of card time");
    }
    return static_cast<std::uint64_t>(std::llround(seconds * clock_hz));
  };
  const std::uint64_t from = clocks(text.substr(0, colon), 0);
  const std::uint64_t to = clocks(text.substr(colon + 1), UINT64_MAX);
  if (from >= to) refuse("ends before it begins");
  return {from, to};
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most, const std::string& unit) {
  const std::string range = fmt::format("{} to {}{}{}", least, most, unit.empty() ? "" : " ", unit);
  return CLI::Validator(
      [=](std::string& text) {
        // 1e6 also counts as an integer.
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc{} && end == text.data() + text.size() && value == std::floor(value);
        if (!whole || value < static_cast<double>(least) || value > static_cast<double>(most)) {
          return fmt::format("must be a whole number, {}, not {}", range, text);
        }
        text = fmt::format("{:.0f}", value);
        return std::string();
      },
      range);
}

void EngineChoice::add_to(CLI::App& command, const std::string& default_clock) {
  command
      .add_option("--engine", engine,
                  "how to simulate the card. rtl: the Verilated RTL, compared with the golden model in every cycle. "
                  "model: the golden model alone, which is faster")
      ->check(CLI::IsMember({"rtl", "model"}))
      ->capture_default_str();
  command.add_option("--clock", clock_hz, fmt::format("clock of the simulated card (default: {})", default_clock))
      ->transform(whole_number(machine::kSlowestClock, machine::kFastestClock, "Hz"))
      ->type_name("HZ");
  command.add_option("--trace", trace, "write the waveforms of the card to an FST file (only with --engine rtl)")
      ->check(waveform_file())
      ->type_name("FILE");
  command
      .add_option("--trace-window", trace_window,
                  "with --trace: record this interval only, seconds of card time. Either end may be left out")
      ->type_name("FROM:TO");
}

void EngineChoice::refuse_with(const CardChoice& card) const {
  refuse_with_card(card, "--engine", engine != "rtl");
  refuse_with_card(card, "--clock", clock_hz.has_value());
  refuse_with_card(card, "--trace", trace.has_value());
  refuse_with_card(card, "--trace-window", trace_window.has_value());
}

sim::SimulationOptions EngineChoice::options(unsigned axes, std::uint32_t rtl_clock, std::uint32_t model_clock) const {
  sim::SimulationOptions options;
  options.kind = engine == "model" ? sim::EngineKind::kModel : sim::EngineKind::kRtl;
  options.axes = axes;
  options.clock_hz = clock_hz.value_or(options.kind == sim::EngineKind::kModel ? model_clock : rtl_clock);
  options.rtl_thread = true;
  if (trace_window && !trace) throw UsageError("--trace-window: needs --trace");
  if (!trace) return options;
  if (options.kind == sim::EngineKind::kModel) {
    throw UsageError("--trace: only the rtl engine has waveforms (--engine rtl)");
  }
  options.trace.emplace();
  if (trace_window)
    std::tie(options.trace->from, options.trace->to) = window_of("--trace-window", *trace_window, options.clock_hz);
  return options;
}

}  // namespace trammel::app
