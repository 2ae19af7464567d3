// The command's options as plain data, from which shell completions and the manual are made.
#pragma once

#include <string>
#include <vector>

#include "common/command_line.hpp"

namespace trammel::app {

struct OptionOutline {
  std::vector<std::string> names;  // "--engine", "-h"; for a positional only its name
  bool positional = false;
  bool takes_value = false;
  bool repeatable = false;
  std::string value;                 // what a help text calls the value, such as FILE
  std::vector<std::string> choices;  // empty: not a choice
  std::string default_value;
  std::string about;
};

struct CommandOutline {
  std::string name;
  std::string about;
  std::vector<OptionOutline> options;
};

// The subcommands, in the order in which they were added.
std::vector<CommandOutline> outline_of(const CLI::App& app);

}  // namespace trammel::app
