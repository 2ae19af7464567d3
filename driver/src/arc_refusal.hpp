// Internal to the driver.
#pragma once

#include <stdexcept>
#include <string>

namespace trammel::driver {

[[noreturn]] inline void refuse_arc(const std::string& why) { throw std::invalid_argument("arc: " + why); }

}  // namespace trammel::driver
