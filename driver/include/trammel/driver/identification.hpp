// Identification and build of a card. Plain data, thread-safe.
#pragma once

#include <cstdint>

#include "trammel/driver/unit_table.hpp"

namespace trammel::driver {

// The card's identification.
struct Identification {
  std::uint16_t map_major = 0;
  std::uint16_t map_minor = 0;
  std::uint32_t commands_version = 0;
  unsigned axes = 0;                 // 1 .. 8
  std::uint32_t clock_hz = 0;        // Hz
  UnitTable units;                   // the units in the card
  std::uint32_t engines = 0;         // the engines of the units, as bits of card_map::engine
  std::uint32_t geometry_depth = 0;  // geometry queue, halfwords
  std::uint32_t feed_depth = 0;      // feed queue, halfwords
};

// Whether a piece's slew shift (FeedCommand::slew_shift) has an effect: this needs classes and time_base 1.1 (map 3.4).
inline bool has_slew_shift(const Identification& card) {
  const card_map::Descriptor* unit = card.units.find(card_map::unit::kTimeBase);
  return unit != nullptr && unit->minor >= 1 && card_map::has_engine(card.engines, card_map::engine::kClasses);
}

// The sources and the board from which the card was built.
struct Build {
  std::uint32_t id = 0;     // id of the sources; 0 if unknown
  bool dirty = false;       // a source was modified
  std::uint32_t board = 0;  // number of the board (docs/user/boards.md); 0 if unknown
};

}  // namespace trammel::driver
