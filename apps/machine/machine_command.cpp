#include "machine_command.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/standard_streams.hpp"

namespace trammel::app {
namespace {

struct MachineArguments {
  MachineChoice machine;
  bool check = false;
};

void check(const MachineArguments& options) {
  if (!options.check) throw UsageError("machine: needs --check");
  to_standard_output(stop_text(options.machine.load()));
}

}  // namespace

void add_machine_command(CLI::App& app) {
  auto options = std::make_shared<MachineArguments>();
  CLI::App* command = app.add_subcommand("machine", "calculate stopping distances from the machine file (--check)");
  command->add_flag("--check", options->check,
                    "show how far each axis moves while it stops, and whether that fits into the overtravel behind its "
                    "limit switches (required)");
  options->machine.add_to(*command);
  command->callback([options] { check(*options); });
}

}  // namespace trammel::app
