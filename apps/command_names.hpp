// The command line's first word, before the options are read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/command_line.hpp"

namespace trammel::app {

// `words` as the option reader wants them: "help" and "help X" become "--help" and "X --help".
// Throws UsageError for a subcommand that there is not; the message names the nearest one.
std::vector<std::string> subcommand_words(const CLI::App& app, std::vector<std::string> words);

// What is wrong with the first of `words` that looks like an option and is none of the subcommand that was parsed, with
// the nearest one's name. Nothing where there is no such word.
std::optional<std::string> unknown_option_text(const CLI::App& app, const std::vector<std::string>& words);

// How many letters must be put in, left out, changed or swapped with their neighbour to make one word of the other.
std::size_t edit_distance(const std::string& a, const std::string& b);

}  // namespace trammel::app
