#include "line_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/card_choice.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/outputs.hpp"
#include "common/stop_at_signals.hpp"
#include "common/terminal.hpp"
#include "common/waveform.hpp"
#include "ramped_line.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/plot.hpp"
#include "trammel/run/step_recorder.hpp"
#include "trammel/simulation/simulated_card.hpp"

namespace trammel::app {
namespace {

constexpr std::uint32_t kDefaultClock = 1'000'000;
constexpr double kDefaultSpeed = 1000;  // pulses/s

struct LineArguments {
  std::vector<std::int64_t> from;
  std::vector<std::int64_t> to;
  std::optional<double> velocity;
  std::optional<double> duration;
  std::optional<double> speed;
  std::vector<std::uint64_t> max_velocity;
  bool slow = false;
  bool no_ramp = false;
  MachineChoice machine;
  CardChoice card;
  EngineChoice engine;
  std::optional<std::string> json;
  std::optional<std::string> steps;
  std::optional<std::string> plot;
};

std::vector<std::int64_t> displacement_of(const LineArguments& options) {
  std::vector<std::int64_t> result = options.to;
  if (!options.from.empty() && options.from.size() != options.to.size()) {
    throw UsageError("--from and --to: must name the same number of axes");
  }
  if (result.size() > card_map::kMaxAxes) throw UsageError("--to: a card has at most 8 axes");
  for (std::size_t a = 0; a < options.from.size(); ++a) {
    if (__builtin_sub_overflow(result[a], options.from[a], &result[a])) {
      throw UsageError("--from and --to: more pulses apart than 64 bits hold");
    }
  }
  return result;
}

// Duration without ramps.
double seconds_of(const LineArguments& options, const std::vector<std::int64_t>& displacement) {
  if (options.velocity) return 1 / *options.velocity;
  if (options.duration) return *options.duration;
  double square = 0;
  for (const std::int64_t p : displacement) square += static_cast<double>(p) * static_cast<double>(p);
  return std::sqrt(square) / options.speed.value_or(kDefaultSpeed);
}

// The line's duration in clocks, rounded to the nearest.
std::uint64_t clocks_of(const LineArguments& options, const std::vector<std::int64_t>& displacement, double clock_hz) {
  const double clocks = std::round(seconds_of(options, displacement) * clock_hz);
  if (clocks >= std::ldexp(1.0, 62)) throw UsageError("the line takes longer than the card can count");
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(clocks));
}

driver::LineLimits line_limits(const LineArguments& options) {
  driver::LineLimits limits;
  if (options.max_velocity.size() > card_map::kMaxAxes) throw UsageError("--max-velocity: a card has at most 8 axes");
  std::copy(options.max_velocity.begin(), options.max_velocity.end(), limits.max_velocity.begin());
  limits.policy = options.slow ? driver::LimitPolicy::kSlow : driver::LimitPolicy::kRefuse;
  return limits;
}

// Measurements on the card.
struct Result {
  std::vector<std::int64_t> pulses;  // requested pulses
  std::vector<std::int64_t> final;
  std::vector<std::uint64_t> steps;
  std::uint64_t line_clocks = 0;
  std::size_t parts = 0;
  bool slowed = false;
  std::uint64_t cycles = 0;
  std::uint32_t clock_hz = 0;
  std::optional<std::uint64_t> lockstep_cycles;
  std::uint64_t comparisons = 0;
  double largest_line_deviation = 0;
  double largest_arc_deviation = 0;
  run::Plot plot;  // filled if requested
};

run::Point point_of(const std::vector<std::int64_t>& pulses, double share) {
  run::Point point{};
  for (std::size_t a = 0; a < std::min(point.size(), pulses.size()); ++a) {
    point[a] = share * static_cast<double>(pulses[a]);
  }
  return point;
}

// The line from its start at (0,0), in pulses, and its first part, as long as the recorder magnifies.
run::Plot plot_of(const std::vector<std::int64_t>& pulses, const run::StepRecorder& recorder) {
  double longest = 1;
  for (const std::int64_t p : pulses) longest = std::max(longest, std::fabs(static_cast<double>(p)));
  const double stretch = std::min(1.0, static_cast<double>(run::StepRecorder::kDetailPoints) / longest);
  const run::Point start{};
  return {fmt::format("line to {}", fmt::join(pulses, ", ")),
          "pulses",
          {{start, false}, {point_of(pulses, 1), false}},
          recorder.executed(),
          recorder.thinned(),
          {start, point_of(pulses, stretch)},
          recorder.detail(),
          recorder.speed()};
}

driver::OneShotPlan plan_of(const LineArguments& options, const driver::CardTiming& timing,
                            const std::vector<std::int64_t>& pulses) {
  driver::Displacement displacement{};
  std::copy(pulses.begin(), pulses.end(), displacement.begin());
  try {
    return driver::plan_line_clocks(timing, displacement, clocks_of(options, pulses, timing.clock_hz),
                                    line_limits(options));
  } catch (const driver::ArgumentError& error) {
    throw UsageError(error.what());
  }
}

// A direct-mode path has no command; the recorder measures it as one line over its clocks.
driver::LineCommand as_command(const driver::OneShotPlan& plan, const std::vector<std::int64_t>& pulses) {
  driver::LineCommand line;
  line.ticks = plan.part(0).length;
  line.mask = plan.part(0).mask;
  for (std::size_t a = 0; a < pulses.size(); ++a) {
    const auto increment = static_cast<std::int64_t>(plan.part(0).frequency[a]);
    line.increment[a] = pulses[a] < 0 ? -increment : increment;
  }
  return line;
}

// Pulses made by the card since `before`, by axis of the line.
std::vector<std::int64_t> moved(driver::Card& card, const driver::Snapshot& before, std::size_t axes) {
  const driver::Snapshot after = card.read_snapshot();
  std::vector<std::int64_t> result;
  for (std::size_t a = 0; a < axes; ++a) {
    result.push_back(driver::pulses_between(before.position[a], after.position[a]));
  }
  return result;
}

// The result of making a line, in either way.
struct Made {
  std::uint64_t line_clocks = 0;
  std::size_t parts = 0;
  bool slowed = false;
};

// Runs the line from `before` to its end, or to a stop by a signal. `recorder`: nullptr if no pin is visible.
Made one_shot_line(driver::Card& card, const LineArguments& options, const driver::Snapshot& before,
                   run::StepRecorder* recorder) {
  const std::vector<std::int64_t> pulses = displacement_of(options);
  const driver::OneShotPlan plan = plan_of(options, card.timing(), pulses);
  if (recorder != nullptr) recorder->command(0, as_command(plan, pulses));
  const StopAtSignals signals(card);
  try {
    driver::run_line(card, plan);
  } catch (const driver::StoppedError&) {
    signals.end(fmt::format("moved by {} pulses", fmt::join(moved(card, before, pulses.size()), ", ")));
  }
  return {plan.clocks(), plan.size(), plan.slowed()};
}

// Does the same with the machine's ramps.
Made line_with_ramps(driver::Card& card, const LineArguments& options, const driver::Snapshot& before,
                     run::StepRecorder* recorder) {
  const std::vector<std::int64_t> pulses = displacement_of(options);
  const machine::Machine machine = in_pulses(options.machine.load(), pulses.size());
  run::Runner runner(ramped_line(machine, pulses, seconds_of(options, pulses)), machine,
                     planner::limits_of(card.identification()));
  if (recorder != nullptr) runner.add(*recorder);
  const run::Plan plan = runner.plan();
  const StopAtSignals signals(card);
  try {
    runner.run(card);
  } catch (const run::StoppedOnPath&) {
    signals.end(fmt::format("moved by {} pulses", fmt::join(moved(card, before, pulses.size()), ", ")));
  }
  const double clocks = std::round(plan.seconds * card.identification().clock_hz);
  return {static_cast<std::uint64_t>(clocks), 1, !plan.feeds_not_reached.empty()};
}

Made any_line(driver::Card& card, const LineArguments& options, const driver::Snapshot& before,
              run::StepRecorder* recorder) {
  return options.no_ramp ? one_shot_line(card, options, before, recorder)
                         : line_with_ramps(card, options, before, recorder);
}

// Runs a line on an external card, which stops by itself if this program dies or is stopped.
Made watched_line(driver::Card& card, transport::Connection& connection, const LineArguments& options,
                  const driver::Snapshot& before) {
  const machine::Machine machine = options.machine.load();
  card.name_axes(run::names_of_card_axes(machine));
  limit_patience(connection, machine.motion);
  const MotionWatchdog watchdog(card, machine.motion);
  try {
    return any_line(card, options, before, nullptr);
  } catch (const driver::Error&) {
    tell_of_stop(card, connection, machine);
    throw;
  } catch (const run::RunError&) {
    tell_of_stop(card, connection, machine);
    throw;
  }
}

Result make_line(const LineArguments& options, const sim::SimulationOptions& engine_options, run::TextSink* steps) {
  Result result;
  result.pulses = displacement_of(options);
  const auto engine = sim::make_engine(engine_options);
  run::StepRecorder::Options recording;
  recording.steps = steps;
  recording.clock_hz = engine_options.clock_hz;
  recording.plot = options.plot.has_value();
  run::StepRecorder recorder(recording, kinematics::Kinematics::in_pulses(engine_options.axes));
  driver::Card card = driver::Card::open(*engine);
  recorder.detail_of(0);
  engine->set_sink(&recorder);
  const Made made = any_line(card, options, {}, &recorder);
  const driver::Snapshot snapshot = card.read_snapshot();
  engine->set_sink(nullptr);
  recorder.finish();

  result.final.assign(snapshot.position.begin(), snapshot.position.begin() + engine_options.axes);
  for (std::size_t a = 0; a < result.pulses.size(); ++a) {
    if (result.final[a] != result.pulses[a]) {
      throw std::runtime_error(
          fmt::format("axis {}: ended at pulse {}, asked for {}", a, result.final[a], result.pulses[a]));
    }
  }
  if (options.plot) result.plot = plot_of(result.pulses, recorder);
  result.steps = recorder.steps();
  result.line_clocks = made.line_clocks;
  result.parts = made.parts;
  result.slowed = made.slowed;
  result.cycles = engine->cycles();
  result.clock_hz = engine_options.clock_hz;
  result.lockstep_cycles = engine->lockstep_cycles();
  result.comparisons = engine->comparisons();
  result.largest_line_deviation = recorder.deviation().largest_line();
  result.largest_arc_deviation = recorder.deviation().largest_arc();
  return result;
}

nlohmann::ordered_json json_of(const Result& result) {
  nlohmann::ordered_json json;
  json["final_position"] = result.final;
  json["steps"] = result.steps;
  json["line_clocks"] = result.line_clocks;
  json["slowed"] = result.slowed;
  json["parts"] = result.parts;
  json["cycles"] = result.cycles;
  json["seconds"] = static_cast<double>(result.cycles) / result.clock_hz;
  json["clock_hz"] = result.clock_hz;
  json["lockstep_cycles"] = nullptr;
  if (result.lockstep_cycles) json["lockstep_cycles"] = *result.lockstep_cycles;
  json["mismatches"] = 0;  // a mismatch would have ended the run
  json["max_deviation"] = {{"line", result.largest_line_deviation}, {"arc", result.largest_arc_deviation}};
  return json;
}

std::string summary(const Result& result) {
  std::string text = fmt::format("line of {} pulses in {} clocks ({:g} s at {:g} MHz){}: ended at {}\n",
                                 fmt::join(result.pulses, ", "), result.line_clocks,
                                 static_cast<double>(result.line_clocks) / result.clock_hz, result.clock_hz * 1e-6,
                                 result.slowed ? ", slowed to keep a limit" : "", fmt::join(result.final, ", "));
  text += fmt::format("  largest distance from the line: {:.4f} pulses\n", result.largest_line_deviation);
  if (result.lockstep_cycles) {
    text += fmt::format("  lockstep: {} cycles, {} comparisons, 0 mismatches\n", *result.lockstep_cycles,
                        result.comparisons);
  }
  return text;
}

// The result of a line on an external card, from its registers.
struct CardResult {
  std::vector<std::int64_t> moved;
  std::uint64_t line_clocks = 0;
  std::size_t parts = 0;
  bool slowed = false;
  std::uint32_t clock_hz = 0;
};

// Bit n: axis n moves.
std::uint8_t axes_of(const std::vector<std::int64_t>& pulses) {
  unsigned axes = 0;
  for (std::size_t n = 0; n < pulses.size(); ++n) axes |= pulses[n] != 0 ? 1U << n : 0U;
  return static_cast<std::uint8_t>(axes);
}

CardResult make_line_on(driver::Card& card, transport::Connection& connection, const LineArguments& options) {
  const std::vector<std::int64_t> pulses = displacement_of(options);
  if (pulses.size() > card.identification().axes) {
    throw UsageError(fmt::format("--to: the card has {} axes", card.identification().axes));
  }
  if (options.no_ramp) plan_of(options, card.timing(), pulses);  // impossible lines are refused first
  const std::uint8_t moved_axes = axes_of(pulses);
  const machine::Machine machine = options.machine.load();
  const run::CardPlace found = run::read_card_place(card);
  run::check_line(machine, found, moved_axes, options.card.trust_position);
  run::check_line_end(machine, found, pulses);
  take_over(card, options.card, machine);
  const run::CardPlace place = run::read_card_place(card);
  const std::string limits_off = run::check_line_end(machine, place, pulses);
  if (!place.was_set()) tell("note", "the card was reset: machine zero is where it stands now");
  if (!limits_off.empty()) {
    tell("note", fmt::format("soft limits of {} are off: not homed, or in other scales", limits_off));
  }
  run::keep_place(card, place, run::kScalesInPulses, moved_axes);
  if (!options.no_ramp) run::set_keeps_place(card, in_pulses(machine, pulses.size()));
  run::guard_homed_axes(card, machine, run::read_card_place(card));
  run::configure_outputs(card, machine);
  const driver::Snapshot& before = place.now;
  const Made made = watched_line(card, connection, options, before);
  CardResult result;
  result.moved = moved(card, before, pulses.size());
  for (std::size_t a = 0; a < pulses.size(); ++a) {
    if (result.moved[a] != pulses[a]) {
      throw std::runtime_error(fmt::format("axis {}: moved by {} pulses, asked for {}", a, result.moved[a], pulses[a]));
    }
  }
  result.line_clocks = made.line_clocks;
  result.parts = made.parts;
  result.slowed = made.slowed;
  result.clock_hz = card.identification().clock_hz;
  return result;
}

void line_on_card(const LineArguments& options, const transport::CardUrl& url) {
  options.engine.refuse_with(options.card);
  refuse_with_card(options.card, "--steps", options.steps.has_value());
  refuse_with_card(options.card, "--plot", options.plot.has_value());
  Outputs outputs;
  Output* const json = outputs.add("--json", options.json);
  outputs.check();
  outputs.open();
  CardResult result;
  with_card(url, Purpose::kMove, [&](driver::Card& card, transport::Connection& connection) {
    result = make_line_on(card, connection, options);
  });
  if (json != nullptr) {
    nlohmann::ordered_json text;
    text["card"] = url.text;
    text["moved"] = result.moved;
    text["line_clocks"] = result.line_clocks;
    text["slowed"] = result.slowed;
    text["parts"] = result.parts;
    text["clock_hz"] = result.clock_hz;
    json->write(text.dump(2) + "\n");
  }
  outputs.commit(fmt::format("line in {} clocks ({:g} s at {:g} MHz){} on {}: moved by {} pulses\n", result.line_clocks,
                             static_cast<double>(result.line_clocks) / result.clock_hz, result.clock_hz * 1e-6,
                             result.slowed ? ", slowed to keep a limit" : "", url.text, fmt::join(result.moved, ", ")));
}

// Refuses options of the other kind of line. The machine's limits apply to a line with ramps, and slow it down; a line
// without ramps does not use the machine.
void refuse_other_line(const LineArguments& options) {
  const auto refuse = [](const char* option, bool given, const char* why) {
    if (given) throw UsageError(fmt::format("{}: {}", option, why));
  };
  if (options.no_ramp) return;
  refuse("--max-velocity", !options.max_velocity.empty(),
         "only with --no-ramp. With ramps, --set axis.x.max_velocity limits the speed");
  refuse("--slow", options.slow, "only with --no-ramp. With ramps, a line always keeps the machine's limits");
}

void line_in_simulation(const LineArguments& options) {
  refuse_other_line(options);
  if (const auto url = options.card.url()) return line_on_card(options, *url);
  Outputs outputs;
  Output* const json = outputs.add("--json", options.json);
  Output* const steps = outputs.add("--steps", options.steps);
  Output* const trace = outputs.add("--trace", options.engine.trace, true);
  Output* const plot = outputs.add("--plot", options.plot);
  outputs.check();
  // Uses a card of 4 or 8 axes even without a trace, so that tracing does not change the results.
  const auto axes = simulation::traced_axes(static_cast<unsigned>(displacement_of(options).size()));
  sim::SimulationOptions engine = options.engine.options(axes, kDefaultClock, kDefaultClock);
  outputs.open();
  if (trace != nullptr) engine.trace->path = trace->path_to_write();
  const Result result = make_line(options, engine, steps);
  if (trace != nullptr) require_whole_waveform(trace->path_to_write(), *options.engine.trace);
  if (json != nullptr) json->write(json_of(result).dump(2) + "\n");
  if (plot != nullptr) plot->write(run::svg(result.plot));
  outputs.commit(summary(result));
}

}  // namespace

void add_line_command(CLI::App& app) {
  auto options = std::make_shared<LineArguments>();
  CLI::App* command = app.add_subcommand(
      "line", "move along one straight line, given in pulses, with the machine's ramps or without any (--no-ramp)");
  command->add_option("--from", options->from, "start of the line, pulses, one value per axis (default: 0)")
      ->delimiter(',')
      ->check(pulses())
      ->type_name("X,Y,...");
  command->add_option("--to", options->to, "end of the line, pulses, one value per axis")
      ->delimiter(',')
      ->check(pulses())
      ->required()
      ->type_name("X,Y,...");
  auto* velocity =
      command->add_option("--velocity", options->velocity, "speed in lines per second, v of the second paper")
          ->check(positive());
  auto* duration =
      command->add_option("--duration", options->duration, "duration of the line without its ramps, seconds")
          ->check(positive());
  auto* speed = command->add_option("--speed", options->speed, "speed along the line, pulses/s (default 1000)")
                    ->check(positive());
  velocity->excludes(duration)->excludes(speed);
  duration->excludes(speed);
  command
      ->add_option("--max-velocity", options->max_velocity,
                   "with --no-ramp: speed limit of each axis, pulses/s. 0 is no limit (default: 0)")
      ->delimiter(',')
      ->transform(whole_number(0, UINT32_MAX, "pulses/s"));
  command->add_flag("--slow", options->slow,
                    "with --no-ramp: slow the line down to keep --max-velocity (default: refuse it)");
  command->add_flag("--no-ramp", options->no_ramp,
                    "move at full speed from the first pulse to the last, like the lines of the papers. One burst of "
                    "register writes starts the line");
  options->machine.add_to(*command);
  options->card.add_to_mover(*command);
  options->engine.add_to(*command);
  command->add_option("--json", options->json, "write the summary to a JSON file")->type_name("FILE");
  command->add_option("--plot", options->plot, "write a picture of path and speed to an SVG file")
      ->type_name("FILE.svg")
      ->check(svg_file());
  command
      ->add_option("--steps", options->steps,
                   "write every leading edge at a STEP pin to a CSV file: cycle,axis,direction")
      ->type_name("FILE");
  command->callback([options] { line_in_simulation(*options); });
}

}  // namespace trammel::app
