// Files that a subcommand writes. Not thread-safe.
#pragma once

#include <cstdio>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "trammel/run/text_sink.hpp"

namespace trammel::app {

// Throws UsageError for the first file that cannot be written, so that it is found before the work, not after it.
// Nothing is created or opened. "-" is standard output.
void require_writable(std::initializer_list<std::optional<std::string>> files);

// Writes the JSON, indented; "-" is standard output. Throws std::runtime_error when it cannot be written to its end.
void write_json_file(const nlohmann::ordered_json& json, const std::string& file);

// A file, or standard output for "-".
class FileSink final : public run::TextSink {
 public:
  // Throws std::runtime_error when the file cannot be opened.
  explicit FileSink(const std::string& file);
  ~FileSink() override;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  // Both throw std::runtime_error when the file does not take all of it.
  void write(std::string_view text) override;
  void close();

 private:
  std::string file_;
  std::FILE* out_;
};

// Writes a whole file; throws std::runtime_error when it cannot be written to its end.
void write_text_file(std::string_view text, const std::string& file);

}  // namespace trammel::app
