// Sets the watchdog while a program moves the card.
#pragma once

#include <chrono>

#include "trammel/driver/card.hpp"

namespace trammel::driver {

// The constructor sets the card's watchdog, as Card::set_watchdog(). The destructor switches it off if the card is
// idle. If the card still moves, or does not answer, the watchdog stays set and stops the card, which no program
// supervises any more. Not thread-safe.
class WatchdogScope {
 public:
  // `card` must outlive the object. Errors as of Card::set_watchdog().
  WatchdogScope(Card& card, std::chrono::nanoseconds time) : card_(card) { card_.set_watchdog(time); }
  ~WatchdogScope();
  WatchdogScope(const WatchdogScope&) = delete;
  WatchdogScope& operator=(const WatchdogScope&) = delete;

 private:
  Card& card_;
};

}  // namespace trammel::driver
