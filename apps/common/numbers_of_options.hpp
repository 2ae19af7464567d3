// Parses numbers in the text of options. They must be finite and within their bounds, with no text after them;
// otherwise a UsageError names the option.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace trammel::app {

// The number if the whole text is one, without a unit; otherwise none.
std::optional<double> number(std::string_view text);

// 0 to 10^9 seconds of card time. `what`: for the message.
double seconds_of(const std::string& option, std::string_view text, const char* what);

// The parts before and after the first colon. `form`: for the message if there is none.
std::pair<std::string_view, std::string_view> halves(const std::string& option, std::string_view text,
                                                     const char* form);

}  // namespace trammel::app
