#include "terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "standard_streams.hpp"
#include "trammel/machine/one_line.hpp"

namespace trammel::app {
namespace {

// A message may contain untrusted file names, and an option for each word of a program.
constexpr std::size_t kLongestMessage = 2000;

// SGR number of the colour in ECMA-48; the text is also bold.
int number_of(Colour colour) {
  switch (colour) {
    case Colour::kRed:
      return 31;
    case Colour::kGreen:
      return 32;
    case Colour::kYellow:
      return 33;
    case Colour::kCyan:
      return 36;
  }
  return 39;
}

}  // namespace

bool has_escapes(int descriptor) {
  const char* const kind = std::getenv("TERM");
  return isatty(descriptor) != 0 && kind != nullptr && std::string_view(kind) != "dumb";
}

std::string coloured(int descriptor, Colour colour, const std::string& text) {
  const char* const without = std::getenv("NO_COLOR");
  if (!has_escapes(descriptor) || (without != nullptr && *without != '\0')) return text;
  return fmt::format("\033[1;{}m{}\033[0m", number_of(colour), text);
}

void tell(const std::string& kind, const std::string& text) {
  const Colour colour = kind == "error" ? Colour::kRed : kind == "warning" ? Colour::kYellow : Colour::kCyan;
  to_standard_error(fmt::format("trammel: {}: {}\n", coloured(STDERR_FILENO, colour, kind),
                                machine::one_line(text, kLongestMessage)));
}

}  // namespace trammel::app
