#include "numbers_of_options.hpp"

#include <fmt/format.h>

#include <charconv>

#include "errors.hpp"

namespace trammel::app {
namespace {

constexpr double kLongest = 1e9;  // s, also the limit of --trace-window

}  // namespace

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

double seconds_of(const std::string& option, std::string_view text, const char* what) {
  const auto value = number(text);
  if (!value || !(*value >= 0) || *value > kLongest) {
    throw UsageError(
        fmt::format("{}: {} is not a {} from 0 to {:g} seconds of card time", option, text, what, kLongest));
  }
  return *value;
}

std::pair<std::string_view, std::string_view> halves(const std::string& option, std::string_view text,
                                                     const char* form) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) throw UsageError(fmt::format("{}: {} must be {}", option, text, form));
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace trammel::app
