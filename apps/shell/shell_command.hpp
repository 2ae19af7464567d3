// `trammel completion SHELL` and `trammel man`: what shells and manuals know of the command, made from its options.
#pragma once

#include <string>

#include "common/command_line.hpp"

namespace trammel::app {

// To be added after all others: it tells of those that are there.
void add_shell_commands(CLI::App& app);

// A script for the shell, "bash", "zsh" or "fish", that completes subcommands, options, choices and file names.
std::string completion_of(const CLI::App& app, const std::string& shell);

// The manual page, in the man macros of roff.
std::string manual_of(const CLI::App& app);

}  // namespace trammel::app
