// The time that a call waits for the card: the planned time plus a margin. Holds and waits for an input do not count; a
// ratio below 1 extends the part that the time base gates. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::driver {

// The planned duration of an action, clocks.
struct PlannedTime {
  struct Part {
    std::uint64_t gated = 0;  // clocks at the full ratio of the time base
    PieceClass piece_class = PieceClass::kFeed;
  };
  static PlannedTime of(std::uint64_t gated, PieceClass piece_class = PieceClass::kFeed) {
    return {{Part{gated, piece_class}, Part{}}, 0};
  }

  std::array<Part, 2> parts;  // executed in sequence
  std::uint64_t real = 0;     // clocks that do not depend on the ratio
};

class WaitBudget {
 public:
  // Wake conditions of pause(): bits of IRQ_ENABLE.
  static constexpr std::uint32_t kIdle = card_map::field::kIrqEnableIdle;
  static constexpr std::uint32_t kProbed = card_map::field::kIrqEnableProbed;

  // `margin`: clocks in addition to the planned time. 0: the time is the caller's own limit, which holds whatever the
  // card does. `context` names the action waited for, and must outlive the object.
  WaitBudget(Card& card, const char* context, std::uint64_t margin) : card_(card), context_(context), margin_(margin) {}

  // Starts a new action of the planned duration; the time waited counts from here.
  void allow(const PlannedTime& planned);

  // Throws TimeoutError when the action is overdue; otherwise waits for up to `clocks`. `status`: the card's last
  // status. If the bus has interrupts, waits for a condition in `wake` (0: none that reports the end), and longer.
  void pause(const Status& status, std::uint64_t clocks, std::uint32_t wake);

 private:
  std::uint32_t ratio_of(std::size_t part) const { return card_.ratio(planned_.parts[part].piece_class); }
  void allow_again();
  bool stands() const;
  std::uint64_t left() const;
  bool overdue();
  bool ratios_changed(const Access* accesses, std::size_t count);
  void count(std::uint64_t clocks);

  Card& card_;
  const char* context_;
  std::uint64_t margin_;
  PlannedTime planned_;
  std::array<Uint128, 2> gated_left_;  // remaining time of each part, 2^-16 clocks at full ratio
  std::uint64_t real_left_ = 0;        // remaining clocks, including the margin
  std::uint64_t waited_ = 0;           // clocks waited, without holds
  bool slews_counted_ = false;
  bool interrupted_ = false;  // an interrupt ended the previous pause
};

}  // namespace trammel::driver
