// The units that a card is built of, as its descriptors tell them (docs/reference/registers.md, Units and engines).
//
// Plain values: safe to copy, no bus behind them. A driver of this map knows the units of card_map::kUnits; it leaves
// units with other tags alone, so that a card with newer units works.
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

  // Reads the table in one transfer and checks it for a card of `axes` axes (1 .. 8). Throws IdentificationError,
  // naming the unit and what is wrong with it: no ending tag, a tag twice, a range beyond the window or over another
  // unit's, a stride smaller than the words used, no instance; of a unit that this driver knows: another major version,
  // other addresses, fewer words, or its absence where every card has it. LinkError as the bus throws it.
  static UnitTable read(Bus& bus, unsigned axes);

  const card_map::Descriptor* begin() const { return units_.data(); }
  const card_map::Descriptor* end() const { return units_.data() + count_; }
  std::size_t size() const { return count_; }
  // The unit with a tag (card_map::unit), nullptr where the card lacks it.
  const card_map::Descriptor* find(std::uint8_t tag) const;
  // What is built in, as card_map::engine has it.
  std::uint32_t engines() const;

 private:
  void check(unsigned axes) const;

  std::array<card_map::Descriptor, card_map::kDescriptorSlots> units_{};
  std::size_t count_ = 0;
};

// What it shows to be built in, as card_map::engine has it; 0 where this driver does not know the unit.
std::uint32_t engines_of(const card_map::Descriptor& unit);
// Its name, "tag 200" where this driver does not know the unit.
std::string unit_name(const card_map::Descriptor& unit);
// The engines that its features show, "feature 3" where this driver does not know one: "jerk, feature 3". May be empty.
std::string feature_names(const card_map::Descriptor& unit);

}  // namespace trammel::driver
