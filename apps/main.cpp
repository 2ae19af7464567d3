// The trammel command: subcommands, and what the shell sees when one fails.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "compare_command.hpp"
#include "errors.hpp"
#include "info_command.hpp"
#include "line_command.hpp"
#include "methods_command.hpp"
#include "reproduce_command.hpp"
#include "run_command.hpp"
#include "steps_command.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"

namespace {

int report(const char* message, int status) {
  fmt::print(stderr, "trammel: error: {}\n", message);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Trammel: an open stepper-motion card, its golden model and its driver", "trammel");
  app.set_version_flag("--version", TRAMMEL_VERSION);
  app.require_subcommand(1);
  trammel::app::add_run_command(app);
  trammel::app::add_line_command(app);
  trammel::app::add_info_command(app);
  trammel::app::add_steps_command(app);
  trammel::app::add_methods_command(app);
  trammel::app::add_reproduce_command(app);
  trammel::app::add_compare_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help and version count as errors too, of status 0; a real one gets its one line here.
    if (error.get_exit_code() == 0) return app.exit(error);
    return report(fmt::format("{} (--help tells more)", error.what()).c_str(), trammel::app::kExitUsage);
  } catch (const trammel::app::UsageError& error) {
    return report(error.what(), trammel::app::kExitUsage);
  } catch (const trammel::gcode::ProgramError& error) {
    return report(error.what(), trammel::app::kExitUsage);
  } catch (const trammel::machine::MachineError& error) {
    return report(error.what(), trammel::app::kExitUsage);
  } catch (const std::exception& error) {
    return report(error.what(), trammel::app::kExitFailure);
  }
  return 0;
}
