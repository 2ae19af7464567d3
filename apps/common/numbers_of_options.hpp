// Numbers in the text of options: finite, in full, and in their bounds, or a UsageError that names the option.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace trammel::app {

// The whole text is a number, without a unit.
std::optional<double> number(std::string_view text);

// 0 to 10^9 seconds of card time. `what`: for the message.
double seconds_of(const std::string& option, std::string_view text, const char* what);

// Before and behind the first colon. `form`: for the message where there is none.
std::pair<std::string_view, std::string_view> halves(const std::string& option, std::string_view text,
                                                     const char* form);

}  // namespace trammel::app
