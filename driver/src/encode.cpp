// Commands to words.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

#include "command_layouts.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::driver {
namespace {

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

// Sets halfwords of words that were 0 before. One Writer per command.
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

  // Writes a field of at most 64 bits. `offset`: halfwords after the field's own position.
  template <const map::Field& kField>
  void field(std::uint64_t value, std::size_t offset = 0) {
    static_assert(kField.kind == map::FieldKind::Unsigned && kField.bits <= 64);
    constexpr std::uint64_t kBits =
        kField.bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << (kField.bits % 64)) - 1;
    constexpr std::uint64_t kMax = kField.limit != 0 ? kField.limit : kBits;
    constexpr std::uint64_t kMask = kField.mask | kField.optional;  // the stream checks the card's engines
    const bool bits_good = kField.mask == 0 || (value & ~kMask) == 0;
    if (value < kField.minimum || value > kMax || !bits_good || (kField.at_most_count && value > count_)) {
      refuse_field<kField>(layout_, value, count_);
    }
    put(kPayloadBegin + kField.offset + offset, kField.halfwords, value);
  }
  template <const map::Field& kField>
  void field(std::int64_t value, std::size_t offset = 0) {
    static_assert(kField.kind == map::FieldKind::Signed && kField.bits <= 64 && !kField.at_most_count);
    constexpr auto kHalf = static_cast<std::int64_t>(std::uint64_t{1} << (kField.bits - 1) % 63);
    constexpr std::int64_t kMax = kField.limit != 0   ? static_cast<std::int64_t>(kField.limit)
                                  : kField.bits == 64 ? std::numeric_limits<std::int64_t>::max()
                                                      : kHalf - 1;
    constexpr std::int64_t kMin = kField.limit != 0 ? -kMax : -kMax - 1;
    if (value < kMin || value > kMax) refuse_field<kField>(layout_, value, count_);
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

  // Writes the field for each axis of `mask`; other axes have none.
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
  // Writes the lowest halfword first; an even halfword is in the lower half of its word.
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

// The mask of the axes of a plane; refuses axes that span no plane.
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
  if (flags > kFeedLayout.flags_maximum) refuse(kFeedLayout, fmt::format("class {}", flags));
  const auto silent = static_cast<std::uint8_t>(feed.silent ? map::constant::kPieceSilent : 0);
  if (feed.slew_shift > kMaxSlewShift) refuse(kFeedLayout, fmt::format("slew shift {}", feed.slew_shift));
  const auto shift = static_cast<std::uint8_t>(feed.slew_shift * map::constant::kPieceDoubling);
  Writer to(kFeedLayout, flags | silent | shift, feed.ticks, number, words);
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
  Writer to(kProbeLayout, 0, 0, number, words);
  to.field<kProbeCondition>(condition_of(kProbeLayout, probe.input, probe.level));
  return to.length();
}

std::size_t write(const ProbeEndCommand&, std::uint8_t number, std::uint32_t* words) {
  return Writer(kProbeEnd, 0, 0, number, words).length();
}

std::size_t write(const PwmCommand& pwm, std::uint8_t number, std::uint32_t* words) {
  if (pwm.channel > 1) refuse(kPwm, fmt::format("channel {}", pwm.channel));
  if (pwm.shift > kPwmShiftMask) refuse(kPwm, fmt::format("shift {}", pwm.shift));
  Writer to(kPwm, 0, 0, number, words);
  to.field<kPwmSelect>(
      std::uint64_t{pwm.channel | (pwm.follows ? 1U << kFollowsBit : 0U) | unsigned{pwm.shift} << kPwmShift});
  to.field<kPwmDuty>(std::uint64_t{pwm.duty});
  to.field<kPwmGain>(std::uint64_t{pwm.gain});
  return to.length();
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

bool counts_as_begun(const Command& command) {
  return !std::holds_alternative<OutputCommand>(command) && !std::holds_alternative<MarkCommand>(command) &&
         !std::holds_alternative<ProbeCommand>(command) && !std::holds_alternative<PwmCommand>(command);
}

const card_map::Command& layout_of(const Command& command) {
  constexpr std::array<const map::Command*, 12> kLayouts{&kLine,      &kArc,         &kArcChord, &kFeedLayout,
                                                         &kDwell,     &kEnd,         &kOutput,   &kMark,
                                                         &kWaitInput, &kProbeLayout, &kProbeEnd, &kPwm};
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
                std::is_same_v<std::variant_alternative_t<10, Command>, ProbeEndCommand> &&
                std::is_same_v<std::variant_alternative_t<11, Command>, PwmCommand>);
  return *kLayouts[command.index()];
}

}  // namespace trammel::driver
