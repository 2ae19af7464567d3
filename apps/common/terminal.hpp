// Output for people: coloured if the stream is a terminal with colour support, unless NO_COLOR disables colour.
#pragma once

#include <string>

namespace trammel::app {

enum class Colour { kRed, kGreen, kYellow, kCyan };

// Whether the descriptor is a terminal that understands escape sequences (TERM is set and not "dumb").
bool has_escapes(int descriptor);

// The text in a colour if the descriptor's stream supports it and NO_COLOR is empty (no-color.org); otherwise
// unchanged.
std::string coloured(int descriptor, Colour colour, const std::string& text);

// Prints "trammel: error: ..." as one line on standard error, for any content of the text; the kind ("error",
// "warning", "note") has its colour.
void tell(const std::string& kind, const std::string& text);

}  // namespace trammel::app
