#include "run_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "card_run.hpp"
#include "common/card_choice.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/outputs.hpp"
#include "common/progress_bar.hpp"
#include "common/standard_streams.hpp"
#include "common/stop_at_signals.hpp"
#include "common/terminal.hpp"
#include "common/waveform.hpp"
#include "common/world_choice.hpp"
#include "engine_speed.hpp"
#include "motion_options.hpp"
#include "parameter_file.hpp"
#include "profile_report.hpp"
#include "program_check.hpp"
#include "program_file.hpp"
#include "run_report.hpp"
#include "run_surroundings.hpp"
#include "trammel/driver/low_level/requests.hpp"
#include "trammel/report/page.hpp"
#include "trammel/report/report_writer.hpp"
#include "trammel/simulation/simulated_card.hpp"
#include "trammel/simulation/simulated_run.hpp"

namespace trammel::app {
namespace {

// A simulated card at 1 MHz runs programs faster than real time; compared with the real clock only the time resolution
// differs.
constexpr std::uint32_t kSimulatedClock = 1'000'000;

constexpr std::uint64_t kDefaultPipeLimit = 512;  // MiB

struct RunArguments {
  std::string program;
  CardChoice card;
  MachineChoice machine;
  EngineChoice engine;
  MotionChoice motion;
  WorldChoice world;
  std::optional<std::string> json;
  std::optional<std::string> steps;
  std::optional<std::string> path_steps;
  std::optional<std::string> outputs;
  std::optional<std::string> plot;
  std::optional<std::string> parameters;
  std::optional<std::string> report;
  std::optional<std::string> report_window;
  bool progress = false;
  bool check = false;
  bool stream = false;
  bool resume = false;
  bool yes = false;
  std::optional<std::uint64_t> pipe_limit;  // MiB
};

void refuse_contradictions(const RunArguments& options) {
  const auto refuse = [](const char* option, bool given, const char* why) {
    if (given) throw UsageError(fmt::format("{}: {}", option, why));
  };
  if (options.stream) {
    refuse("--pipe-limit", options.pipe_limit.has_value(), "not with --stream, which copies nothing");
    refuse("--plot", options.plot.has_value(), "needs the whole program before the run, so not with --stream");
    refuse("--report", options.report.has_value(), "needs the whole program before the run, so not with --stream");
  }
  refuse("--report-window", options.report_window && !options.report, "needs --report");
  refuse("--resume", options.resume && options.stream, "needs the whole program before the run, so not with --stream");
  refuse("--resume", options.resume && options.motion.first_line != 1,
         "not with --from-line: it begins where the run was interrupted");
  refuse("--report", options.report && !report::page_is_built(), report::kHowToBuildPage);
  refuse("--parameters", options.parameters == "-", "needs a file, because it is also read");
  if (!options.check) return;
  constexpr const char* kWhy = "not with --check, which runs nothing";
  refuse("--steps", options.steps.has_value(), kWhy);
  refuse("--path-steps", options.path_steps.has_value(), kWhy);
  refuse("--outputs", options.outputs.has_value(), kWhy);
  refuse("--plot", options.plot.has_value(), kWhy);
  refuse("--report", options.report.has_value(), kWhy);
  refuse("--trace", options.engine.trace.has_value(), kWhy);
  refuse("--world", options.world.file.has_value(), kWhy);
  refuse("--stream", options.stream, kWhy);
}

void refuse_rapids_at_zero(const RunArguments& options, double rapid_percent, const run::Plan& plan) {
  if (rapid_percent != 0) return;
  if (options.stream)
    throw UsageError("--rapid-override: 0 needs the whole program before the run, so not with --stream");
  if (plan.rapids == 0) return;
  throw UsageError(fmt::format(
      "--rapid-override: at 0 percent this program would never finish, because it has {} rapids", plan.rapids));
}

void tell_of_nothing(const run::Plan& plan) {
  if (plan.segments == 0) tell("note", fmt::format("{} moves nothing", plan.file));
}

// Step lists, pictures and timed operator events need the pins and clocks of a simulated card.
void refuse_what_needs_the_simulation(const RunArguments& options) {
  const CardChoice& card = options.card;
  options.engine.refuse_with(card);
  options.world.refuse_with(card);
  refuse_with_card(card, "--steps", options.steps.has_value());
  refuse_with_card(card, "--path-steps", options.path_steps.has_value());
  refuse_with_card(card, "--outputs", options.outputs.has_value());
  refuse_with_card(card, "--plot", options.plot.has_value());
  refuse_with_card(card, "--report", options.report.has_value());
  refuse_with_card(card, "--override-at", !options.motion.override_at.empty());
  refuse_with_card(card, "--hold-at", !options.motion.hold_at.empty());
  refuse_with_card(card, "--input-at", !options.motion.input_at.empty());
  refuse_with_card(card, "--limit-bus", options.motion.bytes_per_second.has_value());
  if (options.check) throw UsageError("--check: nothing runs, so it takes no --card");
}

// Throws if a warning cannot be written. Most warnings come before any motion, and then nothing moves.
void warn(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) tell("warning", text);
  finish_standard_streams();
}

// Settings of the program, for every card.
run::RunSettings settings_of(const RunArguments& options) {
  run::RunSettings settings = options.motion.settings();
  if (options.parameters) settings.reader.parameters = load_parameters(*options.parameters);
  return settings;
}

// The largest override that the machine's limits allow.
double max_percent(const machine::Machine& machine) { return 100 * machine.motion.max_override; }

std::optional<std::uint64_t> copy_limit(const RunArguments& options) {
  if (options.stream) return std::nullopt;
  return options.pipe_limit.value_or(kDefaultPipeLimit) << 20U;
}

// Each call returns the lines from the beginning. `file` must outlive them. `meanwhile`: as in gcode::FileLines.
run::ProgramLines lines_of(const ProgramFile& file, const std::function<void()>& meanwhile = {}) {
  return [&file, meanwhile]() -> std::unique_ptr<gcode::LineSource> {
    std::unique_ptr<gcode::FileLines> lines(new gcode::FileLines(file.lines()));
    lines->set_meanwhile(meanwhile);
    return lines;
  };
}

// Refuses to overwrite the inputs of the run.
void keep_inputs(const RunArguments& options, Outputs& outputs) {
  outputs.keep("the program", options.program);
  if (const auto file = options.machine.source()) outputs.keep("the machine file", *file);
  if (options.world.file) outputs.keep("the world file", *options.world.file);
  if (options.world.events) outputs.keep("the script of events", *options.world.events);
  outputs.check();
}

// With --stream the program is read only once, so the hash of its lines is not known before the run.
ResumeKey key_of(const RunArguments& options, const ProgramFile& file) {
  ResumeKey key;
  key.program = file.name();
  key.planner = planner::kPlanVersion;
  key.options = options.motion.of_plan();
  if (options.parameters) {
    TextHash parameters;
    parameters.add(parameters_text(load_parameters(*options.parameters)));
    key.options["--parameters"] = parameters.text();
  }
  key.machine_hash = options.machine.hash();
  if (options.stream) return key;
  TextHash program;
  gcode::FileLines lines = file.lines();
  for (std::string_view line; lines.next(line);) program.add(std::string(line));
  key.program_hash = program.text();
  return key;
}

void run_on_card(const RunArguments& options, const transport::CardUrl& url) {
  refuse_what_needs_the_simulation(options);
  Outputs outputs;
  Output* const json = outputs.add("--json", options.json);
  Output* const parameters = outputs.add("--parameters", options.parameters);
  keep_inputs(options, outputs);
  const machine::Machine machine = options.machine.load();
  warn(jerk_warnings(machine));
  CardRunOptions run;
  run.settings = settings_of(options);
  run.stream = options.stream;
  run.card = options.card;
  run.resume = options.resume;
  run.yes = options.yes;
  run.progress = options.progress;
  run.max_percent = max_percent(machine);
  const simulation::Operation operation = options.motion.operation(run.max_percent);
  run.percent = operation.percent;
  run.rapid_percent = operation.rapid_percent;
  run.planned = [&](const run::Plan& plan) {
    refuse_rapids_at_zero(options, run.rapid_percent, plan);
    if (!options.stream) tell_of_nothing(plan);
    outputs.open();
    warn(plan_warnings(plan));
  };
  const ProgramFile file(options.program, copy_limit(options));
  run.key = key_of(options, file);
  CardRunResult result;
  with_card(url, Purpose::kMove, [&](driver::Card& card, transport::Connection& connection) {
    // While program lines arrive slowly, this serves the card's watchdog and stop requests.
    const run::ProgramLines lines = lines_of(file, [&card] { driver::serve_requests(card); });
    result = run_on_card(lines, machine, card, connection, run);
  });
  result.card = url.text;
  if (parameters != nullptr) parameters->write(parameters_text(result.outcome.parameters));
  if (json != nullptr) json->write(json_text(result));
  outputs.commit(summary(result) + options.machine.line());
}

void check(const run::ProgramLines& lines, const MachineChoice& choice, const machine::Machine& machine,
           const planner::CardLimits& card, const run::RunSettings& settings, Outputs& outputs, Output* json) {
  const CheckResult result = check_program(lines, machine, card, settings);
  tell_of_nothing(result.plan);
  warn(plan_warnings(result.plan));
  outputs.open();
  if (json != nullptr) json->write(json_text(result));
  outputs.commit(summary(result) + choice.line());
}

// The output files of a simulated run; nullptr for an option that was not given.
struct SimulationFiles {
  explicit SimulationFiles(const RunArguments& options)
      : json(all.add("--json", options.json)),
        plot(all.add("--plot", options.plot)),
        report(all.add("--report", options.report)),
        trace(all.add("--trace", options.engine.trace, true)),
        steps(all.add("--steps", options.steps)),
        path_steps(all.add("--path-steps", options.path_steps)),
        outputs(all.add("--outputs", options.outputs)),
        parameters(all.add("--parameters", options.check ? std::optional<std::string>() : options.parameters)) {
    keep_inputs(options, all);
  }

  Outputs all;
  Output* json;
  Output* plot;
  Output* report;
  Output* trace;
  Output* steps;
  Output* path_steps;
  Output* outputs;
  Output* parameters;
};

simulation::RunOptions simulation_options(const RunArguments& options, const machine::Machine& machine,
                                          const SimulationFiles& files) {
  simulation::RunOptions run;
  run.settings = settings_of(options);
  run.max_percent = max_percent(machine);
  run.operation = options.motion.operation(run.max_percent);
  run.steps = files.steps;
  run.path_steps = files.path_steps;
  run.outputs = files.outputs;
  run.report = files.report;
  run.plot = files.plot != nullptr;
  return run;
}

// Notes for people before a long wait.
void tell_of_engine(const sim::SimulationOptions& engine, unsigned axes, double card_seconds) {
  if (const auto text = long_run_note(engine, card_seconds)) tell("note", *text);
  if (engine.axes != axes) {
    tell("note", fmt::format("the trace shows a card with {} axes, because only cards with 4 or 8 axes can be traced",
                             engine.axes));
  }
}

// Shows the progress of the run.
class SimulationProgress final : public run::Observer {
 public:
  SimulationProgress(const simulation::SimulatedRun& run, double planned_seconds, double clock_hz, bool always)
      : run_(run), planned_seconds_(planned_seconds), clock_hz_(clock_hz), bar_(always) {}
  void sent() override { progress({}); }
  void progress(const run::Progress& /*progress*/) override {
    const double seconds = static_cast<double>(run_.cycles()) / clock_hz_;
    bar_.show(planned_seconds_ > 0 ? seconds / planned_seconds_ : 1.0,
              fmt::format("{:.1f} of {:.1f} s of card time", seconds, planned_seconds_));
  }

 private:
  const simulation::SimulatedRun& run_;
  double planned_seconds_;
  double clock_hz_;
  ProgressBar bar_;
};

// Records events around the card for the page of a run; empty without --report.
struct PageListeners {
  // Construct after make_card().
  PageListeners(const SimulationFiles& files, simulation::SimulatedRun& run, world::World* world) {
    if (files.report == nullptr) return;
    holds.emplace(run);
    run.runner().add(*holds);
    if (world != nullptr) record.emplace(*files.report, *world);
  }
  std::optional<HoldWatch> holds;
  std::optional<WorldRecord> record;
};

// A simulation, its world, and their listeners.
struct Simulation {
  const RunArguments& options;
  const machine::Machine& machine;
  run::PlannedProfile profile;
  simulation::SimulatedRun& run;
  world::World* world;
  SimulationFiles& files;
};

void write_report(const Simulation& of, PageListeners& listeners, const simulation::RunResult& result,
                  const std::optional<StopCause>& cause) {
  if (listeners.record) listeners.record->finish();
  const WorldRecord* const record = listeners.record ? &*listeners.record : nullptr;
  of.run.report()->finish(
      report_json(result, of.profile, surroundings_json(of.machine, result, *listeners.holds, of.world, record, cause)),
      cause.has_value());
}

// After a run that a cause has ended, writes only the page. Its errors are reported, but the run's own error remains.
void report_stop(const Simulation& of, PageListeners& listeners, const run::RunError& error) {
  if (of.files.report == nullptr) return;
  try {
    const auto motors = of.machine.motors();
    const StopCause cause = stop_cause(of.run.card(), error, of.run.runner().last_plan(), motors);
    write_report(of, listeners, of.run.stopped_result(listeners.holds->commands()), cause);
    of.files.all.commit_alone(*of.files.report);
    tell("note", fmt::format("{} shows the run up to its stop", *of.options.report));
  } catch (const std::exception& why) {
    tell("note", fmt::format("--report: {}", why.what()));
  }
}

// Runs the program after all checks, to the end of the motion.
run::Outcome stream_to_simulation(const Simulation& of, const sim::SimulationOptions& engine, double planned_seconds,
                                  PageListeners& listeners) {
  SimulationProgress progress(of.run, planned_seconds, engine.clock_hz, of.options.progress);
  of.run.runner().add(progress);
  try {
    return run_until_signal(of.run.runner(), of.run.card(), of.machine, of.options.stream);
  } catch (const run::RunError& error) {
    if (of.world != nullptr) tell("note", world_text(*of.world, "; "));
    report_stop(of, listeners, error);
    throw;
  } catch (...) {
    // After any error, report the machine's position.
    if (of.world != nullptr) tell("note", world_text(*of.world, "; "));
    throw;
  }
}

void write_results(const Simulation& of, PageListeners& listeners, const simulation::RunResult& result) {
  const RunArguments& options = of.options;
  SimulationFiles& files = of.files;
  const world::World* const world = of.world;
  if (options.stream) warn(plan_warnings(result.plan));
  if (files.trace != nullptr) require_whole_waveform(files.trace->path_to_write(), *options.engine.trace);
  if (files.json != nullptr) {
    files.json->write(json_text(result, of.profile, world != nullptr ? world_json(*world) : nullptr));
  }
  if (files.parameters != nullptr) files.parameters->write(parameters_text(result.outcome.parameters));
  if (files.plot != nullptr) files.plot->write(run::svg(result.plot));
  if (files.report != nullptr) write_report(of, listeners, result, std::nullopt);
  const std::string about_world = world != nullptr ? "  " + world_text(*world, "\n  ") + "\n" : "";
  files.all.commit(run_summary(result, of.profile) + about_world + options.machine.line());
}

void run_in_simulation(const RunArguments& options) {
  refuse_contradictions(options);
  if (const auto url = options.card.url()) return run_on_card(options, *url);
  if (options.resume)
    throw UsageError("--resume: needs --card, because a run on a card that this command simulates cannot be resumed");
  SimulationFiles files(options);
  const machine::Machine machine = options.machine.load();
  warn(jerk_warnings(machine));
  simulation::RunOptions settings = simulation_options(options, machine, files);
  const auto axes = static_cast<unsigned>(machine.motors());
  sim::SimulationOptions engine = options.engine.options(files.trace != nullptr ? simulation::traced_axes(axes) : axes,
                                                         kSimulatedClock, machine.clock_hz);
  if (options.report_window) {
    settings.report_window = window_of("--report-window", *options.report_window, engine.clock_hz);
  }
  const ProgramFile file(options.program, copy_limit(options));
  const planner::CardLimits card = simulation::limits_of(engine);
  const std::unique_ptr<world::World> world = options.world.make(engine.clock_hz, settings.operation.events);
  settings.surroundings = [&world](auto made) { return in_world(world.get(), std::move(made)); };
  if (options.check) {
    return check(lines_of(file), options.machine, machine, card, settings.settings, files.all, files.json);
  }
  simulation::SimulatedRun run(lines_of(file), machine, card, settings);
  const run::Plan plan = options.stream ? run::Plan{} : run.runner().plan();
  refuse_rapids_at_zero(options, settings.operation.rapid_percent, plan);
  if (!options.stream) tell_of_nothing(plan);
  files.all.open();
  if (files.trace != nullptr) engine.trace->path = files.trace->path_to_write();
  warn(plan_warnings(plan));
  const double bytes_per_second = settings.operation.bytes_per_second;
  if (const auto text = slow_bus_note(bytes_per_second, plan.commands, plan.seconds)) tell("note", *text);
  const double card_seconds = std::max(plan.seconds, bus_seconds(bytes_per_second, plan.commands));
  tell_of_engine(engine, axes, card_seconds);
  run.make_card(engine);
  PageListeners listeners(files, run, world.get());
  const Simulation simulation{options, machine,     run::planned_profile(machine, settings.settings),
                              run,     world.get(), files};
  const run::Outcome outcome = stream_to_simulation(simulation, engine, card_seconds, listeners);
  const simulation::RunResult result = run.result(outcome);
  const double seconds = static_cast<double>(result.cycles) / engine.clock_hz;
  for (const std::string& text : late_event_notes(settings.operation.events, result.events.size(), seconds)) {
    tell("note", text);
  }
  write_results(simulation, listeners, result);
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<RunArguments>();
  CLI::App* command =
      app.add_subcommand("run", "run a G-code program on the simulated card, or on an external card (--card)");
  command->add_option("program", options->program, "G-code file ('-': standard input)")->required()->type_name("FILE");
  options->machine.add_to(*command);
  options->card.add_to_mover(*command);
  options->engine.add_to(*command, "1000000 with engine rtl, the machine file's with model");
  options->motion.add_to(*command);
  options->world.add_to(*command);
  command->add_option("--json", options->json, "write the summary to a JSON file")->type_name("FILE");
  command
      ->add_option("--steps", options->steps,
                   "write every leading edge at a STEP pin to a CSV file: cycle,axis,direction")
      ->type_name("FILE");
  command
      ->add_option("--path-steps", options->path_steps,
                   "write every step of the path to a CSV file: command,tick,axis,direction")
      ->type_name("FILE");
  command
      ->add_option("--outputs", options->outputs, "write every change of an output to a CSV file: cycle,output,level")
      ->type_name("FILE");
  command
      ->add_option("--parameters", options->parameters,
                   "file of the program's parameters, offsets, homes and tool. It is read before the run if it exists, "
                   "and written after a successful run (default: none of them is kept)")
      ->type_name("FILE");
  command->add_option("--plot", options->plot, "write a picture of path and speed to an SVG file")
      ->type_name("FILE.svg")
      ->check(svg_file());
  command
      ->add_option("--report", options->report,
                   "write a page of the run to an HTML file, for a browser: path, speeds, pins, program")
      ->type_name("FILE")
      ->check(page_file());
  command
      ->add_option(
          "--report-window", options->report_window,
          "with --report: show the pulses of this interval only, seconds of card time. Either end may be left out")
      ->type_name("FROM:TO");
  command->add_flag("--progress", options->progress, "show the progress even if standard error is not a terminal");
  command->add_flag("--resume", options->resume,
                    "with --card: resume where the last run of this program was interrupted. The steps are those of "
                    "the uninterrupted run");
  command->add_flag("--yes", options->yes,
                    "with --resume and --from-line: move to the position where the run begins without asking");
  command->add_flag("--check", options->check, "read, check, plan and time the program; nothing runs");
  command->add_flag("--stream", options->stream,
                    "read the program while it runs, without checking the whole of it first. At an error the machine "
                    "stops in the middle of the program, and the exit status is 1");
  command
      ->add_option("--pipe-limit", options->pipe_limit,
                   fmt::format("maximum size of a program from standard input, a pipe or a device, in MiB. Such a "
                               "program is copied first (default {})",
                               kDefaultPipeLimit))
      ->transform(whole_number(1, 1'000'000, "MiB"))
      ->type_name("MIB");
  command->footer("One FILE may be '-' for standard output. The summary then goes to standard error.");
  command->callback([options] { run_in_simulation(*options); });
}

}  // namespace trammel::app
