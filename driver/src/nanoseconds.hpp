// Internal to the driver.
#pragma once

#include <cstdint>

namespace trammel::driver {

constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace trammel::driver
