// What is written for eyes: colour where the stream is a terminal that knows it, unless NO_COLOR asks for none.
#pragma once

#include <string>

namespace trammel::app {

enum class Colour { kRed, kGreen, kYellow, kCyan };

// Whether a terminal that understands escapes is behind the descriptor (TERM is set and not "dumb").
bool has_escapes(int descriptor);

// The text in a colour where the descriptor's stream takes it (no-color.org: a NO_COLOR that is not empty asks for
// none), else as it is.
std::string coloured(int descriptor, Colour colour, const std::string& text);

// "trammel: error: ...", one line on standard error, whatever is in the text; the kind ("error", "warning", "note") has
// its colour.
void tell(const std::string& kind, const std::string& text);

}  // namespace trammel::app
