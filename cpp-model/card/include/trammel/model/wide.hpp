// 128-bit unsigned numbers for the models' wide words: the compiler's own type if it has one, otherwise TwoWords, so
// that the models also run on 32-bit hosts. Pure values, thread-safe; arithmetic wraps at 128 bits.
#pragma once

#include <cstdint>
#include <type_traits>

namespace trammel::model {

// The part of unsigned __int128 that the models use.
class TwoWords {
 public:
  constexpr TwoWords() = default;
  // Negative numbers wrap, as in every conversion to an unsigned type.
  template <typename Number, typename = std::enable_if_t<std::is_integral_v<Number>>>
  constexpr TwoWords(Number number) : low_(static_cast<std::uint64_t>(number)) {
    if constexpr (std::is_signed_v<Number>) high_ = number < 0 ? ~std::uint64_t{0} : 0;
  }
  constexpr TwoWords(std::uint64_t high, std::uint64_t low) : low_(low), high_(high) {}

  template <typename Number, typename = std::enable_if_t<std::is_integral_v<Number>>>
  constexpr explicit operator Number() const {
    return static_cast<Number>(low_);
  }

  constexpr TwoWords operator~() const { return {~high_, ~low_}; }
  friend constexpr TwoWords operator+(TwoWords a, TwoWords b) {
    const std::uint64_t low = a.low_ + b.low_;
    return {a.high_ + b.high_ + (low < a.low_ ? 1 : 0), low};
  }
  friend constexpr TwoWords operator-(TwoWords a, TwoWords b) { return a + ~b + TwoWords{1}; }
  friend constexpr TwoWords operator&(TwoWords a, TwoWords b) { return {a.high_ & b.high_, a.low_ & b.low_}; }
  friend constexpr TwoWords operator|(TwoWords a, TwoWords b) { return {a.high_ | b.high_, a.low_ | b.low_}; }
  friend constexpr TwoWords operator*(TwoWords a, TwoWords b) {
    const std::uint64_t a_low = a.low_ & kHalf;
    const std::uint64_t a_high = a.low_ >> 32;
    const std::uint64_t b_low = b.low_ & kHalf;
    const std::uint64_t b_high = b.low_ >> 32;
    const TwoWords outer{a.high_ * b.low_ + a.low_ * b.high_ + a_high * b_high, a_low * b_low};
    return outer + (TwoWords{a_low * b_high} << 32) + (TwoWords{a_high * b_low} << 32);
  }
  // By 0 to 127 bits.
  friend constexpr TwoWords operator<<(TwoWords a, unsigned bits) {
    if (bits == 0) return a;
    if (bits >= 64) return {a.low_ << (bits - 64), 0};
    return {a.high_ << bits | a.low_ >> (64 - bits), a.low_ << bits};
  }
  friend constexpr TwoWords operator>>(TwoWords a, unsigned bits) {
    if (bits == 0) return a;
    if (bits >= 64) return {0, a.high_ >> (bits - 64)};
    return {a.high_ >> bits, a.low_ >> bits | a.high_ << (64 - bits)};
  }
  constexpr TwoWords& operator+=(TwoWords other) { return *this = *this + other; }
  constexpr TwoWords& operator-=(TwoWords other) { return *this = *this - other; }

  friend constexpr bool operator==(TwoWords a, TwoWords b) { return a.high_ == b.high_ && a.low_ == b.low_; }
  friend constexpr bool operator!=(TwoWords a, TwoWords b) { return !(a == b); }
  friend constexpr bool operator<(TwoWords a, TwoWords b) {
    return a.high_ != b.high_ ? a.high_ < b.high_ : a.low_ < b.low_;
  }
  friend constexpr bool operator>(TwoWords a, TwoWords b) { return b < a; }
  friend constexpr bool operator<=(TwoWords a, TwoWords b) { return !(b < a); }
  friend constexpr bool operator>=(TwoWords a, TwoWords b) { return !(a < b); }

 private:
  static constexpr std::uint64_t kHalf = 0xFFFFFFFF;

  std::uint64_t low_ = 0;
  std::uint64_t high_ = 0;
};

#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 uint128;
#else
using uint128 = TwoWords;
#endif

}  // namespace trammel::model
