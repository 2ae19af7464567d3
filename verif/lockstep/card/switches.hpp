// Switches at the card's inputs that are pressed and released at random, and that bounce. The same seed gives the
// same levels.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>

namespace trammel::test {

class Switches {
 public:
  // Switches at the inputs from `first` to `last`.
  Switches(unsigned first, unsigned last, std::uint64_t seed) : first_(first), last_(last), random_(seed) {
    for (unsigned n = first_; n <= last_; ++n) change_[n] = below(kLongest);
  }

  // The levels at this clock; `clock` never decreases.
  std::uint32_t levels(std::uint64_t clock) {
    if (clock < next_) return levels_;
    next_ = ~std::uint64_t{0};
    for (unsigned n = first_; n <= last_; ++n) {
      while (change_[n] <= clock) toggle(n);
      next_ = std::min(next_, change_[n]);
    }
    return levels_;
  }
  // The levels are constant until this clock.
  std::uint64_t next_change() const { return next_; }

 private:
  static constexpr std::uint64_t kLongest = 12'000;  // clocks; released for at most this time, pressed for a quarter

  std::uint64_t below(std::uint64_t count) { return random_() % count; }
  // Short times are as frequent as long ones: within a scan of the filters, some scans, longer than any filter.
  std::uint64_t bounce() { return 1 + below(std::uint64_t{1} << below(9)); }

  void toggle(unsigned n) {
    levels_ ^= 1U << n;
    // An even number of further changes ends at the new level.
    if (bounces_[n] == 0)
      bounces_[n] = below(3) == 0 ? 2 * static_cast<unsigned>(below(5)) : 0;
    else
      --bounces_[n];
    const bool pressed = (levels_ >> n & 1U) != 0;
    change_[n] += bounces_[n] != 0 ? bounce() : 1 + below(pressed ? kLongest / 4 : kLongest);
  }

  unsigned first_;
  unsigned last_;
  std::mt19937_64 random_;
  std::uint32_t levels_ = 0;
  std::uint64_t next_ = 0;
  std::array<std::uint64_t, 32> change_{};
  std::array<unsigned, 32> bounces_{};  // changes still to come
};

}  // namespace trammel::test
