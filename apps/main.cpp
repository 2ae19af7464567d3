// The trammel command: subcommands, and what the shell sees when one fails.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>

#include "card_commands.hpp"
#include "command_names.hpp"
#include "compare_command.hpp"
#include "errors.hpp"
#include "info_command.hpp"
#include "line_command.hpp"
#include "methods_command.hpp"
#include "outputs.hpp"
#include "reproduce_command.hpp"
#include "run_command.hpp"
#include "serve_command.hpp"
#include "shell_command.hpp"
#include "steps_command.hpp"
#include "stop_at_signals.hpp"
#include "temporary_files.hpp"
#include "terminal.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/runner.hpp"

namespace {

int report(const std::string& message, int status) {
  trammel::app::tell("error", message);
  return status;
}

// Where the shell closed one of the first three descriptors, an output file would get its number, and with it what is
// printed. One that can only be read makes printing fail.
void hold_standard_descriptors() {
  for (int descriptor = 0; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) == -1) (void)::open("/dev/null", O_RDONLY);
  }
}

void run(CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  words = trammel::app::subcommand_words(app, std::move(words));
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the end
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    // Help and version count as errors too, of status 0.
    if (error.get_exit_code() != 0) throw trammel::app::UsageError(fmt::format("{} (--help tells more)", error.what()));
    app.exit(error);
    std::cout.flush();
  }
  trammel::app::finish_standard_output();
}

}  // namespace

int main(int argc, char** argv) {
  hold_standard_descriptors();
  trammel::app::remove_temporary_files_on_signals();
  CLI::App app("Trammel: an open stepper-motion card, its golden model and its driver", "trammel");
  app.set_version_flag("--version", TRAMMEL_VERSION);
  app.require_subcommand(1);
  app.footer("trammel help COMMAND tells the options of a command.");
  trammel::app::add_run_command(app);
  trammel::app::add_line_command(app);
  trammel::app::add_info_command(app);
  trammel::app::add_card_commands(app);
  trammel::app::add_serve_command(app);
  trammel::app::add_steps_command(app);
  trammel::app::add_methods_command(app);
  trammel::app::add_reproduce_command(app);
  trammel::app::add_compare_command(app);
  trammel::app::add_shell_commands(app);
  try {
    run(app, argc, argv);
  } catch (const trammel::app::UsageError& error) {
    return report(error.what(), trammel::app::kExitUsage);
  } catch (const trammel::run::ProgramError& error) {
    return report(error.what(), trammel::app::kExitUsage);
  } catch (const trammel::machine::MachineError& error) {
    return report(error.what(), trammel::app::kExitUsage);
  } catch (const trammel::app::EndedBySignal& ended) {
    trammel::app::tell("note", ended.what());
    ended.end_process();
  } catch (const std::exception& error) {
    return report(error.what(), trammel::app::kExitFailure);
  }
  return 0;
}
