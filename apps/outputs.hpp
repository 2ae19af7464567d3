// Files that a subcommand writes. Not thread-safe.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace trammel::app {

// Throws UsageError for the first file that cannot be written, so that it is found before the work, not after it.
// Nothing is created or opened. "-" is standard output.
void require_writable(std::initializer_list<std::optional<std::string>> files);

// Writes the JSON, indented; "-" is standard output. Throws std::runtime_error when it cannot be written to its end.
void write_json_file(const nlohmann::ordered_json& json, const std::string& file);

}  // namespace trammel::app
