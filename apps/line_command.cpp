#include "line_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine_options.hpp"
#include "errors.hpp"
#include "outputs.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/run/step_recorder.hpp"

namespace trammel::app {
namespace {

constexpr std::uint32_t kDefaultClock = 1'000'000;
constexpr double kDefaultSpeed = 1000;  // pulses/s

struct Options {
  std::vector<std::int64_t> from;
  std::vector<std::int64_t> to;
  std::optional<double> velocity;
  std::optional<double> duration;
  std::optional<double> speed;
  std::vector<std::uint64_t> max_velocity;
  bool slow = false;
  EngineChoice engine;
  std::optional<std::string> json;
  std::optional<std::string> steps;
};

std::vector<std::int64_t> displacement_of(const Options& options) {
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

// The line's duration in clocks, rounded to the nearest.
std::uint64_t clocks_of(const Options& options, const std::vector<std::int64_t>& displacement, double clock_hz) {
  double seconds = 0;
  if (options.velocity) {
    seconds = 1 / *options.velocity;
  } else if (options.duration) {
    seconds = *options.duration;
  } else {
    double square = 0;
    for (const std::int64_t p : displacement) square += static_cast<double>(p) * static_cast<double>(p);
    seconds = std::sqrt(square) / options.speed.value_or(kDefaultSpeed);
  }
  const double clocks = std::round(seconds * clock_hz);
  if (clocks >= std::ldexp(1.0, 62)) throw UsageError("the line takes longer than the card can count");
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(clocks));
}

driver::LineLimits limits_of(const Options& options) {
  driver::LineLimits limits;
  if (options.max_velocity.size() > card_map::kMaxAxes) throw UsageError("--max-velocity: a card has at most 8 axes");
  std::copy(options.max_velocity.begin(), options.max_velocity.end(), limits.max_velocity.begin());
  limits.policy = options.slow ? driver::LimitPolicy::kSlow : driver::LimitPolicy::kRefuse;
  return limits;
}

void execute(const Options& options) {
  const std::vector<std::int64_t> pulses = displacement_of(options);
  const unsigned axes = card_axes(pulses.size());
  const sim::SimulationOptions engine_options = options.engine.options(axes, kDefaultClock, kDefaultClock);
  const auto engine = sim::make_engine(engine_options);
  const std::unique_ptr<FileSink> steps = options.steps ? std::make_unique<FileSink>(*options.steps) : nullptr;
  run::StepRecorder::Options recording;
  recording.steps = steps.get();
  recording.clock_hz = engine_options.clock_hz;
  recording.steps_per_mm.assign(axes, 1.0);
  run::StepRecorder recorder(recording);
  // The path of direct mode has no command; the recorder measures it as one line over its clocks.
  driver::Displacement displacement{};
  std::copy(pulses.begin(), pulses.end(), displacement.begin());
  driver::Card card = driver::Card::open(*engine);
  const driver::OneShotPlan plan = [&] {
    try {
      return driver::plan_line_clocks(card.timing(), displacement, clocks_of(options, pulses, engine_options.clock_hz),
                                      limits_of(options));
    } catch (const driver::ArgumentError& error) {
      throw UsageError(error.what());
    }
  }();
  driver::LineCommand line;
  line.ticks = plan.part(0).length;
  line.mask = plan.part(0).mask;
  for (std::size_t a = 0; a < pulses.size(); ++a) {
    const auto increment = static_cast<std::int64_t>(plan.part(0).frequency[a]);
    line.increment[a] = pulses[a] < 0 ? -increment : increment;
  }
  recorder.command(0, line);
  engine->set_sink(&recorder);
  driver::run_line(card, plan);
  const driver::Snapshot snapshot = card.snapshot();
  engine->set_sink(nullptr);
  recorder.finish();
  if (steps) steps->close();

  const std::vector<std::int64_t> final(snapshot.position.begin(), snapshot.position.begin() + axes);
  for (std::size_t a = 0; a < pulses.size(); ++a) {
    if (final[a] != pulses[a]) {
      throw std::runtime_error(fmt::format("axis {}: ended at pulse {}, asked for {}", a, final[a], pulses[a]));
    }
  }
  const std::uint64_t cycles = engine->cycles();
  if (options.json) {
    nlohmann::ordered_json json;
    json["final_position"] = final;
    json["steps"] = recorder.steps();
    json["line_clocks"] = plan.clocks();
    json["slowed"] = plan.slowed();
    json["parts"] = plan.size();
    json["cycles"] = cycles;
    json["seconds"] = static_cast<double>(cycles) / engine_options.clock_hz;
    json["clock_hz"] = engine_options.clock_hz;
    json["lockstep_cycles"] = nullptr;
    if (const auto compared = engine->lockstep_cycles()) json["lockstep_cycles"] = *compared;
    json["mismatches"] = 0;  // one would have ended the run
    json["max_deviation"] = {{"line", recorder.deviation().largest_line()},
                             {"arc", recorder.deviation().largest_arc()}};
    write_json_file(json, *options.json);
  }
  if (options.json != "-" && options.steps != "-") {
    fmt::print("line of {} pulses in {} clocks ({:g} s at {:g} MHz){}: ended at {}\n", fmt::join(pulses, ", "),
               plan.clocks(), static_cast<double>(plan.clocks()) / engine_options.clock_hz,
               engine_options.clock_hz * 1e-6, plan.slowed() ? ", slowed to keep a limit" : "", fmt::join(final, ", "));
    fmt::print("  largest distance from the line: {:.4f} pulses\n", recorder.deviation().largest_line());
    if (const auto compared = engine->lockstep_cycles()) {
      fmt::print("  lockstep: {} cycles, {} comparisons, 0 mismatches\n", *compared, engine->comparisons());
    }
  }
}

}  // namespace

void add_line_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("line", "make one straight line in direct mode: one burst of register writes");
  command->add_option("--from", options->from, "start, pulses, one value an axis (default: 0)")
      ->delimiter(',')
      ->type_name("X,Y,...");
  command->add_option("--to", options->to, "end, pulses, one value an axis")
      ->delimiter(',')
      ->required()
      ->type_name("X,Y,...");
  auto* velocity =
      command->add_option("--velocity", options->velocity, "lines a second: the paper's v")->check(positive());
  auto* duration = command->add_option("--duration", options->duration, "seconds")->check(positive());
  auto* speed =
      command->add_option("--speed", options->speed, "pulses/s along the path (default 1000)")->check(positive());
  velocity->excludes(duration)->excludes(speed);
  duration->excludes(speed);
  command->add_option("--max-velocity", options->max_velocity, "limit of each axis, pulses/s (0: none)")
      ->delimiter(',');
  command->add_flag("--slow", options->slow, "slow down to keep a limit instead of refusing");
  options->engine.add_to(*command);
  command->add_option("--json", options->json, "summary as JSON ('-': standard output)")->type_name("FILE");
  command->add_option("--steps", options->steps, "every leading edge at a STEP pin: cycle,axis,direction")
      ->type_name("FILE");
  command->callback([options] {
    require_writable({options->json, options->steps, options->engine.trace});
    execute(*options);
  });
}

}  // namespace trammel::app
