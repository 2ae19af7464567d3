#include "real.hpp"

#include <cmath>
#include <utility>

namespace trammel::planner {
namespace {

struct Wide {
  std::uint64_t high;
  std::uint64_t low;
};

Wide product(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t kMask = 0xFFFFFFFF;
  const std::uint64_t low_low = (a & kMask) * (b & kMask);
  const std::uint64_t low_high = (a & kMask) * (b >> 32);
  const std::uint64_t high_low = (a >> 32) * (b & kMask);
  const std::uint64_t middle = (low_low >> 32) + (low_high & kMask) + (high_low & kMask);
  return {(a >> 32) * (b >> 32) + (low_high >> 32) + (high_low >> 32) + (middle >> 32),
          (middle << 32) | (low_low & kMask)};
}

struct Quotient {
  std::uint64_t value;
  std::uint64_t rest;
};

// One digit of 32 bits: (rest * 2^32 + digit) / divisor, rest < divisor, the divisor's highest bit set. The estimate
// from its upper half is at most two too large.
Quotient divide_digit(std::uint64_t rest, std::uint32_t digit, std::uint64_t divisor) {
  const std::uint64_t upper = divisor >> 32;
  const std::uint64_t lower = divisor & 0xFFFFFFFF;
  std::uint64_t quotient = rest / upper;
  std::uint64_t left = rest % upper;
  while (quotient >> 32 != 0 || quotient * lower > (left << 32 | digit)) {
    --quotient;
    left += upper;
    if (left >> 32 != 0) break;
  }
  return {quotient, (rest << 32 | digit) - quotient * divisor};
}

// (high:low) / divisor, high < divisor, the divisor's highest bit set.
Quotient divide(Wide dividend, std::uint64_t divisor) {
  const Quotient first = divide_digit(dividend.high, static_cast<std::uint32_t>(dividend.low >> 32), divisor);
  const Quotient second = divide_digit(first.rest, static_cast<std::uint32_t>(dividend.low), divisor);
  return {first.value << 32 | second.value, second.rest};
}

// (mantissa:0) >> right, right >= 0. What falls out below shows as the lowest bit: enough to tell it from a tie.
Wide shifted_right(std::uint64_t mantissa, int right) {
  if (right == 0) return {mantissa, 0};
  if (right < 64) return {mantissa >> right, mantissa << (64 - right)};
  if (right >= 128) return {0, 1};
  const int more = right - 64;
  const bool lost = more != 0 && mantissa << (64 - more) != 0;
  return {0, mantissa >> more | (lost ? 1U : 0U)};
}

int leading_zeros(std::uint64_t value) { return __builtin_clzll(value); }

}  // namespace

Real Real::normalised(std::uint64_t high, std::uint64_t low, int exponent) {
  if (high == 0) {
    high = std::exchange(low, 0);
    exponent -= 64;
  }
  if (const int zeros = leading_zeros(high); zeros != 0) {
    high = high << zeros | low >> (64 - zeros);
    low <<= zeros;
    exponent -= zeros;
  }
  const bool up = low > kTop || (low == kTop && (high & 1U) != 0);
  if (up && ++high == 0) return {kTop, exponent + 1};
  return {high, exponent};
}

Real operator+(Real a, Real b) {
  if (a < b) std::swap(a, b);
  if (b.mantissa_ == 0) return a;
  const Wide shifted = shifted_right(b.mantissa_, a.exponent_ - b.exponent_);
  const std::uint64_t high = a.mantissa_ + shifted.high;
  if (high >= a.mantissa_) return Real::normalised(high, shifted.low, a.exponent_);
  const std::uint64_t low = shifted.low >> 1 | high << 63 | (shifted.low & 1U);
  return Real::normalised(high >> 1 | Real::kTop, low, a.exponent_ + 1);
}

Real operator-(Real a, Real b) {
  if (b.mantissa_ == 0) return a;
  const Wide shifted = shifted_right(b.mantissa_, a.exponent_ - b.exponent_);
  const std::uint64_t low = 0 - shifted.low;
  const std::uint64_t high = a.mantissa_ - shifted.high - (shifted.low != 0 ? 1U : 0U);
  return high == 0 && low == 0 ? Real() : Real::normalised(high, low, a.exponent_);
}

Real operator*(Real a, Real b) {
  if (a.mantissa_ == 0 || b.mantissa_ == 0) return {};
  const Wide full = product(a.mantissa_, b.mantissa_);
  return Real::normalised(full.high, full.low, a.exponent_ + b.exponent_ + 64);
}

Real operator/(Real a, Real b) {
  if (a.mantissa_ == 0) return {};
  // The dividend halved where it would not stay below the divisor: the quotient's highest bit is then set in any case,
  // and of what follows it, only how the rest lies to half the divisor counts.
  const bool halve = a.mantissa_ >= b.mantissa_;
  const Quotient quotient =
      divide(halve ? Wide{a.mantissa_ >> 1, a.mantissa_ << 63} : Wide{a.mantissa_, 0}, b.mantissa_);
  const std::uint64_t other = b.mantissa_ - quotient.rest;
  const std::uint64_t tail = quotient.rest < other ? 0 : Real::kTop + (quotient.rest > other ? 1U : 0U);
  return Real::normalised(quotient.value, tail, a.exponent_ - b.exponent_ - 64 + (halve ? 1 : 0));
}

Real square_root(Real a) {
  if (a.mantissa_ == 0) return {};
  // The radicand as a whole number below 2^128 over an even power of two; its root has 64 bits.
  const bool odd = (a.exponent_ & 1) != 0;
  const Wide radicand = odd ? Wide{a.mantissa_ >> 1, a.mantissa_ << 63} : Wide{a.mantissa_, 0};
  const int exponent = (a.exponent_ - 64 + (odd ? 1 : 0)) / 2;
  // 53 bits from the processor, whose square root is exact to the last of them, the others by one step of Heron's.
  const double near = std::sqrt(static_cast<double>(radicand.high) * 0x1p64);
  std::uint64_t root = near >= 0x1p64 ? ~std::uint64_t{0} : static_cast<std::uint64_t>(near);
  if (radicand.high < root) {
    const std::uint64_t other = divide(radicand, root).value;
    root = root / 2 + other / 2 + (root & other & 1U);
  }
  // At most one or two off: down to the floor, then up.
  const auto above = [&](std::uint64_t candidate) {
    const Wide square = product(candidate, candidate);
    return square.high != radicand.high ? square.high > radicand.high : square.low > radicand.low;
  };
  while (above(root)) --root;
  while (root != ~std::uint64_t{0} && !above(root + 1)) ++root;
  // A rest above the root puts it beyond the middle to the next; it is never just there.
  const Wide square = product(root, root);
  const std::uint64_t rest_low = radicand.low - square.low;
  const std::uint64_t rest_high = radicand.high - square.high - (radicand.low < square.low ? 1U : 0U);
  const bool up = rest_high != 0 || rest_low > root;
  const std::uint64_t tail = up ? ~std::uint64_t{0} : (rest_low != 0 ? 1U : 0U);
  return Real::normalised(root, tail, exponent);
}

Real ceiling(Real a) {
  if (a.mantissa_ == 0 || a.exponent_ >= 0) return a;
  if (a.exponent_ <= -64) return Real::whole(1);
  const std::uint64_t whole = a.mantissa_ >> -a.exponent_;
  const bool more = a.mantissa_ << (64 + a.exponent_) != 0;
  return Real::whole(more ? whole + 1 : whole);
}

double Real::value() const { return std::ldexp(static_cast<double>(mantissa_ & ~std::uint64_t{0x7FF}), exponent_); }

}  // namespace trammel::planner
