#include "outputs.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "errors.hpp"

namespace trammel::app {

namespace {

bool writable(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    return !std::filesystem::is_directory(file, ignored) && ::access(file.c_str(), W_OK) == 0;
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return std::filesystem::is_directory(folder, ignored) && ::access(folder.c_str(), W_OK) == 0;
}

}  // namespace

void require_writable(std::initializer_list<std::optional<std::string>> files) {
  for (const std::optional<std::string>& file : files) {
    if (file && *file != "-" && !writable(*file)) throw UsageError(fmt::format("{}: cannot be written", *file));
  }
}

FileSink::FileSink(const std::string& file) : file_(file), out_(file == "-" ? stdout : std::fopen(file.c_str(), "w")) {
  if (out_ == nullptr) throw std::runtime_error(fmt::format("{}: cannot be written", file));
}

FileSink::~FileSink() {
  if (out_ != nullptr && out_ != stdout) std::fclose(out_);
}

void FileSink::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), out_) != text.size()) {
    throw std::runtime_error(fmt::format("{}: could not be written to its end", file_));
  }
}

void FileSink::close() {
  if (std::fflush(out_) != 0) throw std::runtime_error(fmt::format("{}: could not be written to its end", file_));
}

void write_text_file(std::string_view text, const std::string& file) {
  FileSink sink(file);
  sink.write(text);
  sink.close();
}

void write_json_file(const nlohmann::ordered_json& json, const std::string& file) {
  const std::string text = json.dump(2) + "\n";
  if (file == "-") {
    std::cout << text;
    return;
  }
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: could not be written to its end", file));
}

}  // namespace trammel::app
