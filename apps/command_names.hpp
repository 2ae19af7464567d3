// Checks the command line's words before the options are read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/command_line.hpp"

namespace trammel::app {

// Converts `words` for the option reader: "help" and "help X" become "--help" and "X --help". Throws UsageError for an
// unknown subcommand; the message names the nearest one.
std::vector<std::string> subcommand_words(const CLI::App& app, std::vector<std::string> words);

// The error message for the first of `words` that looks like an option and is not one of the parsed subcommand, with
// the nearest option's name. None if there is no such word.
std::optional<std::string> unknown_option_text(const CLI::App& app, const std::vector<std::string>& words);

// The number of letters to insert, delete, change or swap with their neighbour to turn one word into the other.
std::size_t edit_distance(const std::string& a, const std::string& b);

}  // namespace trammel::app
