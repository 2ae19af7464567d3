// Clock frequencies of the tests' cards, Hz.
#pragma once

#include <cstdint>

namespace trammel::run {

constexpr std::uint32_t kClock = 1'000'000;
constexpr std::uint32_t kSlowClock = 400'000;

}  // namespace trammel::run
