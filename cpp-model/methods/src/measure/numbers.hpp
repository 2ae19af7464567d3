// Numeric helpers of several measures. Internal to them.
#pragma once

#include <cstdint>

namespace trammel::measure {

constexpr double kTurn = 6.283185307179586476925;

// Times are below 2^63; a conversion from unsigned would need a branch.
inline double as_double(std::uint64_t time) { return static_cast<double>(static_cast<std::int64_t>(time)); }

}  // namespace trammel::measure
