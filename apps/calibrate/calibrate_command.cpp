#include "calibrate_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "calibration.hpp"
#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/outputs.hpp"
#include "common/standard_streams.hpp"
#include "common/terminal.hpp"
#include "trammel/machine/scale.hpp"

namespace trammel::app {
namespace {

struct CalibrateArguments {
  Measured measured;
  MachineChoice machine;
  bool write = false;
};

constexpr const char* kPlaceIsVoid =
    "the new scale makes the position that a card keeps invalid, for all axes. Run `trammel zero` with all axes where "
    "they stand, then home again";

// The file to change. A pipe has already been read and cannot be changed.
std::string file_to_write(const std::optional<std::string>& source) {
  if (!source)
    throw UsageError(
        "calibrate: --write: the built-in machine is not a file. Name your machine file with --machine FILE");
  std::error_code error;
  if (!std::filesystem::is_regular_file(*source, error))
    throw UsageError(fmt::format("calibrate: --write: {} is not a regular file", *source));
  return *source;
}

void calibrate_file(const CalibrateArguments& arguments) {
  const std::optional<std::string> source = arguments.machine.source();
  Outputs outputs;
  Output* file = arguments.write ? outputs.add("--write", file_to_write(source)) : nullptr;
  const std::string text = source ? machine::read_machine_text(*source) : machine::default_machine_text();
  const Calibration calibration = calibrate(arguments.measured, text, source.value_or("built-in"));
  if (!calibration.changed) return to_standard_output(calibration.said);
  if (file == nullptr) {
    to_standard_output(calibration.said);
    tell("note", source ? "nothing was written. Give --write to change the machine file"
                        : "nothing was written: the built-in machine is not a file. Copy examples/machine.toml and "
                          "name the copy with --machine");
  } else {
    outputs.open();
    file->write(calibration.text);
    outputs.commit(calibration.said + fmt::format("written to {}\n", *source));
  }
  if (!calibration.doubt.empty()) tell("note", calibration.doubt);
  tell("note", kPlaceIsVoid);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command =
      app.add_subcommand("calibrate", "calculate steps_per_mm of an axis from a commanded and a measured distance");
  command->add_option("axis", arguments->measured.axis, "letter of the axis")->required()->type_name("AXIS");
  command
      ->add_option("commanded", arguments->measured.commanded,
                   "distance that the axis was commanded to move, mm (degrees)")
      ->required()
      ->type_name("COMMANDED");
  command->add_option("measured", arguments->measured.actual, "distance that the axis moved, as measured, mm (degrees)")
      ->required()
      ->type_name("MEASURED");
  arguments->machine.add_file_to(*command);
  command->add_flag("--write", arguments->write,
                    "write the new number to the machine file, and change nothing else there (default: only show it)");
  command->add_flag("--force", arguments->measured.force,
                    "accept a measured distance of less than half or more than twice the commanded one");
  command->callback([arguments] { calibrate_file(*arguments); });
}

}  // namespace trammel::app
