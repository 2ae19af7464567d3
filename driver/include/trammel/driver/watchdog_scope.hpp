// The watchdog for as long as a program moves the card.
#pragma once

#include <chrono>

#include "trammel/driver/card.hpp"

namespace trammel::driver {

// From its constructor to its end, whatever ends it, the card's watchdog is set as by Card::set_watchdog(). At its end
// the watchdog is off where the card is idle. Where it still moves, or does not answer, the watchdog stays set: it
// stops a card that nobody watches any more. Not thread-safe.
class WatchdogScope {
 public:
  // `card` must outlive it. Errors as of Card::set_watchdog().
  WatchdogScope(Card& card, std::chrono::nanoseconds time) : card_(card) { card_.set_watchdog(time); }
  ~WatchdogScope();
  WatchdogScope(const WatchdogScope&) = delete;
  WatchdogScope& operator=(const WatchdogScope&) = delete;

 private:
  Card& card_;
};

}  // namespace trammel::driver
