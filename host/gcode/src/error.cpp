#include "trammel/gcode/error.hpp"

#include <fmt/format.h>

#include "trammel/machine/one_line.hpp"

namespace trammel::gcode {

std::string describe(const Error& error) {
  return fmt::format("{}:{}: {}", machine::one_line(error.file, machine::kLongestName), error.line, error.message);
}

std::string quote(std::string_view text) { return machine::one_line(text, kLongestQuote); }

}  // namespace trammel::gcode
