// `trammel completion SHELL` and `trammel man`: shell completions and the manual page, generated from the command's
// options.
#pragma once

#include <string>

#include "common/command_line.hpp"

namespace trammel::app {

// Must be added after all other commands, because it describes only those already added.
void add_shell_commands(CLI::App& app);

// A script for the shell ("bash", "zsh" or "fish") that completes subcommands, options, choices and file names.
std::string completion_of(const CLI::App& app, const std::string& shell);

// The manual page, in the man macros of roff.
std::string manual_of(const CLI::App& app);

}  // namespace trammel::app
