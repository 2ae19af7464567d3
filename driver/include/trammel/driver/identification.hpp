// Who a card is and what it was built of. Plain data, thread-safe.
#pragma once

#include <cstdint>

#include "trammel/driver/unit_table.hpp"

namespace trammel::driver {

// What the card says of itself.
struct Identification {
  std::uint16_t map_major = 0;
  std::uint16_t map_minor = 0;
  std::uint32_t commands_version = 0;
  unsigned axes = 0;                 // 1 .. 8
  std::uint32_t clock_hz = 0;        // Hz
  UnitTable units;                   // what it is built of
  std::uint32_t engines = 0;         // the same as card_map::engine's bits
  std::uint32_t geometry_depth = 0;  // halfwords
  std::uint32_t feed_depth = 0;      // halfwords
};

// Whether a piece's slew shift (FeedCommand::slew_shift) has an effect: classes, and time_base 1.1 (map 3.4).
inline bool has_slew_shift(const Identification& card) {
  const card_map::Descriptor* unit = card.units.find(card_map::unit::kTimeBase);
  return unit != nullptr && unit->minor >= 1 && card_map::has_engine(card.engines, card_map::engine::kClasses);
}

// What it was made of.
struct Build {
  std::uint32_t id = 0;     // of the sources; 0 where nobody said
  bool dirty = false;       // one of them was changed
  std::uint32_t board = 0;  // docs/user/boards.md; 0 where nobody said
};

}  // namespace trammel::driver
