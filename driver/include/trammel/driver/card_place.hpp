// The machine's place as the card keeps it, read as a whole, and how a program starts from it: machine zero, the axes
// whose position is valid, and the scales in which coordinates are counted. Programs without scales, which count in
// pulses, write kScalesInPulses.
//
// Functions that take a card throw as driver::Card does. The thread that uses the card calls them.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/driver/card.hpp"

namespace trammel::driver {

inline constexpr std::uint32_t kNoScales = 0;        // no place was set since the card's reset
inline constexpr std::uint32_t kScalesInPulses = 1;  // machine zero is set, scales are not

// The place that the card keeps, and its present state.
struct CardPlace {
  Snapshot now;
  Place bits;
  std::array<std::int32_t, card_map::kMaxAxes> zero{};  // POSITION at machine coordinate 0, by axis of the card
  std::uint32_t scales = kNoScales;
  std::uint8_t keeps = 0;  // axes that keep their place at an immediate stop; bit n: axis n

  bool was_set() const { return scales != kNoScales; }
  // Distance from machine zero, pulses, by axis of the card; correct below 2^31. Zeros if no place was set.
  std::array<std::int32_t, card_map::kMaxAxes> pulses() const;
};
CardPlace read_card_place(Card& card);

// Completes the place in the card before a program starts. The card must be at rest. If no place was set, writes
// machine zero at the present position and marks all axes valid. Otherwise marks those axes of `trusted` valid that are
// not. Writes the scales if none were set or they were in pulses. The scales come last: after a call that did not
// complete, the card still counts as having no place.
void keep_place(Card& card, const CardPlace& place, std::uint32_t scales, std::uint8_t trusted);

struct PlaceBegin {
  CardPlace place;     // the card's place after the call
  bool first = false;  // this call set machine zero, because none was set since the card's reset
};
// For programs that count in pulses and will move the axes in `axes` (bit n: axis n). If no place was set since the
// card's reset, sets machine zero at the present position and marks all axes valid; otherwise keeps the place. Throws
// StateError, and writes nothing, if the card is busy, or if an axis in `axes` has lost its place. With `trust` such an
// axis is marked valid again instead. Throws ArgumentError for an axis that the card lacks.
PlaceBegin begin_at_place(Card& card, std::uint8_t axes, bool trust = false);

}  // namespace trammel::driver
