#include "trammel/driver/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;

constexpr std::size_t kHeaderHalfwords = 2;  // axis mask and opcode; number and length in words
constexpr std::size_t kCountHalfwords = 3;
constexpr unsigned kHalfwordBits = 16;
// Bits of the field `plane`.
constexpr unsigned kClockwiseBit = 0;
constexpr unsigned kAxisXShift = 4;
constexpr unsigned kAxisYShift = 8;
constexpr unsigned kAxisMask = 7;

// A command as the layout sees it: one value for each field in order, a field per axis once for each axis of the mask.
struct Plain {
  map::Opcode opcode = map::Opcode::End;
  std::uint8_t mask = 0;
  std::uint64_t count = 0;
  std::vector<int128> values;
};

[[noreturn]] void refuse(const map::Command& layout, const std::string& what) {
  throw ArgumentError(fmt::format("{}: {}", layout.name, what));
}

const map::Command& layout_of(map::Opcode opcode) {
  const map::Command* layout = map::find_command(static_cast<std::uint8_t>(opcode));
  if (layout == nullptr) {
    throw ArgumentError(fmt::format("opcode {} has no layout", static_cast<unsigned>(opcode)));
  }
  return *layout;
}

bool fits(const map::Field& field, int128 value) {
  const int128 limit = static_cast<int128>(field.limit);
  switch (field.kind) {
    case map::FieldKind::Signed: {
      const int128 half = int128{1} << (field.bits - 1);
      return value >= -half && value < half && (limit == 0 || (value >= -limit && value <= limit));
    }
    case map::FieldKind::Unsigned:
      break;
  }
  const bool in_mask = field.mask == 0 || (value & ~int128{field.mask}) == 0;
  return value >= static_cast<int128>(field.minimum) && value < int128{1} << field.bits &&
         (limit == 0 || value <= limit) && in_mask;
}

// Calls visit(field, value's index) for every value of the payload in the order of the wire.
template <typename Visit>
void for_each_value(const map::Command& layout, std::uint8_t mask, Visit visit) {
  std::size_t index = 0;
  for (std::size_t i = 0; i < layout.field_count; ++i) {
    const std::uint32_t axes = map::axes_in(mask);
    const std::uint32_t times = layout.fields[i].per_axis ? axes - std::min(axes, layout.axes_in_base) : 1;
    for (std::uint32_t time = 0; time < times; ++time) {
      visit(layout.fields[i], index++);
    }
  }
}

void check(const map::Command& layout, const Plain& plain) {
  if (plain.count < layout.count_minimum || plain.count > layout.count_maximum) {
    refuse(layout,
           fmt::format("count {} is outside {} .. {}", plain.count, layout.count_minimum, layout.count_maximum));
  }
  const bool names_axes = layout.mask_rule != map::MaskRule::None && layout.mask_rule != map::MaskRule::Flags;
  if ((plain.mask != 0) != names_axes) {
    refuse(layout, fmt::format("axis mask 0x{:02X}", plain.mask));
  }
  for_each_value(layout, plain.mask, [&](const map::Field& field, std::size_t index) {
    const int128 value = plain.values[index];
    if (!fits(field, value) || (field.at_most_count && value > static_cast<int128>(plain.count))) {
      refuse(layout, fmt::format("{} = {} is out of its range ({} bits, count {})", field.name, value, field.bits,
                                 plain.count));
    }
  });
}

std::uint8_t plane_mask(unsigned axis_x, unsigned axis_y) {
  return static_cast<std::uint8_t>(1U << axis_x | 1U << axis_y);
}

Plain plain_of(const LineCommand& line) {
  Plain plain{map::Opcode::Line, line.mask, line.ticks, {}};
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    if ((line.mask >> axis & 1U) != 0) {
      plain.values.push_back(line.increment[axis]);
    } else if (line.increment[axis] != 0) {
      throw ArgumentError(fmt::format("LINE: increment {} of axis {}, which is not in the mask 0x{:02X}",
                                      line.increment[axis], axis, line.mask));
    }
  }
  return plain;
}

Plain plain_of(const ArcCommand& arc) {
  if (arc.axis_x > kAxisMask || arc.axis_y > kAxisMask || arc.axis_x == arc.axis_y) {
    throw ArgumentError(fmt::format("ARC: plane of axes {} and {}", arc.axis_x, arc.axis_y));
  }
  const unsigned plane = (arc.clockwise ? 1U : 0U) << kClockwiseBit | unsigned{arc.axis_x} << kAxisXShift |
                         unsigned{arc.axis_y} << kAxisYShift;
  return {map::Opcode::Arc,
          plane_mask(arc.axis_x, arc.axis_y),
          arc.ticks,
          {static_cast<int128>(arc.path_ticks), static_cast<int128>(arc.prescale), plane, arc.quadrants, arc.end_x,
           arc.end_y, arc.deviation, arc.gradient_x, arc.gradient_y, static_cast<int128>(arc.half_x),
           static_cast<int128>(arc.half_y)}};
}

Plain plain_of(const FeedCommand& feed) {
  return {map::Opcode::Feed,
          0,
          feed.ticks,
          {static_cast<int128>(feed.rate), feed.floor, feed.stop_distance, feed.acceleration, feed.jerk}};
}

Plain plain_of(const DwellCommand& dwell) { return {map::Opcode::Dwell, 0, dwell.clocks, {}}; }

Plain plain_of(const EndCommand&) { return {map::Opcode::End, 0, 0, {}}; }

Command line_from(const Plain& plain) {
  LineCommand line;
  line.ticks = plain.count;
  line.mask = plain.mask;
  std::size_t next = 0;
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    if ((plain.mask >> axis & 1U) != 0) {
      line.increment[axis] = static_cast<std::int64_t>(plain.values[next++]);
    }
  }
  return line;
}

Command arc_from(const Plain& plain) {
  const auto& value = plain.values;
  const auto plane = static_cast<unsigned>(value[2]);
  ArcCommand arc;
  arc.ticks = plain.count;
  arc.path_ticks = static_cast<std::uint64_t>(value[0]);
  arc.prescale = static_cast<std::uint64_t>(value[1]);
  arc.clockwise = (plane >> kClockwiseBit & 1U) != 0;
  arc.axis_x = static_cast<std::uint8_t>(plane >> kAxisXShift & kAxisMask);
  arc.axis_y = static_cast<std::uint8_t>(plane >> kAxisYShift & kAxisMask);
  arc.quadrants = static_cast<std::uint16_t>(value[3]);
  arc.end_x = static_cast<std::int32_t>(value[4]);
  arc.end_y = static_cast<std::int32_t>(value[5]);
  arc.deviation = value[6];
  arc.gradient_x = value[7];
  arc.gradient_y = value[8];
  arc.half_x = static_cast<std::uint64_t>(value[9]);
  arc.half_y = static_cast<std::uint64_t>(value[10]);
  if (arc.axis_x == arc.axis_y || plain.mask != plane_mask(arc.axis_x, arc.axis_y)) {
    throw ArgumentError(
        fmt::format("ARC: plane of axes {} and {} under mask 0x{:02X}", arc.axis_x, arc.axis_y, plain.mask));
  }
  return arc;
}

Command feed_from(const Plain& plain) {
  const auto& value = plain.values;
  FeedCommand feed;
  feed.ticks = plain.count;
  feed.rate = static_cast<std::uint64_t>(value[0]);
  feed.floor = static_cast<std::uint32_t>(value[1]);
  feed.stop_distance = static_cast<std::uint32_t>(value[2]);
  feed.acceleration = static_cast<std::int64_t>(value[3]);
  feed.jerk = static_cast<std::int64_t>(value[4]);
  return feed;
}

Command command_from(const Plain& plain) {
  switch (plain.opcode) {
    case map::Opcode::Line:
      return line_from(plain);
    case map::Opcode::Arc:
      return arc_from(plain);
    case map::Opcode::Feed:
      return feed_from(plain);
    case map::Opcode::Dwell:
      return DwellCommand{plain.count};
    case map::Opcode::End:
      return EndCommand{};
    default:
      break;
  }
  throw ArgumentError(fmt::format("opcode {}: this driver has no such command", static_cast<unsigned>(plain.opcode)));
}

// Appends the low `halfwords` halfwords of the value, lowest first. Conversion of a negative value is mod 2^128.
void put(std::vector<std::uint16_t>& out, int128 value, std::size_t halfwords) {
  for (std::size_t i = 0; i < halfwords; ++i) {
    out.push_back(static_cast<std::uint16_t>(value >> (kHalfwordBits * i)));
  }
}

int128 get(const std::uint16_t* in, std::size_t halfwords, bool is_signed) {
  int128 value = 0;
  for (std::size_t i = halfwords; i > 0; --i) {
    value = value * (int128{1} << kHalfwordBits) + in[i - 1];
  }
  const int128 sign = int128{1} << (kHalfwordBits * halfwords - 1);
  return is_signed && value >= sign ? value - 2 * sign : value;
}

std::vector<std::uint16_t> halfwords_of(const std::uint32_t* words, std::size_t count) {
  std::vector<std::uint16_t> halfwords;
  halfwords.reserve(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    put(halfwords, words[i], 2);
  }
  return halfwords;
}

}  // namespace

void encode(const Command& command, std::uint8_t number, std::vector<std::uint32_t>& words) {
  const Plain plain = std::visit([](const auto& value) { return plain_of(value); }, command);
  const map::Command& layout = layout_of(plain.opcode);
  check(layout, plain);
  const std::uint32_t length = map::words(layout, plain.mask);
  std::vector<std::uint16_t> halfwords;
  halfwords.reserve(2 * std::size_t{length});
  put(halfwords, static_cast<unsigned>(layout.opcode) | unsigned{plain.mask} << 8, 1);
  put(halfwords, length | unsigned{number} << 8, 1);
  put(halfwords, static_cast<int128>(plain.count), kCountHalfwords);
  for_each_value(layout, plain.mask, [&](const map::Field& field, std::size_t index) {
    put(halfwords, plain.values[index], field.halfwords);
  });
  halfwords.resize(2 * std::size_t{length});
  for (std::size_t i = 0; i < halfwords.size(); i += 2) {
    words.push_back(halfwords[i] | std::uint32_t{halfwords[i + 1]} << kHalfwordBits);
  }
}

DecodedCommand decode(const std::uint32_t* words, std::size_t count) {
  if (count == 0) {
    throw ArgumentError("command: no words");
  }
  const std::vector<std::uint16_t> halfwords = halfwords_of(words, count);
  Plain plain;
  plain.opcode = static_cast<map::Opcode>(halfwords[0] & 0xFF);
  plain.mask = static_cast<std::uint8_t>(halfwords[0] >> 8);
  const map::Command& layout = layout_of(plain.opcode);
  const std::size_t length = map::words(layout, plain.mask);
  if (length != count || length != (halfwords[1] & 0xFFU)) {
    refuse(layout, fmt::format("length {} words, {} given, where {} belong", halfwords[1] & 0xFFU, count, length));
  }
  const std::uint16_t* next = &halfwords[kHeaderHalfwords];
  plain.count = static_cast<std::uint64_t>(get(next, kCountHalfwords, false));
  next += kCountHalfwords;
  for_each_value(layout, plain.mask, [&](const map::Field& field, std::size_t) {
    plain.values.push_back(get(next, field.halfwords, field.kind == map::FieldKind::Signed));
    next += field.halfwords;
  });
  check(layout, plain);
  if (next != halfwords.data() + halfwords.size() && *next != 0) {
    refuse(layout, fmt::format("padding 0x{:04X} is not 0", *next));
  }
  return {command_from(plain), static_cast<std::uint8_t>(halfwords[1] >> 8)};
}

}  // namespace trammel::driver
