// The card's watchdog for this program, and its watchdog for the link (LINK_TIMEOUT, from map 3.5 on) with the same
// time; and their restarts. The functions are documented in Card. Errors and thread-safety as of Registers.
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
  // Call it at each poll of the card. Restarts the time if a quarter of it has passed on the host, or at the kLooks-th
  // call since the last restart: the time of a simulated card may pass faster than the host's.
  void look();
  // The writes that restart both times, or keep both watchdogs off. The card has the first restarts() of them.
  static constexpr std::size_t kRestarts = 2;
  std::array<Access, kRestarts> restart() const;
  std::size_t restarts() const;  // 1 or 2, by the card's map

 private:
  void write();

  static constexpr unsigned kLooks = 32;

  Registers& registers_;
  const Identification& card_;
  std::uint32_t units_ = 0;  // value of WATCHDOG that this object wrote last
  unsigned looks_ = 0;       // calls of look() since the last restart
  std::chrono::steady_clock::time_point written_;
  std::chrono::nanoseconds pace_{};
};

}  // namespace trammel::driver
