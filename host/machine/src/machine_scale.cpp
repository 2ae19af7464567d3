#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <sstream>
#include <toml.hpp>

#include "text.hpp"
#include "trammel/machine/scale.hpp"

namespace trammel::machine {
namespace {

// Position of the number in the text.
struct NumberPlace {
  std::size_t begin = 0;
  std::size_t length = 0;
  std::size_t line = 0;
};

// The text must be valid for parse_machine(). toml11 gives line, column and length, all in bytes.
NumberPlace place_of_scale(const std::string& text, const std::string& name, char letter) {
  std::istringstream stream(text);
  const toml::value document = toml::parse(stream, name);
  const std::string axis(1, static_cast<char>(std::tolower(static_cast<unsigned char>(letter))));
  const toml::source_location at = toml::find(document, "axis", axis, "steps_per_mm").location();
  std::size_t begin = 0;
  for (std::size_t line = 1; line < at.line(); ++line) begin = text.find('\n', begin) + 1;
  return {begin + at.column() - 1, at.region(), at.line()};
}

std::string whole_line(const std::string& text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  std::string line = text.substr(begin, text.find('\n', at) - begin);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

}  // namespace

std::string calibrated_scale(double steps_per_mm, double commanded, double measured) {
  return fmt::format("{:.7g}", steps_per_mm * commanded / measured);
}

std::string read_machine_text(const std::string& path) {
  if (path.empty()) refuse("the machine file has no name");
  return text_of_file(path);
}

ChangedText with_steps_per_mm(const std::string& text, const std::string& name, char letter,
                              const std::string& number) {
  const Machine before = parse_machine(text, name);
  if (!before.axis(letter)) refuse(fmt::format("{}: the machine has no axis {}", name, letter));
  const NumberPlace place = place_of_scale(text, name, letter);
  ChangedText changed{text, place.line, {}};
  changed.text.replace(place.begin, place.length, number);
  changed.line_is_now = whole_line(changed.text, place.begin);
  const Machine after = parse_machine(changed.text, name);
  if (after.axes[*after.axis(letter)].steps_per_mm != std::strtod(number.c_str(), nullptr)) {
    refuse(fmt::format("{}:{}: steps_per_mm of axis {} is not where it was looked for", name, place.line, letter));
  }
  return changed;
}

}  // namespace trammel::machine
