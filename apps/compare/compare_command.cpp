#include "compare_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <variant>

#include "common/curve_options.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/outputs.hpp"
#include "common/progress_bar.hpp"
#include "compare_plot.hpp"
#include "compare_report.hpp"
#include "trammel/measure/comparison.hpp"

namespace trammel::app {
namespace {

namespace interpolation = interpolation;
namespace measure = measure;

// Default velocity for random lines, lines per second: 100,000 clocks per line at 10 MHz, so that the resolution of the
// clock does not hide the differences between methods.
constexpr std::uint64_t kRandomVelocity = 100;
// Takes hours, and 300 MB for the sums.
constexpr std::uint64_t kMaxLines = 100'000'000;

struct CompareOptions {
  CurveChoice curve;
  VelocityChoice velocity;
  std::optional<std::uint64_t> random;
  std::uint64_t seed = 1;
  std::int64_t largest = 1000;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string drive = "full";
  bool no_ramps = false;
  bool progress = false;
  std::optional<std::string> json;
  std::optional<std::string> plot;
};

std::string title_of(const CurveChoice& choice) {
  const char* turn = choice.clockwise ? ", clockwise" : ", counter-clockwise";
  if (choice.line) return fmt::format("line {}", *choice.line);
  if (choice.circle) return fmt::format("circle {}{}", *choice.circle, turn);
  if (choice.arc) return fmt::format("arc {}{}", *choice.arc, turn);
  return fmt::format("ellipse {}{}", *choice.ellipse, turn);
}

void check_size(const interpolation::Curve& curve) {
  const std::uint64_t pulses = measure::pulses_along(curve);
  if (pulses == 0) throw UsageError("the line has no length, so there is nothing to compare");
  if (pulses > measure::kMaxPulses) {
    throw UsageError(
        fmt::format("the curve has about {} pulses; at most {} can be compared", pulses, measure::kMaxPulses));
  }
}

// Measures every method; stores the traces in the same order, for the motor simulation.
Comparison compare(const CompareOptions& options, std::vector<measure::Trace>& traces) {
  const interpolation::Curve curve = options.curve.curve();
  check_size(curve);
  const measure::IdealCurve ideal = measure::ideal_of(curve);
  Comparison result;
  result.title = title_of(options.curve);
  result.axes = ideal.axes();
  result.length = ideal.length();
  result.is_line = ideal.is_line();
  result.options = options.velocity.options(curve);
  for (const interpolation::Method method : measure::methods_for(curve)) {
    measure::Trace trace;
    try {
      measure::record(method, curve, result.options, trace);
    } catch (const std::invalid_argument& error) {
      result.refused.push_back({method, error.what()});
      continue;
    }
    result.methods.push_back(measure::measure_method(method, trace, ideal));
    traces.push_back(std::move(trace));
  }
  if (result.methods.empty()) throw UsageError(result.refused.front().reason);
  result.motor.drive = options.drive == "half" ? measure::Drive::kHalfStep : measure::Drive::kFullStep;
  if (options.no_ramps) result.motor.ramp_time = 0;
  result.speeds = measure::sweep_speeds();
  ProgressBar bar(options.progress);
  result.sweeps = measure::sweep_motors(traces, ideal, result.motor, result.speeds, options.threads,
                                        [&](double done) { bar.show(done, "motors"); });
  return result;
}

void compare_curve(const CompareOptions& options) {
  Outputs outputs;
  Output* const json = outputs.add("--json", options.json);
  Output* const plot = outputs.add("--plot", options.plot);
  outputs.check();
  std::vector<measure::Trace> traces;
  const Comparison comparison = compare(options, traces);
  outputs.open();
  if (json != nullptr) json->write(json_text(comparison));
  if (plot != nullptr) plot->write(comparison_svg(comparison, traces, measure::ideal_of(options.curve.curve())));
  outputs.commit(table_of(comparison));
}

void compare_random(const CompareOptions& options) {
  if (options.curve.given()) throw UsageError("--random: give it without --line, --circle, --arc and --ellipse");
  if (options.plot) throw UsageError("--plot: a picture is made of one curve, not of --random lines");
  measure::RandomLines lines;
  lines.count = *options.random;
  lines.seed = options.seed;
  lines.largest = options.largest;
  lines.threads = options.threads;
  lines.options.clock_hz = options.velocity.clock_hz.value_or(lines.options.clock_hz);
  lines.options.velocity = options.velocity.velocity.value_or(kRandomVelocity);
  Outputs outputs;
  Output* const json = outputs.add("--json", options.json);
  outputs.check();
  std::vector<measure::RandomMeasures> measures;
  try {
    ProgressBar bar(options.progress);
    measures = measure::measure_random_lines(lines, [&](double done) { bar.show(done, "lines"); });
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  outputs.open();
  if (json != nullptr) json->write(json_text(lines, measures));
  outputs.commit(table_of(lines, measures));
  for (const measure::RandomMeasures& method : measures) {
    if (method.wrong_ends > 0) {
      throw std::runtime_error(fmt::format("{}: {} lines did not end on their end point",
                                           interpolation::info(method.method).name, method.wrong_ends));
    }
  }
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare",
                         "compare all interpolation methods on one curve, or on random lines: distance from the curve, "
                         "cost for the host, evenness of the steps, vibration of a motor");
  options->curve.add_to(*command);
  options->velocity.add_to(*command);
  command->add_option("--random", options->random, "compare on this number of random lines instead of one curve")
      ->transform(whole_number(1, kMaxLines, "lines"))
      ->type_name("N");
  // The range in which a double represents every integer.
  command->add_option("--seed", options->seed, "seed of the random lines (default 1)")
      ->transform(whole_number(0, std::uint64_t{1} << 53));
  command
      ->add_option("--largest", options->largest,
                   "maximum length of a random line along each axis, pulses (default 1000)")
      ->transform(whole_number(1, measure::kMaxPulses / 2, "pulses"));
  command->add_option("--threads", options->threads, "number of threads (default: one per core)")
      ->transform(whole_number(1, 256));
  command
      ->add_option("--drive", options->drive,
                   "how the simulated motor is driven: with full or half steps (default full)")
      ->check(CLI::IsMember({"full", "half"}));
  command->add_flag("--no-ramps", options->no_ramps,
                    "start and stop the simulated motors at full speed, without ramps of 50 ms");
  command->add_flag("--progress", options->progress, "show the progress even if standard error is not a terminal");
  command->add_option("--json", options->json, "write all measured values to a JSON file ('-': standard output)")
      ->type_name("FILE");
  command
      ->add_option("--plot", options->plot, "write a picture of distances, step intervals and vibration to an SVG file")
      ->type_name("FILE.svg")
      ->check(svg_file());
  command->callback([options] { options->random ? compare_random(*options) : compare_curve(*options); });
}

}  // namespace trammel::app
