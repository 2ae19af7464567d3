// The units in a card, as its descriptors list them (docs/reference/registers.md, Units and engines).
//
// Plain values: safe to copy, no bus behind them. This driver knows the units of card_map::kUnits. It ignores units
// with other tags, so a card with newer units works.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "trammel/card_map.hpp"
#include "trammel/driver/bus.hpp"

namespace trammel::driver {

class UnitTable {
 public:
  UnitTable() = default;

  // Reads the table in one transfer and checks it for a card of `axes` axes (1 .. 8). Throws IdentificationError, which
  // names the unit and its defect: no end tag, a duplicate tag, a range beyond the window or overlapping another
  // unit's, a stride smaller than the words used, no instance; and for a unit that this driver knows: another major
  // version, other addresses, fewer words, or its absence if every card has it. Throws LinkError as the bus does.
  static UnitTable read(Bus& bus, unsigned axes);

  const card_map::Descriptor* begin() const { return units_.data(); }
  const card_map::Descriptor* end() const { return units_.data() + count_; }
  std::size_t size() const { return count_; }
  // The unit with the tag (card_map::unit); nullptr if the card lacks it.
  const card_map::Descriptor* find(std::uint8_t tag) const;
  // The engines of all units, as bits of card_map::engine.
  std::uint32_t engines() const;

 private:
  void check(unsigned axes) const;

  std::array<card_map::Descriptor, card_map::kDescriptorSlots> units_{};
  std::size_t count_ = 0;
};

// The engines of the unit, as bits of card_map::engine; 0 if this driver does not know the unit.
std::uint32_t engines_of(const card_map::Descriptor& unit);
// Name of the unit; "tag 200" if this driver does not know it.
std::string unit_name(const card_map::Descriptor& unit);
// Names of the engines of the unit's features; "feature 3" for one that this driver does not know: "jerk, feature 3".
// May be empty.
std::string feature_names(const card_map::Descriptor& unit);

}  // namespace trammel::driver
