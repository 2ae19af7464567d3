// Why words that programs are known to have are not understood. Internal to the reader.
#pragma once

#include <string_view>

namespace trammel::gcode {

// `tenths` as code_of() gives it. Empty where there is nothing to say.
std::string_view why_unsupported(char letter, int tenths);

}  // namespace trammel::gcode
