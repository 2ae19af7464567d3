// The machine's place that a card keeps, read as a whole, and how a program begins there: machine zero, which axes
// stand where the card says, and the scales that coordinates count in. Programs that know no scales, as one that counts
// in pulses, leave kScalesInPulses.
//
// Functions that take a card throw as driver::Card does, and are for the thread that uses it.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/driver/card.hpp"

namespace trammel::driver {

inline constexpr std::uint32_t kNoScales = 0;        // nobody has set a place since the card's reset
inline constexpr std::uint32_t kScalesInPulses = 1;  // a machine zero, and no scales yet

// What the card keeps, and where it stands.
struct CardPlace {
  Snapshot now;
  Place bits;
  std::array<std::int32_t, card_map::kMaxAxes> zero{};  // POSITION at machine coordinate 0, by axis of the card
  std::uint32_t scales = kNoScales;
  std::uint8_t keeps = 0;  // axes that keep their place through a stop at once; bit n: axis n

  bool was_set() const { return scales != kNoScales; }
  // From machine zero, by axis of the card, for distances below 2^31; zeros where no place was set.
  std::array<std::int32_t, card_map::kMaxAxes> pulses() const;
};
CardPlace read_card_place(Card& card);

// Writes what the card did not know of its place before a program began there: machine zero where it stands and all
// axes valid, where no place was set; the scales, where they were in pulses; that `trusted` axes are valid. The card
// stands. The scales come last: a program that ends before has left the card without a place.
void keep_place(Card& card, const CardPlace& place, std::uint32_t scales, std::uint8_t trusted);

struct PlaceBegin {
  CardPlace place;     // as the card has it now
  bool first = false;  // machine zero was set here, since nobody had set one since the card's reset
};
// For programs that count in pulses and are to move the axes in `axes` (bit n: axis n). Sets machine zero where the
// card stands, and all axes valid, if nobody has set a place since the card's reset; else leaves what there is. Throws
// StateError, and writes nothing, where the card is busy, and where an axis in `axes` has lost its place; with `trust`
// that axis counts as valid again. ArgumentError for an axis that the card lacks.
PlaceBegin begin_at_place(Card& card, std::uint8_t axes, bool trust = false);

}  // namespace trammel::driver
