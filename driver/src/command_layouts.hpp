// The layouts of the commands that this driver knows, for encoding and decoding. Internal to the driver.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {

namespace map = card_map;

inline constexpr unsigned kHalfwordBits = 16;
inline constexpr std::size_t kCountBegin = 2;  // halfword; after mask, opcode, number and length in words
inline constexpr std::size_t kCountHalfwords = 3;
inline constexpr std::size_t kPayloadBegin = kCountBegin + kCountHalfwords;
// Bits of the field `plane`.
inline constexpr unsigned kClockwiseBit = 0;
inline constexpr unsigned kEightBit = 1;
inline constexpr unsigned kAxisXShift = 4;
inline constexpr unsigned kAxisYShift = 8;
inline constexpr unsigned kAxisMask = 7;
// Bits of the field `shifts`.
inline constexpr unsigned kTickShift = 8;
inline constexpr unsigned kShiftMask = 31;

// The layouts of the commands that this driver knows, and their fields, from the card map at compile time. An unknown
// name is a compile error.
constexpr const map::Command& layout_for(map::Opcode opcode) {
  return *map::find_command(static_cast<std::uint8_t>(opcode));
}

constexpr map::Field field_of(const map::Command& command, std::string_view name) {
  for (std::size_t i = 0; i < command.field_count; ++i) {
    if (command.fields[i].name == name) return command.fields[i];
  }
  throw std::string_view("the layout has no such field");
}

inline constexpr const map::Command& kLine = layout_for(map::Opcode::Line);
inline constexpr map::Field kIncrement = field_of(kLine, "increment");

inline constexpr const map::Command& kArc = layout_for(map::Opcode::Arc);
inline constexpr map::Field kPathTicks = field_of(kArc, "path_ticks");
inline constexpr map::Field kPrescale = field_of(kArc, "prescale");
inline constexpr map::Field kPlane = field_of(kArc, "plane");
inline constexpr map::Field kQuadrants = field_of(kArc, "quadrants");
inline constexpr map::Field kEndX = field_of(kArc, "end_x");
inline constexpr map::Field kEndY = field_of(kArc, "end_y");
inline constexpr map::Field kDeviation = field_of(kArc, "deviation");
inline constexpr map::Field kGradientX = field_of(kArc, "gradient_x");
inline constexpr map::Field kGradientY = field_of(kArc, "gradient_y");
inline constexpr map::Field kHalfX = field_of(kArc, "half_x");
inline constexpr map::Field kHalfY = field_of(kArc, "half_y");

inline constexpr const map::Command& kArcChord = layout_for(map::Opcode::ArcChord);
inline constexpr map::Field kChordPathTicks = field_of(kArcChord, "path_ticks");
inline constexpr map::Field kChordPrescale = field_of(kArcChord, "prescale");
inline constexpr map::Field kChordPlane = field_of(kArcChord, "plane");
inline constexpr map::Field kShifts = field_of(kArcChord, "shifts");
inline constexpr map::Field kChordX = field_of(kArcChord, "x");
inline constexpr map::Field kChordY = field_of(kArcChord, "y");
inline constexpr map::Field kFirstX = field_of(kArcChord, "first_x");
inline constexpr map::Field kFirstY = field_of(kArcChord, "first_y");
inline constexpr map::Field kClosingX = field_of(kArcChord, "closing_x");
inline constexpr map::Field kClosingY = field_of(kArcChord, "closing_y");
inline constexpr map::Field kFurther = field_of(kArcChord, "increment");

inline constexpr const map::Command& kFeedLayout = layout_for(map::Opcode::Feed);
inline constexpr map::Field kRate = field_of(kFeedLayout, "rate");
inline constexpr map::Field kFloor = field_of(kFeedLayout, "floor");
inline constexpr map::Field kStopDistance = field_of(kFeedLayout, "stop_distance");
inline constexpr map::Field kAcceleration = field_of(kFeedLayout, "acceleration");
inline constexpr map::Field kJerk = field_of(kFeedLayout, "jerk");

inline constexpr const map::Command& kDwell = layout_for(map::Opcode::Dwell);
inline constexpr const map::Command& kEnd = layout_for(map::Opcode::End);

inline constexpr const map::Command& kOutput = layout_for(map::Opcode::Output);
inline constexpr map::Field kSet = field_of(kOutput, "set");
inline constexpr map::Field kClear = field_of(kOutput, "clear");
inline constexpr const map::Command& kMark = layout_for(map::Opcode::Mark);
inline constexpr const map::Command& kWaitInput = layout_for(map::Opcode::WaitInput);
inline constexpr map::Field kWaitCondition = field_of(kWaitInput, "condition");
inline constexpr const map::Command& kProbeLayout = layout_for(map::Opcode::Probe);
inline constexpr map::Field kProbeCondition = field_of(kProbeLayout, "condition");
inline constexpr const map::Command& kProbeEnd = layout_for(map::Opcode::ProbeEnd);
inline constexpr const map::Command& kPwm = layout_for(map::Opcode::Pwm);
inline constexpr map::Field kPwmSelect = field_of(kPwm, "select");
inline constexpr map::Field kPwmDuty = field_of(kPwm, "duty");
inline constexpr map::Field kPwmGain = field_of(kPwm, "gain");
// Bits of the field `select`.
inline constexpr unsigned kFollowsBit = 4;
inline constexpr unsigned kPwmShift = 8;
inline constexpr unsigned kPwmShiftMask = 0x1F;
// Bits of the field `condition`.
inline constexpr unsigned kInputMask = 0x1F;
inline constexpr unsigned kLevelBit = 5;

[[noreturn]] inline void refuse(const map::Command& layout, const std::string& what) {
  throw ArgumentError(fmt::format("{}: {}", layout.name, what));
}

}  // namespace trammel::driver
