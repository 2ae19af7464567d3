#pragma once

#include <cstdint>

namespace trammel::testing {

inline constexpr std::int64_t kOnePulse = std::int64_t{1} << 40;

}  // namespace trammel::testing
