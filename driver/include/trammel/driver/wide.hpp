// 128-bit integers for hosts that have none. Plain values, constexpr, safe from any thread. Arithmetic is modulo 2^128;
// Int128 is two's complement.
#pragma once

#include <cstdint>

namespace trammel::driver {

class Uint128 {
 public:
  constexpr Uint128() = default;
  constexpr Uint128(std::uint64_t value) : low_(value) {}  // NOLINT: as the built-in integers widen
  constexpr Uint128(std::uint64_t high, std::uint64_t low) : high_(high), low_(low) {}

  constexpr std::uint64_t high() const { return high_; }
  constexpr std::uint64_t low() const { return low_; }

  // The full product of two 64-bit numbers.
  static constexpr Uint128 product(std::uint64_t a, std::uint64_t b) {
    constexpr std::uint64_t kMask = 0xFFFFFFFF;
    const std::uint64_t low_low = (a & kMask) * (b & kMask);
    const std::uint64_t low_high = (a & kMask) * (b >> 32);
    const std::uint64_t high_low = (a >> 32) * (b & kMask);
    const std::uint64_t middle = (low_low >> 32) + (low_high & kMask) + (high_low & kMask);
    return {(a >> 32) * (b >> 32) + (low_high >> 32) + (high_low >> 32) + (middle >> 32),
            (middle << 32) | (low_low & kMask)};
  }

  friend constexpr Uint128 operator+(Uint128 a, Uint128 b) {
    const std::uint64_t low = a.low_ + b.low_;
    return {a.high_ + b.high_ + (low < a.low_ ? 1U : 0U), low};
  }
  friend constexpr Uint128 operator-(Uint128 a, Uint128 b) {
    return {a.high_ - b.high_ - (a.low_ < b.low_ ? 1U : 0U), a.low_ - b.low_};
  }
  friend constexpr Uint128 operator*(Uint128 a, Uint128 b) {
    const Uint128 low = product(a.low_, b.low_);
    return {low.high_ + a.high_ * b.low_ + a.low_ * b.high_, low.low_};
  }
  // bits: 0 .. 127
  friend constexpr Uint128 operator<<(Uint128 a, unsigned bits) {
    if (bits == 0) return a;
    if (bits >= 64) return {a.low_ << (bits - 64), 0};
    return {a.high_ << bits | a.low_ >> (64 - bits), a.low_ << bits};
  }
  friend constexpr Uint128 operator>>(Uint128 a, unsigned bits) {
    if (bits == 0) return a;
    if (bits >= 64) return {0, a.high_ >> (bits - 64)};
    return {a.high_ >> bits, a.low_ >> bits | a.high_ << (64 - bits)};
  }
  friend constexpr bool operator==(Uint128 a, Uint128 b) { return a.high_ == b.high_ && a.low_ == b.low_; }
  friend constexpr bool operator!=(Uint128 a, Uint128 b) { return !(a == b); }
  friend constexpr bool operator<(Uint128 a, Uint128 b) {
    return a.high_ != b.high_ ? a.high_ < b.high_ : a.low_ < b.low_;
  }
  friend constexpr bool operator>(Uint128 a, Uint128 b) { return b < a; }
  friend constexpr bool operator<=(Uint128 a, Uint128 b) { return !(b < a); }
  friend constexpr bool operator>=(Uint128 a, Uint128 b) { return !(a < b); }

  // floor(a / b), computed bit by bit and therefore slow; b is not 0.
  friend constexpr Uint128 operator/(Uint128 a, Uint128 b) {
    Uint128 quotient;
    Uint128 rest;
    for (unsigned bit = 128; bit-- > 0;) {
      const bool carry = rest.high_ >> 63 != 0;
      rest = (rest << 1) + Uint128((a >> bit).low_ & 1U);
      if (carry || rest >= b) {
        rest = rest - b;
        quotient = quotient + (Uint128(1) << bit);
      }
    }
    return quotient;
  }

 private:
  std::uint64_t high_ = 0;
  std::uint64_t low_ = 0;
};

// ceil(a / b); b is not 0.
constexpr Uint128 ceil_div(Uint128 a, Uint128 b) {
  const Uint128 quotient = a / b;
  return quotient * b == a ? quotient : quotient + Uint128(1);
}

class Int128 {
 public:
  constexpr Int128() = default;
  constexpr Int128(std::int64_t value)  // NOLINT: as the built-in integers widen
      : bits_(value < 0 ? ~std::uint64_t{0} : 0, static_cast<std::uint64_t>(value)) {}
  constexpr explicit Int128(Uint128 bits) : bits_(bits) {}

  constexpr Uint128 bits() const { return bits_; }
  // Upper half, with the sign.
  constexpr std::int64_t high() const { return static_cast<std::int64_t>(bits_.high()); }
  constexpr std::uint64_t low() const { return bits_.low(); }
  // The lower half: the value if it fits.
  constexpr explicit operator std::int64_t() const { return static_cast<std::int64_t>(bits_.low()); }
  // Accurate to two roundings.
  constexpr explicit operator double() const {
    return static_cast<double>(high()) * 18446744073709551616.0 + static_cast<double>(low());
  }

  friend constexpr Int128 operator+(Int128 a, Int128 b) { return Int128(a.bits_ + b.bits_); }
  friend constexpr Int128 operator-(Int128 a, Int128 b) { return Int128(a.bits_ - b.bits_); }
  friend constexpr Int128 operator-(Int128 a) { return Int128(Uint128(0) - a.bits_); }
  friend constexpr Int128 operator*(Int128 a, Int128 b) { return Int128(a.bits_ * b.bits_); }
  friend constexpr Int128 operator<<(Int128 a, unsigned bits) { return Int128(a.bits_ << bits); }
  friend constexpr bool operator==(Int128 a, Int128 b) { return a.bits_ == b.bits_; }
  friend constexpr bool operator!=(Int128 a, Int128 b) { return a.bits_ != b.bits_; }
  friend constexpr bool operator<(Int128 a, Int128 b) {
    return a.high() != b.high() ? a.high() < b.high() : a.low() < b.low();
  }
  friend constexpr bool operator>(Int128 a, Int128 b) { return b < a; }
  friend constexpr bool operator<=(Int128 a, Int128 b) { return !(b < a); }
  friend constexpr bool operator>=(Int128 a, Int128 b) { return !(a < b); }

 private:
  Uint128 bits_;
};

}  // namespace trammel::driver
