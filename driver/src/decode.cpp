// Words to commands.
#include <fmt/format.h>

#include <algorithm>

#include "command_layouts.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::driver {
namespace {

// Reads the fields of a command's words, without checks.
class Reader {
 public:
  explicit Reader(const std::uint32_t* words) : words_(words) {}

  std::uint64_t count() const { return get(kCountBegin, kCountHalfwords); }
  // The field's value, sign-extended from its halfwords.
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
  // With fewer than two axes of a plane in the mask, which encode() refuses, the words do not contain this many
  // increments.
  const unsigned plane = 1U << arc.axis_x | 1U << arc.axis_y;
  if (arc.axis_x != arc.axis_y && (mask & plane) == plane) arc.increment = from.increments<kFurther>(mask & ~plane);
  return arc;
}

Command feed_from(const Reader& from, std::uint8_t flags) {
  FeedCommand feed;
  feed.silent = (flags & map::constant::kPieceSilent) != 0;
  feed.slew_shift = static_cast<std::uint8_t>(flags / map::constant::kPieceDoubling);
  feed.piece_class = static_cast<PieceClass>(flags % map::constant::kPieceSilent);
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

PwmCommand pwm_from(const Reader& from) {
  const auto select = static_cast<unsigned>(from.unsigned_field<kPwmSelect>());
  PwmCommand pwm;
  pwm.channel = static_cast<std::uint8_t>(select & 1U);
  pwm.follows = (select >> kFollowsBit & 1U) != 0;
  pwm.shift = static_cast<std::uint8_t>(select >> kPwmShift & kPwmShiftMask);
  pwm.duty = static_cast<std::uint16_t>(from.unsigned_field<kPwmDuty>());
  pwm.gain = static_cast<std::uint16_t>(from.unsigned_field<kPwmGain>());
  return pwm;
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
    case map::Opcode::Pwm:
      return pwm_from(from);
    default:
      break;
  }
  throw ArgumentError(fmt::format("opcode {}: this driver has no such command", static_cast<unsigned>(opcode)));
}

}  // namespace

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
  // Refuses all words that encode() cannot produce: encode() checks ranges, the comparison checks mask, padding and
  // sign bits.
  std::array<std::uint32_t, kMaxCommandWords> again{};
  if (encode(decoded.command, number, again.data()) != count || !std::equal(words, words + count, again.begin())) {
    refuse(*layout, "its mask, its padding or the upper bits of a field are not as its values ask for");
  }
  return decoded;
}

}  // namespace trammel::driver
