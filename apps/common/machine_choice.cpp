#include "machine_choice.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "resume_file.hpp"
#include "trammel/machine/one_line.hpp"

namespace trammel::app {
namespace {

constexpr const char* kBuiltIn = "built-in";

}  // namespace

std::optional<std::string> user_machine_file() {
  namespace fs = std::filesystem;
  // By the XDG Base Directory Specification a relative path is ignored.
  const char* const configuration = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  fs::path folder;
  if (configuration != nullptr && fs::path(configuration).is_absolute()) {
    folder = configuration;
  } else if (home != nullptr && fs::path(home).is_absolute()) {
    folder = fs::path(home) / ".config";
  } else {
    return std::nullopt;
  }
  const fs::path file = folder / "trammel" / "machine.toml";
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  return file.string();
}

void MachineChoice::add_file_to(CLI::App& command) {
  command
      .add_option("--machine", file,
                  "machine file. 'built-in' is a machine with X Y Z E at 80 steps/mm (default: trammel/machine.toml in "
                  "the user's configuration folder if it exists, else built-in)")
      ->type_name("TOML");
}

void MachineChoice::add_to(CLI::App& command) {
  add_file_to(command);
  command
      .add_option("--set", overrides,
                  "override an entry of the machine file, such as axis.x.steps_per_mm=200 (repeatable)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

std::optional<std::string> MachineChoice::source() const {
  if (!file) return user_machine_file();
  return *file == kBuiltIn ? std::nullopt : file;
}

machine::Machine MachineChoice::load() const {
  const std::optional<std::string> from = source();
  machine::Machine machine = from ? machine::load_machine(*from) : machine::default_machine();
  for (const std::string& text : overrides) machine::apply_override(machine, text);
  return machine;
}

std::string MachineChoice::hash() const {
  TextHash hash;
  if (const std::optional<std::string> from = source()) {
    std::ifstream in(*from);
    for (std::string line; std::getline(in, line);) hash.add(line);
  }
  for (const std::string& text : overrides) hash.add("--set " + text);
  return hash.text();
}

std::string MachineChoice::line() const {
  const std::optional<std::string> from = source();
  return fmt::format("  machine: {}{}\n", from ? machine::one_line(*from, machine::kLongestName) : "built-in",
                     overrides.empty() ? "" : fmt::format(", entries by --set: {}", overrides.size()));
}

}  // namespace trammel::app
