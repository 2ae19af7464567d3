// Positive numbers of 64 significant bits, each operation rounded to the nearest (ties to even), from integers alone:
// the same bits on every host. The card's rates have 64 fraction bits: a double has 53 of them, and long double is
// another type on every kind of host. Internal to the planner; pure, thread-safe.
#pragma once

#include <cstdint>
#include <cstring>

namespace trammel::planner {

class Real {
 public:
  constexpr Real() = default;  // 0
  // Exact. `value` is 0 or a normal number above 0.
  explicit Real(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    if (bits == 0) return;
    mantissa_ = (bits << 11) | kTop;
    exponent_ = static_cast<int>(bits >> 52) - 1023 - 63;
  }
  static Real whole(std::uint64_t value) { return value == 0 ? Real() : normalised(value, 0, 0); }

  friend Real operator+(Real a, Real b);
  friend Real operator-(Real a, Real b);  // a >= b
  friend Real operator*(Real a, Real b);
  friend Real operator/(Real a, Real b);  // b is not 0
  friend Real square_root(Real a);
  friend Real ceiling(Real a);  // the least whole number that is not below it

  friend bool operator<(Real a, Real b) {
    if (a.mantissa_ == 0 || b.mantissa_ == 0 || a.exponent_ == b.exponent_) return a.mantissa_ < b.mantissa_;
    return a.exponent_ < b.exponent_;
  }
  friend bool operator<=(Real a, Real b) { return !(b < a); }

  // times 2^power
  Real scaled(int power) const {
    Real result = *this;
    if (mantissa_ != 0) result.exponent_ += power;
    return result;
  }
  // floor(this * 2^power), below 2^64.
  std::uint64_t floor(int power = 0) const {
    const int right = -(exponent_ + power);
    return right >= 64 ? 0 : mantissa_ >> right;
  }
  // Rounded towards 0.
  double value() const;

 private:
  static constexpr std::uint64_t kTop = std::uint64_t{1} << 63;

  constexpr Real(std::uint64_t mantissa, int exponent) : mantissa_(mantissa), exponent_(exponent) {}
  // The 128 bits high:low with lowest weight of `high` 2^exponent, high not 0 or low not 0.
  static Real normalised(std::uint64_t high, std::uint64_t low, int exponent);

  std::uint64_t mantissa_ = 0;  // 0, or the highest bit is set
  int exponent_ = 0;            // of the mantissa's lowest bit
};

}  // namespace trammel::planner
