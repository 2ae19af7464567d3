// Valid stream commands and their single-field violations, made from the layout table alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "trammel/card_map.hpp"

namespace trammel::testing {

__extension__ typedef unsigned __int128 uint128;

inline constexpr std::size_t kCountBegin = 2;
inline constexpr std::size_t kPayloadBegin = 5;
inline constexpr std::uint64_t kCountMaximum = (std::uint64_t{1} << 40) - 1;
// Lines, accumulator, jerk and direct mode.
inline constexpr std::uint32_t kUsualEngines = 0x33;
inline constexpr std::uint32_t kAllEngines = 0x7FF;

// The halfwords of a command as they are sent, without padding.
struct WireCommand {
  const card_map::Command* layout = nullptr;
  std::vector<std::uint16_t> halfwords;

  std::uint8_t mask() const { return static_cast<std::uint8_t>(halfwords[0] >> 8); }
  std::uint8_t number() const { return static_cast<std::uint8_t>(halfwords[1] >> 8); }
  uint128 value(std::size_t begin, std::size_t count) const {
    uint128 sum = 0;
    for (std::size_t i = count; i > 0; --i) sum = sum << 16 | halfwords[begin + i - 1];
    return sum;
  }
  void set_value(std::size_t begin, std::size_t count, uint128 value) {
    for (std::size_t i = 0; i < count; ++i) halfwords[begin + i] = static_cast<std::uint16_t>(value >> (16 * i));
  }
  std::vector<std::uint32_t> words(std::uint16_t padding = 0) const {
    std::vector<std::uint16_t> padded = halfwords;
    if (padded.size() % 2 != 0) padded.push_back(padding);
    std::vector<std::uint32_t> result;
    for (std::size_t i = 0; i < padded.size(); i += 2) result.push_back(padded[i] | std::uint32_t{padded[i + 1]} << 16);
    return result;
  }
  // The halfwords that the queues hold: all but halfword 1.
  std::vector<std::uint16_t> stored() const {
    std::vector<std::uint16_t> result = halfwords;
    result.erase(result.begin() + 1);
    return result;
  }
};

// The first halfword of a field in a command.
struct Place {
  const card_map::Field* field;
  std::size_t begin;
};

inline std::vector<Place> places(const card_map::Command& layout, std::uint8_t mask) {
  std::vector<Place> result;
  const std::size_t axes = card_map::axes_in(mask) - layout.axes_in_base;
  for (std::size_t i = 0; i < layout.field_count; ++i) {
    const card_map::Field& field = layout.fields[i];
    for (std::size_t copy = 0; copy < (field.per_axis ? axes : 1); ++copy) {
      result.push_back({&field, kPayloadBegin + field.offset + copy * layout.axis_halfwords});
    }
  }
  return result;
}

class CommandSource {
 public:
  // `engines` are those of the card that receives the commands.
  CommandSource(unsigned axes, std::uint64_t seed, std::uint32_t engines = kUsualEngines)
      : axes_(axes), engines_(engines), random_(seed) {}

  // True when a card with these axes and engines accepts commands of this layout.
  static bool possible(const card_map::Command& layout, unsigned axes, std::uint32_t engines) {
    const bool plane =
        layout.mask_rule == card_map::MaskRule::Plane || layout.mask_rule == card_map::MaskRule::PlaneAndAxes;
    return card_map::is_known(layout, engines) && (axes >= 2 || !plane);
  }

  std::mt19937_64& random() { return random_; }

  // A random command that the card accepts.
  WireCommand any(std::uint8_t number) {
    const card_map::Command* layout = nullptr;
    do {
      layout = &card_map::kCommands[random_() % card_map::kCommands.size()];
    } while (!possible(*layout, axes_, engines_));
    return make(*layout, number);
  }

  WireCommand make(const card_map::Command& layout, std::uint8_t number) {
    return make(layout, number, random_mask(layout));
  }

  WireCommand make(const card_map::Command& layout, std::uint8_t number, std::uint8_t mask) {
    WireCommand command;
    command.layout = &layout;
    command.halfwords.resize(card_map::halfwords(layout, mask));
    command.halfwords[0] = static_cast<std::uint16_t>(unsigned{mask} << 8 | static_cast<unsigned>(layout.opcode));
    command.halfwords[1] = static_cast<std::uint16_t>(unsigned{number} << 8 | card_map::words(layout, mask));
    command.set_value(kCountBegin, 3, random_between(layout.count_minimum, layout.count_maximum));
    for (const Place& place : places(layout, mask)) {
      command.set_value(place.begin, place.field->halfwords, random_value(*place.field, command));
    }
    return command;
  }

 private:
  std::uint8_t random_mask(const card_map::Command& layout) {
    const auto all = (1U << axes_) - 1U;
    std::uint8_t mask = 0;
    switch (layout.mask_rule) {
      case card_map::MaskRule::None:
        return 0;
      case card_map::MaskRule::Flags:
        mask = static_cast<std::uint8_t>(random_() & layout.flags_free);
        if (card_map::has_engine(engines_, layout.flags_engine))
          mask = static_cast<std::uint8_t>(mask | random_() % (layout.flags_maximum + 1));
        return mask;
      case card_map::MaskRule::Any:
        do {
          mask = static_cast<std::uint8_t>(random_() & all);
        } while (mask == 0);
        return mask;
      case card_map::MaskRule::Plane:
      case card_map::MaskRule::PlaneAndAxes:
        do {
          mask = static_cast<std::uint8_t>(random_() & all);
        } while (layout.mask_rule == card_map::MaskRule::Plane ? card_map::axes_in(mask) != 2
                                                               : card_map::axes_in(mask) < 2);
        return mask;
    }
    return mask;
  }

  // The bounds and small numbers are frequent.
  uint128 random_between(uint128 low, uint128 high) {
    const std::uint64_t kind = random_() % 8;
    if (kind == 0 || high == low) return low;
    if (kind == 1) return high;
    const uint128 any = uint128{random_()} << 64 | random_();
    const uint128 span = high - low + 1;
    return low + (kind < 4 ? (any & 0xFFFF) % span : any % span);
  }

  uint128 random_value(const card_map::Field& field, const WireCommand& command) {
    if (field.name == "plane") return random_plane(command.mask(), card_map::bits_with_meaning(field, engines_));
    if (field.mask != 0) return random_() & card_map::bits_with_meaning(field, engines_);
    if (field.kind == card_map::FieldKind::Signed) {
      const uint128 magnitude_limit = field.limit != 0 ? uint128{field.limit} : (uint128{1} << (field.bits - 1)) - 1;
      const uint128 magnitude = random_between(0, magnitude_limit);
      return random_() % 2 == 0 ? magnitude : 0 - magnitude;
    }
    uint128 high = field.limit != 0 ? uint128{field.limit} : (uint128{1} << field.bits) - 1;
    if (field.at_most_count) high = std::min(high, command.value(kCountBegin, 3));
    return random_between(field.minimum, high);
  }

  // Two random axes of the mask, in random order.
  uint128 random_plane(std::uint8_t mask, std::uint32_t bits) {
    unsigned first = 0;
    unsigned second = 0;
    do {
      first = random_() % 8;
      second = random_() % 8;
    } while (first == second || (mask >> first & 1) == 0 || (mask >> second & 1) == 0);
    return (random_() & bits & 0xF) | first << 4 | second << 8;
  }

  unsigned axes_;
  std::uint32_t engines_;
  std::mt19937_64 random_;
};

// A command with one error.
struct Violation {
  std::string name;
  WireCommand command;
  card_map::Reason reason;
  std::uint16_t padding = 0;
};

namespace detail {

inline void add_range_violations(std::vector<Violation>& list, const WireCommand& good, const Place& place,
                                 std::uint32_t engines) {
  const card_map::Field& field = *place.field;
  const auto add = [&](const std::string& what, uint128 value) {
    Violation v{std::string(field.name) + "@" + std::to_string(place.begin) + " " + what, good,
                card_map::Reason::BadField, 0};
    v.command.set_value(place.begin, field.halfwords, value);
    list.push_back(v);
  };
  const unsigned wire_bits = 16 * field.halfwords;
  if (field.minimum == 1) add("zero", 0);
  if (field.mask != 0) {
    const uint128 old = good.value(place.begin, field.halfwords);
    for (unsigned bit = 0; bit < wire_bits; ++bit) {
      if ((card_map::bits_with_meaning(field, engines) >> bit & 1) == 0)
        add("bit " + std::to_string(bit), old | uint128{1} << bit);
    }
    return;
  }
  if (field.at_most_count) {
    const uint128 count = good.value(kCountBegin, 3);
    for (unsigned bit : {0U, 15U, 16U, 31U, 32U}) {
      if (count + (uint128{1} << bit) <= kCountMaximum)
        add("count + 2^" + std::to_string(bit), count + (uint128{1} << bit));
    }
  }
  if (field.limit != 0) {
    for (unsigned bit : {0U, 15U, 16U, 31U, 32U, 39U}) {
      add("limit + 2^" + std::to_string(bit), uint128{field.limit} + (uint128{1} << bit));
      if (field.kind == card_map::FieldKind::Signed) {
        add("-limit - 2^" + std::to_string(bit), 0 - uint128{field.limit} - (uint128{1} << bit));
      }
    }
  }
  for (unsigned bit = field.bits; bit < wire_bits; ++bit) {
    add("extension bit " + std::to_string(bit), good.value(place.begin, field.halfwords) ^ uint128{1} << bit);
  }
}

inline void add_header_violations(std::vector<Violation>& list, const WireCommand& good, unsigned axes,
                                  std::uint32_t engines) {
  const auto add = [&](const std::string& what, std::size_t halfword, unsigned flip, card_map::Reason reason) {
    Violation v{what, good, reason, 0};
    v.command.halfwords[halfword] = static_cast<std::uint16_t>(v.command.halfwords[halfword] ^ flip);
    list.push_back(v);
  };
  for (unsigned opcode = 0; opcode < 256; ++opcode) {
    const card_map::Command* known = card_map::find_command(static_cast<std::uint8_t>(opcode));
    if (known != nullptr && card_map::is_known(*known, engines)) continue;
    add("opcode " + std::to_string(opcode), 0, opcode ^ (good.halfwords[0] & 0xFFU), card_map::Reason::UnknownOpcode);
  }
  for (unsigned flip = 1; flip < 256; ++flip) {
    add("length ^ " + std::to_string(flip), 1, flip, card_map::Reason::BadLength);
    add("number ^ " + std::to_string(flip), 1, flip << 8, card_map::Reason::BadNumber);
  }
  const bool names_axes = good.layout->mask_rule != card_map::MaskRule::Flags;
  for (unsigned axis = axes; axis < 8 && names_axes; ++axis) {
    add("absent axis " + std::to_string(axis), 0, 0x100U << axis, card_map::Reason::BadMask);
  }
  if (good.mask() != 0 && names_axes)
    add("no axis", 0, static_cast<unsigned>(good.mask()) << 8, card_map::Reason::BadMask);
  for (unsigned axis = 0; axis < axes && good.layout->mask_rule == card_map::MaskRule::PlaneAndAxes; ++axis) {
    const unsigned flip = (1U << axis) ^ good.mask();
    add("axis " + std::to_string(axis) + " alone", 0, flip << 8, card_map::Reason::BadMask);
  }
  if (good.layout->mask_rule == card_map::MaskRule::None) {
    for (unsigned mask = 1; mask < 256; ++mask) {
      add("mask " + std::to_string(mask), 0, mask << 8, card_map::Reason::BadMask);
    }
  }
  if (!names_axes) {
    const unsigned most = card_map::has_engine(engines, good.layout->flags_engine) ? good.layout->flags_maximum : 0;
    for (unsigned flags = most + 1; flags < 256; ++flags) {
      if ((flags & ~unsigned{good.layout->flags_free}) <= most) continue;
      add("flags " + std::to_string(flags), 0, (flags ^ good.mask()) << 8, card_map::Reason::BadMask);
    }
  }
}

inline void add_plane_violations(std::vector<Violation>& list, const WireCommand& good, const Place& place,
                                 unsigned axes) {
  for (unsigned pair = 0; pair < 64; ++pair) {
    const unsigned first = pair & 7;
    const unsigned second = pair >> 3;
    const unsigned both = 1U << first | 1U << second;
    if (first != second && (both & good.mask()) == both) continue;
    Violation v{"plane " + std::to_string(first) + " " + std::to_string(second), good, card_map::Reason::BadMask, 0};
    v.command.halfwords[place.begin] = static_cast<std::uint16_t>(first << 4 | second << 8);
    list.push_back(v);
  }
  const auto plane = static_cast<unsigned>(good.value(place.begin, 1));
  const unsigned both = 1U << (plane >> 4 & 7) | 1U << (plane >> 8 & 7);
  for (unsigned mask = 1; mask < 1U << axes; ++mask) {
    // Another number of further axes would make the length wrong first.
    const bool same_length = card_map::axes_in(static_cast<std::uint8_t>(mask)) == card_map::axes_in(good.mask());
    const bool alone = good.layout->axis_halfwords == 0;
    if ((alone ? mask == good.mask() : (mask & both) == both) || (!alone && !same_length)) continue;
    Violation v{"mask of another plane " + std::to_string(mask), good, card_map::Reason::BadMask, 0};
    v.command.halfwords[0] = static_cast<std::uint16_t>(mask << 8 | (good.halfwords[0] & 0xFFU));
    list.push_back(v);
  }
}

}  // namespace detail

// All single errors in `good` that the layout table can describe.
inline std::vector<Violation> violations(const WireCommand& good, unsigned axes,
                                         std::uint32_t engines = kUsualEngines) {
  std::vector<Violation> list;
  detail::add_header_violations(list, good, axes, engines);
  const auto add_count = [&](const std::string& what, uint128 value) {
    Violation v{"count " + what, good, card_map::Reason::BadField, 0};
    v.command.set_value(kCountBegin, 3, value);
    list.push_back(v);
  };
  if (good.layout->count_minimum != 0) add_count("zero", 0);
  const unsigned first_bad_bit = good.layout->count_maximum == 0 ? 0 : 40;
  for (unsigned bit = first_bad_bit; bit < 48; ++bit) {
    add_count("bit " + std::to_string(bit), good.value(kCountBegin, 3) | uint128{1} << bit);
  }
  for (const Place& place : places(*good.layout, good.mask())) {
    detail::add_range_violations(list, good, place, engines);
    if (place.field->name == "plane") detail::add_plane_violations(list, good, place, axes);
  }
  if (good.halfwords.size() % 2 != 0) {
    for (unsigned bit = 0; bit < 16; ++bit) {
      list.push_back({"padding bit " + std::to_string(bit), good, card_map::Reason::BadField,
                      static_cast<std::uint16_t>(1U << bit)});
    }
  }
  return list;
}

}  // namespace trammel::testing
