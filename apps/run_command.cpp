#include "run_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "card_choice.hpp"
#include "card_run.hpp"
#include "engine_options.hpp"
#include "engine_speed.hpp"
#include "errors.hpp"
#include "machine_choice.hpp"
#include "motion_options.hpp"
#include "outputs.hpp"
#include "parameter_file.hpp"
#include "profile_report.hpp"
#include "program_check.hpp"
#include "program_file.hpp"
#include "program_run.hpp"
#include "run_report.hpp"
#include "standard_streams.hpp"
#include "terminal.hpp"
#include "trammel/report/page.hpp"
#include "trammel/report/report_writer.hpp"
#include "waveform.hpp"

namespace trammel::app {
namespace {

// A simulated card at 1 MHz runs programs faster than life; only the resolution in time differs from the real clock.
constexpr std::uint32_t kSimulatedClock = 1'000'000;

constexpr std::uint64_t kDefaultPipeLimit = 512;  // MiB

struct RunArguments {
  std::string program;
  CardChoice card;
  MachineChoice machine;
  EngineChoice engine;
  MotionChoice motion;
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
  std::optional<std::uint64_t> pipe_limit;  // MiB
};

void refuse_contradictions(const RunArguments& options) {
  const auto refuse = [](const char* option, bool given, const char* why) {
    if (given) throw UsageError(fmt::format("{}: {}", option, why));
  };
  if (options.stream) {
    refuse("--pipe-limit", options.pipe_limit.has_value(), "nothing is copied with --stream");
    refuse("--plot", options.plot.has_value(), "needs the whole program first, not --stream");
    refuse("--report", options.report.has_value(), "needs the whole program first, not --stream");
  }
  refuse("--report-window", options.report_window && !options.report, "there is no --report");
  refuse("--report", options.report && !report::page_is_built(), report::kHowToBuildPage);
  refuse("--parameters", options.parameters == "-", "needs a file: it is read, too");
  if (!options.check) return;
  constexpr const char* kWhy = "nothing runs with --check";
  refuse("--steps", options.steps.has_value(), kWhy);
  refuse("--path-steps", options.path_steps.has_value(), kWhy);
  refuse("--outputs", options.outputs.has_value(), kWhy);
  refuse("--plot", options.plot.has_value(), kWhy);
  refuse("--report", options.report.has_value(), kWhy);
  refuse("--trace", options.engine.trace.has_value(), kWhy);
  refuse("--stream", options.stream, kWhy);
}

void refuse_rapids_at_zero(const RunArguments& options, const Operation& operation, const run::Plan& plan) {
  if (operation.rapid_percent != 0) return;
  if (options.stream) throw UsageError("--rapid-override: 0 needs the whole program first, not --stream");
  if (plan.rapids == 0) return;
  throw UsageError(fmt::format("--rapid-override: 0, and a program with {} rapids would never end", plan.rapids));
}

// A list of steps, a picture and a time of the operator's need the pins and the clocks of a simulated card.
void refuse_what_needs_the_simulation(const RunArguments& options) {
  const CardChoice& card = options.card;
  options.engine.refuse_with(card);
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

// Throws where a warning is lost: most come before anything moves, and then nothing does.
void warn(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) tell("warning", text);
  finish_standard_streams();
}

// What is the same on every card; the files are still missing.
RunOptions run_options(const RunArguments& options, const machine::Machine& machine) {
  RunOptions run;
  run.plot = options.plot.has_value();
  run.progress = options.progress;
  run.stream = options.stream;
  run.settings = options.motion.settings();
  if (options.parameters) run.settings.reader.parameters = load_parameters(*options.parameters);
  run.most_percent = 100 * machine.motion.max_override;
  run.operation = options.motion.operation(run.most_percent);
  return run;
}

std::optional<std::uint64_t> copy_limit(const RunArguments& options) {
  if (options.stream) return std::nullopt;
  return options.pipe_limit.value_or(kDefaultPipeLimit) << 20U;
}

// From its beginning, each time. `file` must outlive them.
run::ProgramLines lines_of(const ProgramFile& file) {
  return [&file]() -> std::unique_ptr<gcode::LineSource> {
    return std::unique_ptr<gcode::LineSource>(new gcode::FileLines(file.lines()));
  };
}

// Refuses to write over what the run reads.
void keep_inputs(const RunArguments& options, Outputs& outputs) {
  outputs.keep("the program", options.program);
  if (const auto file = options.machine.source()) outputs.keep("the machine file", *file);
  outputs.check();
}

void run_on_card(const RunArguments& options, const transport::CardUrl& url) {
  refuse_what_needs_the_simulation(options);
  Outputs outputs;
  Output* const json = outputs.add("--json", options.json);
  Output* const parameters = outputs.add("--parameters", options.parameters);
  keep_inputs(options, outputs);
  const machine::Machine machine = options.machine.load();
  warn(jerk_warnings(machine));
  RunOptions run = run_options(options, machine);
  run.planned = [&](const run::Plan& plan) {
    refuse_rapids_at_zero(options, run.operation, plan);
    outputs.open();
    warn(feed_warnings(plan.file, plan.feeds_not_reached));
  };
  const ProgramFile file(options.program, copy_limit(options));
  CardRunResult result;
  with_card(url, Purpose::kMove, [&](driver::Card& card, transport::Connection& connection) {
    result = run_on_card(lines_of(file), machine, card, connection, run);
  });
  result.card = url.text;
  if (parameters != nullptr) parameters->write(parameters_text(result.outcome.parameters));
  if (json != nullptr) json->write(json_text(result));
  outputs.commit(summary(result) + options.machine.line());
}

void check(const run::ProgramLines& lines, const MachineChoice& choice, const machine::Machine& machine,
           const planner::CardLimits& card, const run::RunSettings& settings, Outputs& outputs, Output* json) {
  const CheckResult result = check_program(lines, machine, card, settings);
  warn(feed_warnings(result.plan.file, result.plan.feeds_not_reached));
  outputs.open();
  if (json != nullptr) json->write(json_text(result));
  outputs.commit(summary(result) + choice.line());
}

void run_in_simulation(const RunArguments& options) {
  refuse_contradictions(options);
  if (const auto url = options.card.url()) return run_on_card(options, *url);
  Outputs outputs;
  Output* const json = outputs.add("--json", options.json);
  Output* const plot = outputs.add("--plot", options.plot);
  Output* const report_file = outputs.add("--report", options.report);
  Output* const trace = outputs.add("--trace", options.engine.trace, true);
  Output* const steps = outputs.add("--steps", options.steps);
  Output* const path_steps = outputs.add("--path-steps", options.path_steps);
  Output* const changes = outputs.add("--outputs", options.outputs);
  Output* const parameters =
      outputs.add("--parameters", options.check ? std::optional<std::string>() : options.parameters);
  keep_inputs(options, outputs);

  const machine::Machine machine = options.machine.load();
  warn(jerk_warnings(machine));
  RunOptions run = run_options(options, machine);
  run.report = report_file;
  run.steps = steps;
  run.path_steps = path_steps;
  run.outputs = changes;
  const auto axes = static_cast<unsigned>(machine.motors());
  sim::SimulationOptions engine =
      options.engine.options(trace != nullptr ? traced_axes(axes) : axes, kSimulatedClock, machine.clock_hz);
  if (options.report_window) {
    run.report_window = window_of("--report-window", *options.report_window, engine.clock_hz);
  }
  const ProgramFile file(options.program, copy_limit(options));
  const run::ProgramLines lines = lines_of(file);
  if (options.check) return check(lines, options.machine, machine, limits_of(engine), run.settings, outputs, json);
  run.planned = [&](const run::Plan& plan) {
    refuse_rapids_at_zero(options, run.operation, plan);
    outputs.open();
    if (trace != nullptr) engine.trace->path = trace->path_to_write();
    warn(feed_warnings(plan.file, plan.feeds_not_reached));
    if (const auto text = long_run_note(engine, plan.seconds)) tell("note", *text);
    if (engine.axes != axes)
      tell("note", fmt::format("traced on a card of {} axes: others are not built for it", engine.axes));
  };
  std::unique_ptr<report::ReportWriter> report;
  const RunResult result = run_program(lines, machine, engine, run, &report);
  if (options.stream) warn(feed_warnings(result.program, result.feeds_not_reached));
  if (trace != nullptr) require_whole_waveform(trace->path_to_write(), *options.engine.trace);
  if (json != nullptr) json->write(json_text(result));
  if (parameters != nullptr) parameters->write(parameters_text(result.parameters));
  if (plot != nullptr) plot->write(run::svg(result.plot));
  if (report) report->finish(report_json(result));
  outputs.commit(summary(result) + options.machine.line());
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<RunArguments>();
  CLI::App* command =
      app.add_subcommand("run", "run a G-code program on the simulated card, or on one outside (--card)");
  command->add_option("program", options->program, "G-code file ('-': standard input)")->required()->type_name("FILE");
  options->machine.add_to(*command);
  options->card.add_to(*command);
  options->engine.add_to(*command, "1000000 with engine rtl, the machine file's with model");
  options->motion.add_to(*command);
  command->add_option("--json", options->json, "summary as JSON")->type_name("FILE");
  command->add_option("--steps", options->steps, "every leading edge at a STEP pin: cycle,axis,direction")
      ->type_name("FILE");
  command->add_option("--path-steps", options->path_steps, "every step of the path: command,tick,axis,direction")
      ->type_name("FILE");
  command->add_option("--outputs", options->outputs, "every change of an output: cycle,output,level")
      ->type_name("FILE");
  command
      ->add_option("--parameters", options->parameters,
                   "parameters, offsets, homes and tool: read before the run, written behind it")
      ->type_name("FILE");
  command->add_option("--plot", options->plot, "picture of path and speed as SVG")->type_name("FILE");
  command->add_option("--report", options->report, "page of the run: path, speeds, pins, program; opens in a browser")
      ->type_name("FILE");
  command
      ->add_option("--report-window", options->report_window,
                   "only this stretch's pulses in the page, seconds of card time")
      ->type_name("FROM:TO");
  command->add_flag("--progress", options->progress, "say how far the run is, also where stderr is no terminal");
  command->add_flag("--check", options->check, "read, plan and time the program; nothing runs");
  command->add_flag("--stream", options->stream,
                    "read the program while it runs: an error in it is a stop on the way, status 1");
  command
      ->add_option("--pipe-limit", options->pipe_limit,
                   fmt::format("longest program that is read from standard input, a pipe or a device, which is copied "
                               "first (default {})",
                               kDefaultPipeLimit))
      ->transform(whole_number(1, 1'000'000, "MiB"))
      ->type_name("MIB");
  command->footer("One FILE may be '-', standard output; what people read then goes to standard error.");
  command->callback([options] { run_in_simulation(*options); });
}

}  // namespace trammel::app
