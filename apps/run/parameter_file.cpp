#include "parameter_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "common/errors.hpp"
#include "trammel/gcode/line_source.hpp"

namespace trammel::app {
namespace {

constexpr int kLargestNumber = 5602;
constexpr double kLargestValue = 1e12;

// Returns the next word of a line and removes it from the line.
std::string_view word_of(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

template <class Number>
bool read(std::string_view word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc{} && end == word.data() + word.size();
}

}  // namespace

std::map<int, double> load_parameters(const std::string& file) {
  std::map<int, double> parameters;
  std::error_code code;
  if (!std::filesystem::exists(file, code)) return parameters;
  gcode::FileLines lines(file);
  std::size_t number = 0;
  for (std::string_view rest; lines.next(rest);) {
    ++number;
    const std::string_view first = word_of(rest);
    if (first.empty()) continue;
    const std::string_view second = word_of(rest);
    int parameter = 0;
    double value = 0;
    const bool good = read(first, parameter) && parameter >= 1 && parameter <= kLargestNumber && read(second, value) &&
                      std::abs(value) <= kLargestValue && word_of(rest).empty();
    if (!good) {
      throw UsageError(fmt::format("{}:{}: must be the number of a parameter (1 to {}) and its value", file, number,
                                   kLargestNumber));
    }
    parameters[parameter] = value;
  }
  if (const auto failure = lines.failure()) {
    throw UsageError(fmt::format("{}: cannot read the parameters: {}", file, *failure));
  }
  return parameters;
}

std::string parameters_text(const std::map<int, double>& parameters) {
  std::string text;
  for (const auto& [number, value] : parameters) text += fmt::format("{}\t{}\n", number, value);
  return text;
}

}  // namespace trammel::app
