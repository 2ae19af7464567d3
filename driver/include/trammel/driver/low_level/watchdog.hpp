// The card's watchdog over this program: its time, and writing it anew. What Card says of it holds here. Errors and
// thread-safety: as of Registers.
#pragma once

#include <chrono>
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
  // The access that starts the time anew, or keeps the watchdog off: this program is there.
  Access restart() const;

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
