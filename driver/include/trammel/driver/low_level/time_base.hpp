// A card's time base: the ratio of each class of pieces, its slew, and the hold. The functions are documented in Card.
// Errors and thread-safety as of Registers.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/registers.hpp"

namespace trammel::driver {

class TimeBase {
 public:
  // Both must outlive the object.
  TimeBase(Registers& registers, const Identification& card) : registers_(registers), card_(card) {}

  void set_ratio(PieceClass piece_class, std::uint32_t ratio);
  std::uint32_t ratio(PieceClass piece_class) const {
    return ratios_[has_classes() ? static_cast<std::size_t>(piece_class) : 0];
  }
  // Records a ratio that was read from the card, whichever program set it.
  void note_ratio(PieceClass piece_class, std::uint32_t ratio) {
    ratios_[static_cast<std::size_t>(piece_class)] = ratio;
  }
  void set_slew_time(std::chrono::nanoseconds full_scale);

  void set_hold(bool hold);
  // The register HOLD, whichever program wrote it.
  bool hold() { return registers_.read(card_map::reg::kHold) != 0; }
  // Whether the last hold order of this program, also by a request, was a hold.
  bool holds_by_this_program() const { return own_hold_.value_or(false); }
  // Throws HeldError if the card holds, whichever program set the hold.
  void throw_if_held(std::string_view context);

  // Whether the card has a ratio for each class of pieces; otherwise the ratio of kFeed applies to all.
  bool has_classes() const { return card_map::has_engine(card_.engines, card_map::engine::kClasses); }

 private:
  Registers& registers_;
  const Identification& card_;
  std::array<std::uint32_t, kPieceClasses> ratios_{kFullRatio, kFullRatio, kFullRatio};
  std::optional<bool> own_hold_;  // value of HOLD that this object wrote last
};

}  // namespace trammel::driver
