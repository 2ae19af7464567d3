// The card's watchdog over this program, and over its link (LINK_TIMEOUT, from map 3.5 on) with the same time: writing
// them anew. What Card says of them holds here. Errors and thread-safety: as of Registers.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/registers.hpp"

namespace trammel::driver {

class Watchdog {
 public:
  // Both must outlive the object.
  Watchdog(Registers& registers, const Identification& card) : registers_(registers), card_(card) {}

  void set(std::chrono::nanoseconds time);
  // The program has looked at the card: the time starts anew where a quarter of it has passed on the host, or with the
  // kLooks-th look, since the time of a simulated card may pass faster than the host's.
  void look();
  // The accesses that start the times anew, or keep both off: this program is there. Those that the card has, first.
  static constexpr std::size_t kRestarts = 2;
  std::array<Access, kRestarts> restart() const;
  std::size_t restarts() const;  // how many these are

 private:
  void write();

  static constexpr unsigned kLooks = 32;

  Registers& registers_;
  const Identification& card_;
  std::uint32_t units_ = 0;  // WATCHDOG, as written last by this object
  unsigned looks_ = 0;       // since then
  std::chrono::steady_clock::time_point written_;
  std::chrono::nanoseconds pace_{};
};

}  // namespace trammel::driver
