// The command's options as plain data, for what is made from them.
#pragma once

#include <string>
#include <vector>

#include "common/command_line.hpp"

namespace trammel::app {

struct OptionOutline {
  std::vector<std::string> names;  // "--engine", "-h"; of a positional its name alone
  bool positional = false;
  bool takes_value = false;
  bool repeatable = false;
  std::string value;                 // what stands for it in a help text, as FILE
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
