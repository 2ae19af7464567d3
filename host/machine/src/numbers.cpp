#include "numbers.hpp"

#include <fmt/format.h>

#include <cmath>

#include "text.hpp"

namespace trammel::machine {

std::string Source::at_line(std::size_t line) const {
  return has_lines ? fmt::format("{}:{}: ", name, line) : name + ": ";
}

double number(const Source& source, const std::string& path, const toml::value& value) {
  double result = 0;
  if (value.is_integer()) {
    result = static_cast<double>(value.as_integer());
  } else if (value.is_floating()) {
    result = value.as_floating();
  } else {
    refuse(source.at(value) + path + " must be a number");
  }
  if (!std::isfinite(result)) {
    refuse(source.at(value) + path + " must be a finite number");
  }
  return result;
}

double number(const Source& source, const std::string& path, const toml::value& value, const Range& range) {
  const double result = number(source, path, value);
  if (result < range.least || result > range.most) {
    refuse(fmt::format("{}{} must be from {:g} to {:g} {}, not {:g} ({})", source.at(value), path, range.least,
                       range.most, range.unit, result, range.reason));
  }
  return result;
}

}  // namespace trammel::machine
