// Exact integer arithmetic beyond 64 bits. Pure.
#pragma once

#include <cstdint>

namespace trammel::driver::wide {

__extension__ typedef unsigned __int128 uint128;

// ceil(a / b); b is not 0.
constexpr uint128 ceil_div(uint128 a, uint128 b) { return a / b + (a % b != 0 ? 1 : 0); }

// a * b in full, as two halves.
struct Product {
  uint128 high;
  uint128 low;
};

constexpr Product multiply(uint128 a, uint128 b) {
  constexpr uint128 kMask = ~std::uint64_t{0};
  const uint128 low_low = (a & kMask) * (b & kMask);
  const uint128 low_high = (a & kMask) * (b >> 64);
  const uint128 high_low = (a >> 64) * (b & kMask);
  const uint128 middle = (low_low >> 64) + (low_high & kMask) + (high_low & kMask);
  return {(a >> 64) * (b >> 64) + (low_high >> 64) + (high_low >> 64) + (middle >> 64),
          (middle << 64) | (low_low & kMask)};
}

constexpr bool less(const Product& a, const Product& b) { return a.high != b.high ? a.high < b.high : a.low < b.low; }

// The smallest R with R^2 >= square * factor^2. Bound: square < 2^128 and factor < 2^64, so R <= 2^128 - 1 would need
// the root of square below 2^64; it is, so R <= 2^128.
constexpr uint128 ceil_root(uint128 square, std::uint64_t factor) {
  const Product target = multiply(square, uint128{factor} * factor);
  uint128 below = 0;  // below^2 < target, once anything is set
  for (int bit = 127; bit >= 0; --bit) {
    const uint128 candidate = below | (uint128{1} << bit);
    if (less(multiply(candidate, candidate), target)) {
      below = candidate;
    }
  }
  return target.high == 0 && target.low == 0 ? 0 : below + 1;
}

}  // namespace trammel::driver::wide
