// Plain data on the buses between the card's blocks (docs/developer/architecture.md, Buses): settings, and halfwords
// on their way into shift chains, lowest halfword first.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::model {

// The setting bus: a checked register write, sent to all blocks. The block that owns the address takes it.
struct Setting {
  bool set = false;
  std::uint32_t address = 0;  // bytes
  std::uint32_t data = 0;
};

// A halfword on the load bus or the feed load, and the chain that shifts it in.
struct LoadWord {
  bool valid = false;
  std::uint16_t target = 0;
  std::uint16_t word = 0;

  bool to(unsigned chain) const { return valid && target == chain; }
};

// The roles of the card's inputs, as filtered active levels. Bit n of a mask belongs to axis n.
struct InputRoles {
  std::uint8_t limit_minus = 0;
  std::uint8_t limit_plus = 0;
  std::uint8_t drive_fault = 0;
  bool feed_hold = false;
  bool cycle_start = false;
  bool tool_setter = false;
  bool probe = false;
};

// Causes of a stop that come from the machine's inputs.
struct StopCauses {
  bool limit = false;        // event: a step into an active limit
  bool beyond = false;       // event, only together with limit: the axis has no overtravel left
  bool drive_fault = false;  // level
  bool probe = false;        // event: the probe trips outside probing
  bool tool_setter = false;  // event

  bool any() const { return limit || drive_fault || probe || tool_setter; }
};

// Targets of the load bus: unit * 16 + the chain within the unit. Units 0 to 7 are the axes.
namespace load_target {
inline constexpr unsigned kChainsOfAUnit = 16;
constexpr unsigned increment(unsigned axis) { return axis * kChainsOfAUnit; }
constexpr unsigned count(unsigned axis) { return axis * kChainsOfAUnit + 1; }  // direct mode only
inline constexpr unsigned kTicks = 8 * kChainsOfAUnit;
inline constexpr unsigned kPrescale = 9 * kChainsOfAUnit;
// Chains of the deviation accumulator.
inline constexpr unsigned kDeviation = card_map::load_unit::kAccumulator * kChainsOfAUnit;
inline constexpr unsigned kGradientX = kDeviation + 1;
inline constexpr unsigned kGradientY = kDeviation + 2;
inline constexpr unsigned kHalfX = kDeviation + 3;
inline constexpr unsigned kHalfY = kDeviation + 4;
inline constexpr unsigned kEndX = kDeviation + 5;
inline constexpr unsigned kEndY = kDeviation + 6;
inline constexpr unsigned kQuadrants = kDeviation + 7;
inline constexpr unsigned kPlane = kDeviation + 8;
// Chains of the arc generator.
inline constexpr unsigned kChordShifts = card_map::load_unit::kArcGenerator * kChainsOfAUnit;
inline constexpr unsigned kChordState = kChordShifts + 1;    // x, then y
inline constexpr unsigned kChordClosing = kChordShifts + 2;  // closing increments: x, then y
inline constexpr unsigned kChordPlane = kChordShifts + 8;
inline constexpr unsigned kCommand =
    card_map::load_unit::kPathCommands * kChainsOfAUnit;  // fields of commands that are not paths
inline constexpr unsigned kNowhere = card_map::load_unit::kNone * kChainsOfAUnit + 15;
}  // namespace load_target

// Targets of the feed load.
namespace feed_target {
inline constexpr unsigned kTicks = 0;
inline constexpr unsigned kRate = 1;
inline constexpr unsigned kFloor = 2;
inline constexpr unsigned kStopDistance = 3;
inline constexpr unsigned kAcceleration = 4;
inline constexpr unsigned kJerk = 5;
inline constexpr unsigned kNowhere = 6;
}  // namespace feed_target

// Shifts a halfword in at the top of a chain of `Bits` bits (a multiple of 16, at most 64).
template <unsigned Bits>
void shift_in(std::uint64_t& chain, std::uint16_t word) {
  chain = chain >> 16 | std::uint64_t{word} << (Bits - 16);
}

}  // namespace trammel::model
