// What travels between the card's blocks (docs/developer/architecture.md, Buses): settings, and halfwords on their way
// into chains, lowest halfword first. Plain data.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::model {

// The setting bus: a value that was checked, for whoever owns the address.
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

// The roles of the card's inputs: filtered active levels. A bit of a mask is an axis.
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
  bool beyond = false;       // event, with limit: the axis has no overtravel left
  bool drive_fault = false;  // level
  bool probe = false;        // event: outside probing
  bool tool_setter = false;  // event

  bool any() const { return limit || drive_fault || probe || tool_setter; }
};

// Targets of the load bus: unit * 16 + the chain within the unit. Units 0 to 7 are the axes.
namespace load_target {
inline constexpr unsigned kChainsOfAUnit = 16;
constexpr unsigned increment(unsigned axis) { return axis * kChainsOfAUnit; }
constexpr unsigned count(unsigned axis) { return axis * kChainsOfAUnit + 1; }  // in direct mode
inline constexpr unsigned kTicks = 8 * kChainsOfAUnit;
inline constexpr unsigned kPrescale = 9 * kChainsOfAUnit;
// The deviation accumulator's.
inline constexpr unsigned kDeviation = card_map::load_unit::kAccumulator * kChainsOfAUnit;
inline constexpr unsigned kGradientX = kDeviation + 1;
inline constexpr unsigned kGradientY = kDeviation + 2;
inline constexpr unsigned kHalfX = kDeviation + 3;
inline constexpr unsigned kHalfY = kDeviation + 4;
inline constexpr unsigned kEndX = kDeviation + 5;
inline constexpr unsigned kEndY = kDeviation + 6;
inline constexpr unsigned kQuadrants = kDeviation + 7;
inline constexpr unsigned kPlane = kDeviation + 8;
// The arc generator's.
inline constexpr unsigned kChordShifts = card_map::load_unit::kArcGenerator * kChainsOfAUnit;
inline constexpr unsigned kChordState = kChordShifts + 1;    // X, then Y
inline constexpr unsigned kChordClosing = kChordShifts + 2;  // of x, then of y
inline constexpr unsigned kChordPlane = kChordShifts + 8;
inline constexpr unsigned kCommand =
    card_map::load_unit::kPathCommands * kChainsOfAUnit;  // fields of commands that are no paths
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

// A chain of `Bits` bits (a multiple of 16, at most 64) takes a halfword at its top.
template <unsigned Bits>
void shift_in(std::uint64_t& chain, std::uint16_t word) {
  chain = chain >> 16 | std::uint64_t{word} << (Bits - 16);
}

}  // namespace trammel::model
