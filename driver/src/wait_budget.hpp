// How long a call waits for the card: as long as what was planned takes, and a margin. A hold and a wait for an input
// stop the clock, a ratio below 1 stretches what the time base gates. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::driver {

// Clocks that something takes.
struct PlannedTime {
  struct Part {
    std::uint64_t gated = 0;  // at full ratio of the time base
    PieceClass piece_class = PieceClass::kFeed;
  };
  static PlannedTime of(std::uint64_t gated, PieceClass piece_class = PieceClass::kFeed) {
    return {{Part{gated, piece_class}, Part{}}, 0};
  }

  std::array<Part, 2> parts;  // one after the other
  std::uint64_t real = 0;     // whatever the ratio
};

class WaitBudget {
 public:
  // What pause() may wake for, by the bits of IRQ_ENABLE.
  static constexpr std::uint32_t kIdle = card_map::field::kIrqEnableIdle;
  static constexpr std::uint32_t kProbed = card_map::field::kIrqEnableProbed;

  // `margin`: clocks beyond what was planned; 0: the time is the caller's own and holds, whatever runs. `context` names
  // what is waited for and must outlive the object.
  WaitBudget(Card& card, const char* context, std::uint64_t margin) : card_(card), context_(context), margin_(margin) {}

  // Something begins that takes so long: the time waited counts from here on.
  void allow(const PlannedTime& planned);

  // Throws TimeoutError when it is overdue, else waits for up to `clocks`, `status` being what the card said last.
  // Where the bus has interrupts it waits for what `wake` asks for (0: nothing that tells of the end), and for longer.
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
  std::array<Uint128, 2> gated_left_;  // of each part, 2^-16 clocks at full ratio
  std::uint64_t real_left_ = 0;        // clocks, the margin with them
  std::uint64_t waited_ = 0;           // clocks, without those in holds
  bool slews_counted_ = false;
  bool interrupted_ = false;  // the pause before ended so
};

}  // namespace trammel::driver
