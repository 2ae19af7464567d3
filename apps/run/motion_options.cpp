#include "motion_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/input_event.hpp"
#include "common/numbers_of_options.hpp"

namespace trammel::app {
namespace {

using simulation::OperatorEvent;

CLI::Validator between(double least, double most, const std::string& what) {
  return CLI::Validator(
      [=](const std::string& text) {
        const auto value = number(text);
        if (value && *value >= least && *value <= most) return std::string();
        return fmt::format("must be {} from {} to {:.0f}, not {}", what, least, most, text);
      },
      "");
}

double percent_of(const std::string& option, std::string_view text, double most, const char* why = "") {
  const auto value = number(text);
  if (!value || !(*value >= 0) || *value > most) {
    throw UsageError(fmt::format("{}: {} is not an override from 0 to {:g} percent{}", option, text, most,
                                 value && *value > most ? why : ""));
  }
  return *value;
}

// Parses "M900" or "M862.3".
gcode::CodeWord code_word_of(const std::string& text) {
  const char letter = text.empty() ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  const std::string_view digits = std::string_view(text).substr(text.empty() ? 0 : 1);
  const bool plain =
      (letter == 'G' || letter == 'M') && digits.find_first_not_of("0123456789.") == std::string_view::npos;
  const auto value = plain ? number(digits) : std::nullopt;
  constexpr double kLargest = 9999.9;
  const double tenths = value.value_or(0) * 10;
  if (!value || *value > kLargest || std::abs(tenths - std::round(tenths)) > 1e-6) {
    throw UsageError(fmt::format("--accept: {} is not a G or M word such as M900 or M862.3", text));
  }
  const gcode::CodeWord word{letter, static_cast<int>(std::round(tenths))};
  const std::string_view why = gcode::why_not_left_out(word);
  if (!why.empty()) throw UsageError(fmt::format("--accept: {} cannot be left out: {}", text, why));
  return word;
}

// A resume ends only the latest hold, so overlapping holds are ambiguous.
void refuse_overlaps(const std::vector<OperatorEvent>& events) {
  const OperatorEvent* hold = nullptr;
  for (const OperatorEvent& event : events) {
    if (event.kind == OperatorEvent::Kind::kHold) {
      if (hold != nullptr) {
        throw UsageError(fmt::format("--hold-at: the hold at {:g} s begins before the one at {:g} s is over",
                                     event.seconds, hold->seconds));
      }
      hold = &event;
    } else if (event.kind == OperatorEvent::Kind::kResume) {
      hold = nullptr;
    }
  }
}

// Options for the actions of an operator outside the program: speed and inputs.
void add_operator_options(CLI::App& command, MotionChoice& choice) {
  command
      .add_option("--override", choice.percent,
                  "feed override from the start on: percent of the planned speed, 0 to 100, or to 100 times "
                  "max_override of the machine file (default: 100)")
      ->type_name("PERCENT");
  command
      .add_option("--rapid-override", choice.rapid_percent,
                  "override of rapids (G0, G28): percent of the planned speed, 0 to 100 (default: 100)")
      ->type_name("PERCENT");
  command
      .add_option("--override-at", choice.override_at,
                  "change the feed override to PERCENT at this card time (repeatable)")
      ->type_name("SECONDS:PERCENT")
      ->allow_extra_args(false);
  command
      .add_option("--hold-at", choice.hold_at, "hold at this card time, and resume DURATION seconds later (repeatable)")
      ->type_name("SECONDS:DURATION")
      ->allow_extra_args(false);
  command
      .add_option(
          "--input-at", choice.input_at,
          fmt::format(
              "set an input of the simulated card (0 to {}) to a level (0 or 1) at this card time (repeatable). Until "
              "then the input is at rest. Input estop is the emergency stop button: 1 pressed, 0 released",
              sim::kInputs - 1))
      ->type_name("SECONDS:INPUT:LEVEL")
      ->allow_extra_args(false);
}

}  // namespace

void MotionChoice::add_to(CLI::App& command) {
  add_operator_options(command, *this);
  command
      .add_option("--feed-scale", feed_scale,
                  "multiply every programmed feed by this factor, 0.001 to 1000 (default: 1)")
      ->check(between(0.001, 1000, "a factor"))
      ->type_name("FACTOR");
  command
      .add_option("--limit-bus", bytes_per_second,
                  "limit the simulated bus to this many bytes per second of card time. Each word read or written "
                  "counts 4 bytes (default: no limit)")
      ->check(between(1, 1e9, "bytes per second"))
      ->type_name("BYTES_PER_SECOND");
  command
      .add_option(
          "--from-line", first_line,
          "begin at line N of the program. The lines before it only set modes, offsets, outputs and the position")
      ->transform(whole_number(1, std::numeric_limits<std::uint32_t>::max()).description(""))
      ->type_name("N");
  command
      .add_option("--arcs", arcs,
                  "how to make arcs. generator: the card's arc generator. accumulator-8: unit steps in 8 directions. "
                  "accumulator: unit steps in 4 directions; helices become chords. chords: straight lines. If one "
                  "cannot make an arc, the next one is used")
      ->check(CLI::IsMember({"generator", "accumulator-8", "accumulator", "chords"}))
      ->capture_default_str();
  command
      .add_option("--profile", profile,
                  "how the speed changes. trapezoid: constant acceleration. s-curve: the acceleration changes by "
                  "max_jerk at most (default: s-curve if every axis has a max_jerk, else trapezoid)")
      ->check(CLI::IsMember({"trapezoid", "s-curve"}).description(""))
      ->type_name("PROFILE");
  command
      .add_option("--accept", accept,
                  "leave out the lines that begin with these words, such as those for heaters and fans (repeatable)")
      ->type_name("M900,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_flag("--single-block", single_block,
                   "stop at the end of each line of the program, and send the next line when the card is idle");
  command.add_flag("--no-block-delete", run_deleted,
                   "run the lines that begin with '/', too (default: leave them out)");
}

simulation::Operation MotionChoice::operation(double max_percent) const {
  simulation::Operation result;
  constexpr const char* kMax = " (max_override of the machine file sets the maximum)";
  result.percent = percent_of("--override", percent, max_percent, kMax);
  result.rapid_percent = percent_of("--rapid-override", rapid_percent, 100);
  result.bytes_per_second = bytes_per_second.value_or(std::numeric_limits<double>::infinity());
  for (const std::string& text : override_at) {
    const auto [at, to] = halves("--override-at", text, "SECONDS:PERCENT");
    const double seconds = seconds_of("--override-at", at, "time");
    result.events.push_back(
        {OperatorEvent::Kind::kOverride, seconds, percent_of("--override-at", to, max_percent, kMax)});
  }
  for (const std::string& text : hold_at) {
    const auto [at, duration] = halves("--hold-at", text, "SECONDS:DURATION, both in seconds");
    const double begin = seconds_of("--hold-at", at, "time");
    const double end = begin + seconds_of("--hold-at", duration, "duration");
    result.events.push_back({OperatorEvent::Kind::kHold, begin, 0});
    result.events.push_back({OperatorEvent::Kind::kResume, end, 0});
  }
  for (const std::string& text : input_at) result.events.push_back(input_event(text));
  std::stable_sort(result.events.begin(), result.events.end(),
                   [](const OperatorEvent& a, const OperatorEvent& b) { return a.seconds < b.seconds; });
  refuse_overlaps(result.events);
  double last = result.percent;
  for (const OperatorEvent& event : result.events) {
    if (event.kind == OperatorEvent::Kind::kOverride) last = event.percent;
  }
  if (last == 0) throw UsageError("--override: with 0 percent at the end the program would never finish");
  return result;
}

std::vector<std::string> late_event_notes(const std::vector<OperatorEvent>& events, std::size_t made, double seconds) {
  std::vector<std::string> notes;
  for (std::size_t n = made; n < events.size(); ++n) {
    const OperatorEvent::Kind kind = events[n].kind;
    if (kind == OperatorEvent::Kind::kResume) continue;
    notes.push_back(fmt::format("{} {:g} had no effect: the run ended after {:.3f} s of card time",
                                kind == OperatorEvent::Kind::kHold       ? "--hold-at"
                                : kind == OperatorEvent::Kind::kOverride ? "--override-at"
                                                                         : "--input-at",
                                events[n].seconds, seconds));
  }
  return notes;
}

std::map<std::string, std::string> MotionChoice::of_plan() const {
  std::map<std::string, std::string> values;
  values["--feed-scale"] = fmt::format("{}", feed_scale);
  values["--arcs"] = arcs;
  values["--profile"] = profile.value_or("by the machine");
  values["--accept"] = fmt::format("{}", fmt::join(accept, ","));
  values["--single-block"] = single_block ? "given" : "not given";
  values["--no-block-delete"] = run_deleted ? "given" : "not given";
  return values;
}

run::RunSettings MotionChoice::settings() const {
  run::RunSettings settings;
  settings.reader.block_delete = !run_deleted;
  settings.reader.feed_scale = feed_scale;
  for (const std::string& word : accept) settings.reader.left_out.push_back(code_word_of(word));
  settings.first_line = first_line;
  settings.single_block = single_block;
  settings.arcs = arcs == "chords"          ? planner::ArcsBy::kChords
                  : arcs == "accumulator"   ? planner::ArcsBy::kAccumulator
                  : arcs == "accumulator-8" ? planner::ArcsBy::kEightDirections
                                            : planner::ArcsBy::kGenerator;
  if (profile) {
    settings.profile = *profile == "s-curve" ? planner::SpeedProfile::kSCurve : planner::SpeedProfile::kTrapezoid;
  }
  return settings;
}

}  // namespace trammel::app
