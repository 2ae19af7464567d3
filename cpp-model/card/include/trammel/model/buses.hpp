// What travels between the card's blocks (docs/developer/architecture.md, Buses): settings, and halfwords on their way
// into chains, lowest halfword first. Plain data.
#pragma once

#include <cstdint>

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
  std::uint8_t target = 0;
  std::uint16_t word = 0;

  bool to(unsigned chain) const { return valid && target == chain; }
};

// Targets of the load bus.
namespace load_target {
inline constexpr unsigned kIncrement = 0;  // of axis n: kIncrement + n
inline constexpr unsigned kCount = 8;      // of axis n in direct mode: kCount + n
inline constexpr unsigned kTicks = 16;
inline constexpr unsigned kPrescale = 17;
inline constexpr unsigned kDeviation = 18;
inline constexpr unsigned kGradientX = 19;
inline constexpr unsigned kGradientY = 20;
inline constexpr unsigned kHalfX = 21;
inline constexpr unsigned kHalfY = 22;
inline constexpr unsigned kEndX = 23;
inline constexpr unsigned kEndY = 24;
inline constexpr unsigned kQuadrants = 25;
inline constexpr unsigned kPlane = 26;
// The arc generator's.
inline constexpr unsigned kShifts = 27;
inline constexpr unsigned kState = 28;    // X, then Y
inline constexpr unsigned kClosing = 29;  // of x, then of y
inline constexpr unsigned kCommand = 30;  // fields of commands that are no paths
inline constexpr unsigned kNowhere = 31;
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
