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
constexpr unsigned kEightBit = 1;
constexpr unsigned kAxisXShift = 4;
constexpr unsigned kAxisYShift = 8;
constexpr unsigned kAxisMask = 7;
// Bits of the field `shifts`.
constexpr unsigned kTickShift = 8;
constexpr unsigned kShiftMask = 31;

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

constexpr const map::Command& kArcChord = layout_for(map::Opcode::ArcChord);
constexpr map::Field kChordPathTicks = field_of(kArcChord, "path_ticks");
constexpr map::Field kChordPrescale = field_of(kArcChord, "prescale");
constexpr map::Field kChordPlane = field_of(kArcChord, "plane");
constexpr map::Field kShifts = field_of(kArcChord, "shifts");
constexpr map::Field kChordX = field_of(kArcChord, "x");
constexpr map::Field kChordY = field_of(kArcChord, "y");
constexpr map::Field kFirstX = field_of(kArcChord, "first_x");
constexpr map::Field kFirstY = field_of(kArcChord, "first_y");
constexpr map::Field kClosingX = field_of(kArcChord, "closing_x");
constexpr map::Field kClosingY = field_of(kArcChord, "closing_y");
constexpr map::Field kFurther = field_of(kArcChord, "increment");

constexpr const map::Command& kFeed = layout_for(map::Opcode::Feed);
constexpr map::Field kRate = field_of(kFeed, "rate");
constexpr map::Field kFloor = field_of(kFeed, "floor");
constexpr map::Field kStopDistance = field_of(kFeed, "stop_distance");
constexpr map::Field kAcceleration = field_of(kFeed, "acceleration");
constexpr map::Field kJerk = field_of(kFeed, "jerk");

constexpr const map::Command& kDwell = layout_for(map::Opcode::Dwell);
constexpr const map::Command& kEnd = layout_for(map::Opcode::End);

constexpr const map::Command& kOutput = layout_for(map::Opcode::Output);
constexpr map::Field kSet = field_of(kOutput, "set");
constexpr map::Field kClear = field_of(kOutput, "clear");
constexpr const map::Command& kMark = layout_for(map::Opcode::Mark);
constexpr const map::Command& kWaitInput = layout_for(map::Opcode::WaitInput);
constexpr map::Field kWaitCondition = field_of(kWaitInput, "condition");
constexpr const map::Command& kProbe = layout_for(map::Opcode::Probe);
constexpr map::Field kProbeCondition = field_of(kProbe, "condition");
constexpr const map::Command& kProbeEnd = layout_for(map::Opcode::ProbeEnd);
// Bits of the field `condition`.
constexpr unsigned kInputMask = 0xF;
constexpr unsigned kLevelBit = 4;

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
    constexpr std::uint64_t kMask =
        kField.mask | kField.optional;  // whether the card has the engine is the stream's question
    const bool bits_good = kField.mask == 0 || (value & ~kMask) == 0;
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

  // The field for each axis of `mask`; the others have none.
  template <const map::Field& kField>
  void increments(const std::array<std::int64_t, map::kMaxAxes>& increment, std::uint8_t mask) {
    std::size_t offset = 0;
    for (unsigned axis = 0; axis < map::kMaxAxes; ++axis) {
      if ((std::uint32_t{mask} >> axis & 1U) != 0) {
        field<kField>(increment[axis], offset);
        offset += kField.halfwords;
      } else if (increment[axis] != 0) {
        refuse(layout_,
               fmt::format("increment {} of axis {}, which is not among 0x{:02X}", increment[axis], axis, mask));
      }
    }
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
  to.increments<kIncrement>(line.increment, line.mask);
  return to.length();
}

// Of the axes that span a plane; refuses others.
std::uint8_t plane_mask(const map::Command& layout, unsigned axis_x, unsigned axis_y) {
  if (axis_x > kAxisMask || axis_y > kAxisMask || axis_x == axis_y) {
    refuse(layout, fmt::format("plane of axes {} and {}", axis_x, axis_y));
  }
  return static_cast<std::uint8_t>(1U << axis_x | 1U << axis_y);
}

template <class Arc>
std::uint64_t plane_of(const Arc& arc) {
  return (arc.clockwise ? 1U : 0U) << kClockwiseBit | unsigned{arc.axis_x} << kAxisXShift |
         unsigned{arc.axis_y} << kAxisYShift;
}

std::size_t write(const ArcCommand& arc, std::uint8_t number, std::uint32_t* words) {
  Writer to(kArc, plane_mask(kArc, arc.axis_x, arc.axis_y), arc.ticks, number, words);
  to.field<kPathTicks>(arc.path_ticks);
  to.field<kPrescale>(arc.prescale);
  to.field<kPlane>(plane_of(arc) | (arc.eight_directions ? 1U : 0U) << kEightBit);
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

std::size_t write(const ArcChordCommand& arc, std::uint8_t number, std::uint32_t* words) {
  const std::uint8_t plane = plane_mask(kArcChord, arc.axis_x, arc.axis_y);
  if ((arc.mask & plane) != plane) {
    refuse(kArcChord,
           fmt::format("axis mask 0x{:02X} without the axes {} and {} of the plane", arc.mask, arc.axis_x, arc.axis_y));
  }
  if (arc.k > kShiftMask || arc.m > kShiftMask) refuse(kArcChord, fmt::format("shifts {} and {}", arc.k, arc.m));
  Writer to(kArcChord, arc.mask, arc.ticks, number, words);
  to.field<kChordPathTicks>(arc.path_ticks);
  to.field<kChordPrescale>(arc.prescale);
  to.field<kChordPlane>(plane_of(arc));
  to.field<kShifts>(std::uint64_t{unsigned{arc.k} | unsigned{arc.m} << kTickShift});
  to.field<kChordX>(arc.x);
  to.field<kChordY>(arc.y);
  to.field<kFirstX>(arc.first_x);
  to.field<kFirstY>(arc.first_y);
  to.field<kClosingX>(arc.closing_x);
  to.field<kClosingY>(arc.closing_y);
  to.increments<kFurther>(arc.increment, static_cast<std::uint8_t>(arc.mask & ~plane));
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

std::size_t write(const OutputCommand& output, std::uint8_t number, std::uint32_t* words) {
  Writer to(kOutput, 0, 0, number, words);
  to.field<kSet>(std::uint64_t{output.set});
  to.field<kClear>(std::uint64_t{output.clear});
  return to.length();
}

std::size_t write(const MarkCommand&, std::uint8_t number, std::uint32_t* words) {
  return Writer(kMark, 0, 0, number, words).length();
}

std::uint64_t condition_of(const map::Command& layout, std::uint8_t input, bool level) {
  if (input > kInputMask) refuse(layout, fmt::format("input {}", input));
  return std::uint64_t{input} | (level ? 1U << kLevelBit : 0);
}

std::size_t write(const WaitInputCommand& wait, std::uint8_t number, std::uint32_t* words) {
  Writer to(kWaitInput, 0, wait.timeout, number, words);
  to.field<kWaitCondition>(condition_of(kWaitInput, wait.input, wait.level));
  return to.length();
}

std::size_t write(const ProbeCommand& probe, std::uint8_t number, std::uint32_t* words) {
  Writer to(kProbe, 0, 0, number, words);
  to.field<kProbeCondition>(condition_of(kProbe, probe.input, probe.level));
  return to.length();
}

std::size_t write(const ProbeEndCommand&, std::uint8_t number, std::uint32_t* words) {
  return Writer(kProbeEnd, 0, 0, number, words).length();
}

// What a command's words say, taken as they are.
class Reader {
 public:
  explicit Reader(const std::uint32_t* words) : words_(words) {}

  std::uint64_t count() const { return get(kCountBegin, kCountHalfwords); }
  // Sign-extended from its halfwords.
  template <const map::Field& kField>
  std::int64_t signed_field(std::size_t offset = 0) const {
    constexpr unsigned kUnused = 64 - kHalfwordBits * static_cast<unsigned>(kField.halfwords);
    const auto value = static_cast<std::int64_t>(unsigned_field<kField>(offset) << kUnused);
    return value / (std::int64_t{1} << kUnused);
  }
  template <const map::Field& kField>
  std::uint64_t unsigned_field(std::size_t offset = 0) const {
    static_assert(kField.halfwords <= 4);
    return get(kPayloadBegin + kField.offset + offset, kField.halfwords);
  }
  template <const map::Field& kField>
  std::array<std::int64_t, map::kMaxAxes> increments(unsigned mask) const {
    std::array<std::int64_t, map::kMaxAxes> increment{};
    std::size_t offset = 0;
    for (unsigned axis = 0; axis < map::kMaxAxes; ++axis) {
      if ((mask >> axis & 1U) == 0) continue;
      increment[axis] = signed_field<kField>(offset);
      offset += kField.halfwords;
    }
    return increment;
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
  line.increment = from.increments<kIncrement>(mask);
  return line;
}

template <class Arc>
void set_plane(Arc& arc, std::uint64_t plane) {
  arc.clockwise = (plane >> kClockwiseBit & 1U) != 0;
  arc.axis_x = static_cast<std::uint8_t>(plane >> kAxisXShift & kAxisMask);
  arc.axis_y = static_cast<std::uint8_t>(plane >> kAxisYShift & kAxisMask);
}

Command arc_from(const Reader& from) {
  ArcCommand arc;
  arc.ticks = from.count();
  arc.path_ticks = from.unsigned_field<kPathTicks>();
  arc.prescale = from.unsigned_field<kPrescale>();
  const std::uint64_t plane = from.unsigned_field<kPlane>();
  set_plane(arc, plane);
  arc.eight_directions = (plane >> kEightBit & 1U) != 0;
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

Command arc_chord_from(const Reader& from, std::uint8_t mask) {
  const std::uint64_t shifts = from.unsigned_field<kShifts>();
  ArcChordCommand arc;
  arc.ticks = from.count();
  arc.path_ticks = from.unsigned_field<kChordPathTicks>();
  arc.prescale = from.unsigned_field<kChordPrescale>();
  arc.mask = mask;
  set_plane(arc, from.unsigned_field<kChordPlane>());
  arc.k = static_cast<std::uint8_t>(shifts & kShiftMask);
  arc.m = static_cast<std::uint8_t>(shifts >> kTickShift & kShiftMask);
  arc.x = from.signed_field<kChordX>();
  arc.y = from.signed_field<kChordY>();
  arc.first_x = from.signed_field<kFirstX>();
  arc.first_y = from.signed_field<kFirstY>();
  arc.closing_x = from.signed_field<kClosingX>();
  arc.closing_y = from.signed_field<kClosingY>();
  // Without two axes of a plane in the mask, which encode() refuses, the words do not hold so many increments.
  const unsigned plane = 1U << arc.axis_x | 1U << arc.axis_y;
  if (arc.axis_x != arc.axis_y && (mask & plane) == plane) arc.increment = from.increments<kFurther>(mask & ~plane);
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

template <const map::Field& kField>
std::uint8_t input_of(const Reader& from) {
  return static_cast<std::uint8_t>(from.unsigned_field<kField>() & kInputMask);
}

template <const map::Field& kField>
bool level_of(const Reader& from) {
  return (from.unsigned_field<kField>() >> kLevelBit & 1U) != 0;
}

OutputCommand output_from(const Reader& from) {
  return {static_cast<std::uint16_t>(from.unsigned_field<kSet>()),
          static_cast<std::uint16_t>(from.unsigned_field<kClear>())};
}

Command command_from(map::Opcode opcode, std::uint8_t mask, const Reader& from) {
  switch (opcode) {
    case map::Opcode::Line:
      return line_from(from, mask);
    case map::Opcode::Arc:
      return arc_from(from);
    case map::Opcode::ArcChord:
      return arc_chord_from(from, mask);
    case map::Opcode::Feed:
      return feed_from(from, mask);
    case map::Opcode::Dwell:
      return DwellCommand{from.count()};
    case map::Opcode::End:
      return EndCommand{};
    case map::Opcode::Output:
      return output_from(from);
    case map::Opcode::Mark:
      return MarkCommand{};
    case map::Opcode::WaitInput:
      return WaitInputCommand{input_of<kWaitCondition>(from), level_of<kWaitCondition>(from), from.count()};
    case map::Opcode::Probe:
      return ProbeCommand{input_of<kProbeCondition>(from), level_of<kProbeCondition>(from)};
    case map::Opcode::ProbeEnd:
      return ProbeEndCommand{};
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
  constexpr std::array<const map::Command*, 11> kLayouts{&kLine,   &kArc,  &kArcChord,  &kFeed,  &kDwell,   &kEnd,
                                                         &kOutput, &kMark, &kWaitInput, &kProbe, &kProbeEnd};
  static_assert(std::variant_size_v<Command> == kLayouts.size() &&
                std::is_same_v<std::variant_alternative_t<0, Command>, LineCommand> &&
                std::is_same_v<std::variant_alternative_t<1, Command>, ArcCommand> &&
                std::is_same_v<std::variant_alternative_t<2, Command>, ArcChordCommand> &&
                std::is_same_v<std::variant_alternative_t<3, Command>, FeedCommand> &&
                std::is_same_v<std::variant_alternative_t<4, Command>, DwellCommand> &&
                std::is_same_v<std::variant_alternative_t<5, Command>, EndCommand> &&
                std::is_same_v<std::variant_alternative_t<6, Command>, OutputCommand> &&
                std::is_same_v<std::variant_alternative_t<7, Command>, MarkCommand> &&
                std::is_same_v<std::variant_alternative_t<8, Command>, WaitInputCommand> &&
                std::is_same_v<std::variant_alternative_t<9, Command>, ProbeCommand> &&
                std::is_same_v<std::variant_alternative_t<10, Command>, ProbeEndCommand>);
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
