// Selects the machine: the file of --machine, else the user's machine file, else the built-in machine; changed by
// --set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::app {

class Outputs;

struct MachineChoice {
  std::optional<std::string> file;     // of --machine
  std::vector<std::string> overrides;  // of --set

  void add_to(CLI::App& command);
  // Adds only --machine.
  void add_file_to(CLI::App& command);

  // The file to read; none for the built-in machine.
  std::optional<std::string> source() const;
  // Throws machine::MachineError.
  machine::Machine load() const;
  // Hash of the file's text and of --set, 16 digits.
  std::string hash() const;
  // The source of the machine, for the summary.
  std::string line() const;
};

// machine.toml in the folder trammel of $XDG_CONFIG_HOME, by default ~/.config; none if there is no such file.
std::optional<std::string> user_machine_file();

}  // namespace trammel::app
