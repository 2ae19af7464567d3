// How long a call waits for the card: as long as what was planned takes, and a margin. A hold stops the clock, a ratio
// below 1 stretches what the time base gates. Not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::driver {

// Clocks that something takes.
struct PlannedTime {
  std::uint64_t gated = 0;  // at full ratio of the time base
  std::uint64_t real = 0;   // whatever the ratio
};

class Patience {
 public:
  // `margin`: clocks beyond what was planned. `context` names what is waited for and must outlive the object.
  Patience(Card& card, const char* context, std::uint64_t margin) : card_(card), context_(context), margin_(margin) {}

  // Something begins that takes so long: the time waited counts from here on.
  void allow(const PlannedTime& planned);

  // Throws TimeoutError when it is overdue, else waits for up to `clocks`, `status` being what the card said last.
  void pause(const Status& status, std::uint64_t clocks, bool until_idle);

 private:
  std::uint64_t left() const;
  bool overdue();
  void count(std::uint64_t clocks);

  Card& card_;
  const char* context_;
  std::uint64_t margin_;
  PlannedTime planned_;
  Uint128 gated_left_;           // 2^-16 clocks at full ratio
  std::uint64_t real_left_ = 0;  // clocks, the margin with them
  std::uint64_t waited_ = 0;     // clocks, without those in holds
  bool slews_counted_ = false;
  bool interrupted_ = false;  // the pause before ended so
};

}  // namespace trammel::driver
