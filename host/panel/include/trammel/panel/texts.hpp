// Grbl's error and alarm numbers in words.
#pragma once

#include <string>

namespace trammel::panel {

// The text for "error:N".
std::string error_text(int number);
// The text for "ALARM:N"; 0: the machine has not been homed since it was switched on.
std::string alarm_text(int number);

}  // namespace trammel::panel
