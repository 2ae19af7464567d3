#include "trammel_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>

#include "calibrate/calibrate_command.hpp"
#include "card/card_commands.hpp"
#include "command_names.hpp"
#include "common/errors.hpp"
#include "common/standard_streams.hpp"
#include "common/stop_at_signals.hpp"
#include "common/temporary_files.hpp"
#include "common/terminal.hpp"
#include "compare/compare_command.hpp"
#include "grbl/grbl_command.hpp"
#include "home/home_command.hpp"
#include "info/info_command.hpp"
#include "jog/jog_command.hpp"
#include "line/line_command.hpp"
#ifdef __linux__
#include "linuxcnc/linuxcnc_command.hpp"
#endif
#include "machine/machine_command.hpp"
#include "methods/methods_command.hpp"
#include "panel/panel_command.hpp"
#include "place/place_commands.hpp"
#include "reproduce/reproduce_command.hpp"
#include "run/run_command.hpp"
#include "serve/serve_command.hpp"
#include "shell/shell_command.hpp"
#include "steps/steps_command.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/runner.hpp"
#include "world/world_command.hpp"

namespace trammel::app {
namespace {

int report(const std::string& message, int status) {
  tell("error", message);
  return status;
}

void parse(CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  words = subcommand_words(app, std::move(words));
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes the words from the end
  } catch (const CLI::ExtrasError& error) {
    throw UsageError(fmt::format("{} (--help tells more)", unknown_option_text(app, words).value_or(error.what())));
  } catch (const CLI::ParseError& error) {
    // CLI11 throws help and version as errors with status 0.
    if (error.get_exit_code() != 0) throw UsageError(fmt::format("{} (--help tells more)", error.what()));
    app.exit(error);
    std::cout.flush();
  }
  finish_standard_streams();
}

}  // namespace

int run_command_line(int argc, char** argv, const char* version) {
  hold_standard_descriptors();
  remove_temporary_files_on_signals();
  CLI::App app("Trammel: an open stepper-motion card, its golden model and its driver", "trammel");
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.footer("trammel help COMMAND lists the options of a command.");
  add_run_command(app);
  add_line_command(app);
  add_jog_command(app);
  add_home_command(app);
  add_info_command(app);
  add_card_commands(app);
  add_place_commands(app);
  add_machine_command(app);
  add_calibrate_command(app);
  add_serve_command(app);
  add_grbl_command(app);
#ifdef __linux__
  add_linuxcnc_command(app);
#endif
  add_panel_command(app);
  add_world_command(app);
  add_steps_command(app);
  add_methods_command(app);
  add_reproduce_command(app);
  add_compare_command(app);
  add_shell_commands(app);
  try {
    parse(app, argc, argv);
  } catch (const UsageError& error) {
    return report(error.what(), kExitUsage);
  } catch (const run::ProgramError& error) {
    return report(error.what(), kExitUsage);
  } catch (const machine::MachineError& error) {
    return report(error.what(), kExitUsage);
  } catch (const run::PlaceError& error) {
    return report(error.what(), kExitUsage);
  } catch (const EndedBySignal& ended) {
    tell("note", ended.what());
    ended.end_process();
  } catch (const std::exception& error) {
    return report(error.what(), kExitFailure);
  }
  return 0;
}

}  // namespace trammel::app
