#include "trammel/driver/commands.hpp"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;

constexpr unsigned kHalfwordBits = 16;
constexpr std::size_t kCountBegin = 2;  // halfword; before it axis mask and opcode, number and length in words
constexpr std::size_t kCountHalfwords = 3;
constexpr std::size_t kPayloadBegin = kCountBegin + kCountHalfwords;
// Bits of the field `plane`.
constexpr unsigned kClockwiseBit = 0;
constexpr unsigned kAxisXShift = 4;
constexpr unsigned kAxisYShift = 8;
constexpr unsigned kAxisMask = 7;

// The layouts of the commands that this driver knows, and their fields, from the card map at compile time: a name that
// is not there does not compile.
constexpr const map::Command& layout_for(map::Opcode opcode) {
  return *map::find_command(static_cast<std::uint8_t>(opcode));
}

constexpr map::Field field_of(const map::Command& command, std::string_view name) {
  for (std::size_t i = 0; i < command.field_count; ++i) {
    if (command.fields[i].name == name) return command.fields[i];
  }
  throw std::string_view("the layout has no such field");
}

constexpr const map::Command& kLine = layout_for(map::Opcode::Line);
constexpr map::Field kIncrement = field_of(kLine, "increment");

constexpr const map::Command& kArc = layout_for(map::Opcode::Arc);
constexpr map::Field kPathTicks = field_of(kArc, "path_ticks");
constexpr map::Field kPrescale = field_of(kArc, "prescale");
constexpr map::Field kPlane = field_of(kArc, "plane");
constexpr map::Field kQuadrants = field_of(kArc, "quadrants");
constexpr map::Field kEndX = field_of(kArc, "end_x");
constexpr map::Field kEndY = field_of(kArc, "end_y");
constexpr map::Field kDeviation = field_of(kArc, "deviation");
constexpr map::Field kGradientX = field_of(kArc, "gradient_x");
constexpr map::Field kGradientY = field_of(kArc, "gradient_y");
constexpr map::Field kHalfX = field_of(kArc, "half_x");
constexpr map::Field kHalfY = field_of(kArc, "half_y");

constexpr const map::Command& kFeed = layout_for(map::Opcode::Feed);
constexpr map::Field kRate = field_of(kFeed, "rate");
constexpr map::Field kFloor = field_of(kFeed, "floor");
constexpr map::Field kStopDistance = field_of(kFeed, "stop_distance");
constexpr map::Field kAcceleration = field_of(kFeed, "acceleration");
constexpr map::Field kJerk = field_of(kFeed, "jerk");

constexpr const map::Command& kDwell = layout_for(map::Opcode::Dwell);
constexpr const map::Command& kEnd = layout_for(map::Opcode::End);

[[noreturn]] void refuse(const map::Command& layout, const std::string& what) {
  throw ArgumentError(fmt::format("{}: {}", layout.name, what));
}

std::string text_of(std::uint64_t value) { return fmt::format("{}", value); }
std::string text_of(std::int64_t value) { return fmt::format("{}", value); }
std::string text_of(const Int128& value) {
  return fmt::format("0x{:X}{:016X}", static_cast<std::uint64_t>(value.high()), value.low());
}

template <const map::Field& kField, class Value>
[[noreturn]] void refuse_field(const map::Command& layout, Value value, std::uint64_t count) {
  refuse(layout, fmt::format("{} = {} is out of its range ({} bits, count {})", kField.name, text_of(value),
                             kField.bits, count));
}

// Sets halfwords of words that were 0 before. One Writer a command.
class Writer {
 public:
  Writer(const map::Command& layout, std::uint8_t mask, std::uint64_t count, std::uint8_t number, std::uint32_t* words)
      : layout_(layout), words_(words), count_(count), length_(map::words(layout, mask)) {
    if (count < layout.count_minimum || count > layout.count_maximum) {
      refuse(layout, fmt::format("count {} is outside {} .. {}", count, layout.count_minimum, layout.count_maximum));
    }
    std::fill(words, words + length_, 0U);
    words_[0] = static_cast<unsigned>(layout.opcode) | std::uint32_t{mask} << 8 | length_ << kHalfwordBits |
                std::uint32_t{number} << 24;
    put(kCountBegin, kCountHalfwords, count);
  }

  // A field with 64 bits or fewer; `offset`: halfwords beyond the field's own place.
  template <const map::Field& kField>
  void field(std::uint64_t value, std::size_t offset = 0) {
    static_assert(kField.kind == map::FieldKind::Unsigned && kField.bits <= 64);
    constexpr std::uint64_t kBits =
        kField.bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << (kField.bits % 64)) - 1;
    constexpr std::uint64_t kMost = kField.limit != 0 ? kField.limit : kBits;
    const bool bits_good = kField.mask == 0 || (value & ~std::uint64_t{kField.mask}) == 0;
    if (value < kField.minimum || value > kMost || !bits_good || (kField.at_most_count && value > count_)) {
      refuse_field<kField>(layout_, value, count_);
    }
    put(kPayloadBegin + kField.offset + offset, kField.halfwords, value);
  }
  template <const map::Field& kField>
  void field(std::int64_t value, std::size_t offset = 0) {
    static_assert(kField.kind == map::FieldKind::Signed && kField.bits <= 64 && !kField.at_most_count);
    constexpr auto kHalf = static_cast<std::int64_t>(std::uint64_t{1} << (kField.bits - 1) % 63);
    constexpr std::int64_t kMost = kField.limit != 0   ? static_cast<std::int64_t>(kField.limit)
                                   : kField.bits == 64 ? std::numeric_limits<std::int64_t>::max()
                                                       : kHalf - 1;
    constexpr std::int64_t kLeast = kField.limit != 0 ? -kMost : -kMost - 1;
    if (value < kLeast || value > kMost) refuse_field<kField>(layout_, value, count_);
    put(kPayloadBegin + kField.offset + offset, kField.halfwords, static_cast<std::uint64_t>(value));
  }
  template <const map::Field& kField>
  void field(const Int128& value) {
    static_assert(kField.kind == map::FieldKind::Signed && kField.bits > 64 && kField.bits < 128 && kField.limit == 0);
    constexpr std::int64_t kHalf = std::int64_t{1} << (kField.bits - 64 - 1);
    if (value.high() < -kHalf || value.high() >= kHalf) refuse_field<kField>(layout_, value, count_);
    put(kPayloadBegin + kField.offset, 4, value.low());
    put(kPayloadBegin + kField.offset + 4, kField.halfwords - 4, static_cast<std::uint64_t>(value.high()));
  }

  std::size_t length() const { return length_; }

 private:
  // Lowest halfword first, at the even halfword in a word's lower half.
  void put(std::size_t at, std::size_t halfwords, std::uint64_t value) {
    for (std::size_t i = at; i < at + halfwords; ++i, value >>= kHalfwordBits) {
      words_[i / 2] |= static_cast<std::uint32_t>(value & 0xFFFF) << (i % 2 != 0 ? kHalfwordBits : 0);
    }
  }

  const map::Command& layout_;
  std::uint32_t* words_;
  std::uint64_t count_;
  std::uint32_t length_;
};

std::size_t write(const LineCommand& line, std::uint8_t number, std::uint32_t* words) {
  if (line.mask == 0) refuse(kLine, "axis mask 0x00");
  Writer to(kLine, line.mask, line.ticks, number, words);
  std::size_t offset = 0;
  for (unsigned axis = 0; axis < map::kMaxAxes; ++axis) {
    if ((line.mask >> axis & 1U) != 0) {
      to.field<kIncrement>(line.increment[axis], offset);
      offset += kIncrement.halfwords;
    } else if (line.increment[axis] != 0) {
      refuse(kLine, fmt::format("increment {} of axis {}, which is not in the mask 0x{:02X}", line.increment[axis],
                                axis, line.mask));
    }
  }
  return to.length();
}

std::uint8_t plane_mask(unsigned axis_x, unsigned axis_y) {
  return static_cast<std::uint8_t>(1U << axis_x | 1U << axis_y);
}

std::size_t write(const ArcCommand& arc, std::uint8_t number, std::uint32_t* words) {
  if (arc.axis_x > kAxisMask || arc.axis_y > kAxisMask || arc.axis_x == arc.axis_y) {
    refuse(kArc, fmt::format("plane of axes {} and {}", arc.axis_x, arc.axis_y));
  }
  Writer to(kArc, plane_mask(arc.axis_x, arc.axis_y), arc.ticks, number, words);
  to.field<kPathTicks>(arc.path_ticks);
  to.field<kPrescale>(arc.prescale);
  to.field<kPlane>(std::uint64_t{(arc.clockwise ? 1U : 0U) << kClockwiseBit | unsigned{arc.axis_x} << kAxisXShift |
                                 unsigned{arc.axis_y} << kAxisYShift});
  to.field<kQuadrants>(std::uint64_t{arc.quadrants});
  to.field<kEndX>(std::int64_t{arc.end_x});
  to.field<kEndY>(std::int64_t{arc.end_y});
  to.field<kDeviation>(arc.deviation);
  to.field<kGradientX>(arc.gradient_x);
  to.field<kGradientY>(arc.gradient_y);
  to.field<kHalfX>(arc.half_x);
  to.field<kHalfY>(arc.half_y);
  return to.length();
}

std::size_t write(const FeedCommand& feed, std::uint8_t number, std::uint32_t* words) {
  const auto flags = static_cast<std::uint8_t>(feed.piece_class);
  if (flags > kFeed.flags_maximum) refuse(kFeed, fmt::format("class {}", flags));
  Writer to(kFeed, flags, feed.ticks, number, words);
  to.field<kRate>(feed.rate);
  to.field<kFloor>(std::uint64_t{feed.floor});
  to.field<kStopDistance>(std::uint64_t{feed.stop_distance});
  to.field<kAcceleration>(feed.acceleration);
  to.field<kJerk>(feed.jerk);
  return to.length();
}

std::size_t write(const DwellCommand& dwell, std::uint8_t number, std::uint32_t* words) {
  return Writer(kDwell, 0, dwell.clocks, number, words).length();
}

std::size_t write(const EndCommand&, std::uint8_t number, std::uint32_t* words) {
  return Writer(kEnd, 0, 0, number, words).length();
}

// What a command's words say, taken as they are.
class Reader {
 public:
  explicit Reader(const std::uint32_t* words) : words_(words) {}

  std::uint64_t count() const { return get(kCountBegin, kCountHalfwords); }
  // Sign-extended from its halfwords.
  template <const map::Field& kField>
  std::int64_t signed_field(std::size_t offset = 0) const {
    const unsigned unused = 64 - kHalfwordBits * static_cast<unsigned>(kField.halfwords);
    return static_cast<std::int64_t>(unsigned_field<kField>(offset) << unused) / (std::int64_t{1} << unused);
  }
  template <const map::Field& kField>
  std::uint64_t unsigned_field(std::size_t offset = 0) const {
    static_assert(kField.halfwords <= 4);
    return get(kPayloadBegin + kField.offset + offset, kField.halfwords);
  }
  template <const map::Field& kField>
  Int128 wide_field() const {
    static_assert(kField.halfwords == 5);
    const auto high = static_cast<std::int16_t>(get(kPayloadBegin + kField.offset + 4, 1));
    const std::uint64_t low = get(kPayloadBegin + kField.offset, 4);
    return Int128(Uint128(static_cast<std::uint64_t>(std::int64_t{high}), low));
  }

 private:
  std::uint64_t get(std::size_t at, std::size_t halfwords) const {
    std::uint64_t value = 0;
    for (std::size_t i = at + halfwords; i-- > at;) {
      value = value << kHalfwordBits | (words_[i / 2] >> (i % 2 != 0 ? kHalfwordBits : 0) & 0xFFFF);
    }
    return value;
  }

  const std::uint32_t* words_;
};

Command line_from(const Reader& from, std::uint8_t mask) {
  LineCommand line;
  line.ticks = from.count();
  line.mask = mask;
  std::size_t offset = 0;
  for (unsigned axis = 0; axis < map::kMaxAxes; ++axis) {
    if ((mask >> axis & 1U) == 0) continue;
    line.increment[axis] = from.signed_field<kIncrement>(offset);
    offset += kIncrement.halfwords;
  }
  return line;
}

Command arc_from(const Reader& from) {
  const std::uint64_t plane = from.unsigned_field<kPlane>();
  ArcCommand arc;
  arc.ticks = from.count();
  arc.path_ticks = from.unsigned_field<kPathTicks>();
  arc.prescale = from.unsigned_field<kPrescale>();
  arc.clockwise = (plane >> kClockwiseBit & 1U) != 0;
  arc.axis_x = static_cast<std::uint8_t>(plane >> kAxisXShift & kAxisMask);
  arc.axis_y = static_cast<std::uint8_t>(plane >> kAxisYShift & kAxisMask);
  arc.quadrants = static_cast<std::uint16_t>(from.unsigned_field<kQuadrants>());
  arc.end_x = static_cast<std::int32_t>(from.signed_field<kEndX>());
  arc.end_y = static_cast<std::int32_t>(from.signed_field<kEndY>());
  arc.deviation = from.wide_field<kDeviation>();
  arc.gradient_x = from.wide_field<kGradientX>();
  arc.gradient_y = from.wide_field<kGradientY>();
  arc.half_x = from.unsigned_field<kHalfX>();
  arc.half_y = from.unsigned_field<kHalfY>();
  return arc;
}

Command feed_from(const Reader& from, std::uint8_t flags) {
  FeedCommand feed;
  feed.piece_class = static_cast<PieceClass>(flags);
  feed.ticks = from.count();
  feed.rate = from.unsigned_field<kRate>();
  feed.floor = static_cast<std::uint32_t>(from.unsigned_field<kFloor>());
  feed.stop_distance = static_cast<std::uint32_t>(from.unsigned_field<kStopDistance>());
  feed.acceleration = from.signed_field<kAcceleration>();
  feed.jerk = from.signed_field<kJerk>();
  return feed;
}

Command command_from(map::Opcode opcode, std::uint8_t mask, const Reader& from) {
  switch (opcode) {
    case map::Opcode::Line:
      return line_from(from, mask);
    case map::Opcode::Arc:
      return arc_from(from);
    case map::Opcode::Feed:
      return feed_from(from, mask);
    case map::Opcode::Dwell:
      return DwellCommand{from.count()};
    case map::Opcode::End:
      return EndCommand{};
    default:
      break;
  }
  throw ArgumentError(fmt::format("opcode {}: this driver has no such command", static_cast<unsigned>(opcode)));
}

}  // namespace

std::size_t encode(const Command& command, std::uint8_t number, std::uint32_t* words) {
  return std::visit([&](const auto& kind) { return write(kind, number, words); }, command);
}

void encode(const Command& command, std::uint8_t number, std::vector<std::uint32_t>& words) {
  std::array<std::uint32_t, kMaxCommandWords> encoded{};
  const std::size_t count = encode(command, number, encoded.data());
  words.insert(words.end(), encoded.data(), encoded.data() + count);
}

const card_map::Command& layout_of(const Command& command) {
  constexpr std::array<const map::Command*, 5> kLayouts{&kLine, &kArc, &kFeed, &kDwell, &kEnd};
  static_assert(std::variant_size_v<Command> == kLayouts.size() &&
                std::is_same_v<std::variant_alternative_t<0, Command>, LineCommand> &&
                std::is_same_v<std::variant_alternative_t<1, Command>, ArcCommand> &&
                std::is_same_v<std::variant_alternative_t<2, Command>, FeedCommand> &&
                std::is_same_v<std::variant_alternative_t<3, Command>, DwellCommand> &&
                std::is_same_v<std::variant_alternative_t<4, Command>, EndCommand>);
  return *kLayouts[command.index()];
}

DecodedCommand decode(const std::uint32_t* words, std::size_t count) {
  if (count == 0) throw ArgumentError("command: no words");
  const auto opcode = static_cast<std::uint8_t>(words[0]);
  const auto mask = static_cast<std::uint8_t>(words[0] >> 8);
  const auto number = static_cast<std::uint8_t>(words[0] >> 24);
  const map::Command* layout = map::find_command(opcode);
  if (layout == nullptr) throw ArgumentError(fmt::format("opcode {} has no layout", opcode));
  const std::size_t length = map::words(*layout, mask);
  const std::uint32_t given = words[0] >> kHalfwordBits & 0xFF;
  if (length != count || length != given) {
    refuse(*layout, fmt::format("length {} words, {} given, where {} belong", given, count, length));
  }
  DecodedCommand decoded{command_from(layout->opcode, mask, Reader(words)), number};
  // Whatever encode() would not have made is refused: ranges by itself, mask, padding and sign bits by the comparison.
  std::array<std::uint32_t, kMaxCommandWords> again{};
  if (encode(decoded.command, number, again.data()) != count || !std::equal(words, words + count, again.begin())) {
    refuse(*layout, "its mask, its padding or the upper bits of a field are not as its values ask for");
  }
  return decoded;
}

}  // namespace trammel::driver
