#include "run_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine_options.hpp"
#include "errors.hpp"
#include "outputs.hpp"
#include "program_run.hpp"
#include "run_report.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::app {
namespace {

// A simulated card at 1 MHz runs programs faster than life; only the resolution in time differs from the real clock.
constexpr std::uint32_t kSimulatedClock = 1'000'000;

struct Options {
  std::string program;
  std::optional<std::string> machine;
  std::vector<std::string> overrides;
  EngineChoice engine;
  RunOutputs outputs;
};

void check_program_file(const std::string& file) {
  if (std::filesystem::is_directory(file)) {
    throw UsageError(fmt::format("{}: is a directory, not a program", file));
  }
  // Looked at, not opened: a pipe can be opened once only.
  if (::access(file.c_str(), R_OK) != 0) throw UsageError(fmt::format("{}: cannot read the program", file));
}

void execute(const Options& options) {
  machine::Machine machine = options.machine ? machine::load_machine(*options.machine) : machine::default_machine();
  for (const std::string& text : options.overrides) machine::apply_override(machine, text);
  check_program_file(options.program);
  const gcode::Program program = gcode::read_program_file(options.program, machine);
  const sim::SimulationOptions engine =
      options.engine.options(card_axes(machine.axes.size()), kSimulatedClock, machine.clock_hz);
  const RunOutputs& files = options.outputs;
  require_writable({files.json, files.plot, files.steps, files.path_steps, options.engine.trace});
  const RunResult result = run_program(program, machine, engine, options.outputs);
  if (options.outputs.json) write_json(result, *options.outputs.json);
  if (options.outputs.plot) write_text_file(run::svg(result.plot), *options.outputs.plot);
  if (options.outputs.json != "-" && options.outputs.steps != "-" && options.outputs.path_steps != "-") {
    fmt::print("{}", summary(result));
  }
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("run", "run a G-code program on the simulated card");
  command->add_option("program", options->program, "G-code file")->required()->type_name("FILE");
  command->add_option("--machine", options->machine, "machine file (default: X Y Z E at 80 steps/mm)")
      ->type_name("TOML");
  command->add_option("--set", options->overrides, "override an entry of the machine file (repeatable)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  options->engine.add_to(*command);
  command->add_option("--json", options->outputs.json, "summary as JSON ('-': standard output)")->type_name("FILE");
  command->add_option("--steps", options->outputs.steps, "every leading edge at a STEP pin: cycle,axis,direction")
      ->type_name("FILE");
  command
      ->add_option("--path-steps", options->outputs.path_steps, "every step of the path: command,tick,axis,direction")
      ->type_name("FILE");
  command->add_option("--plot", options->outputs.plot, "picture of path and speed as SVG")->type_name("FILE");
  command->add_flag("--progress", options->outputs.progress, "show the progress bar even if stderr is no terminal");
  command->callback([options] { execute(*options); });
}

}  // namespace trammel::app
