// Roles of a card's inputs: what an input is for. An input may have several roles, a role several inputs. Plain data
// and pure functions, thread-safe.
#pragma once

#include <cstdint>
#include <string>

namespace trammel::driver {

// Of these each axis has one.
enum class AxisRole : std::uint8_t { kLimitMinus, kLimitPlus, kHome, kIndex, kDriveFault, kInPosition };
inline constexpr unsigned kAxisRoles = 6;
// And of these the card has one.
enum class CardRole : std::uint8_t { kProbe = 48, kToolSetter, kFeedHold, kCycleStart, kSpindleAtSpeed };

// A role as the card numbers it (register ROLE), 0 to 63.
class Role {
 public:
  // `axis`: 0 to 7.
  constexpr Role(AxisRole kind, unsigned axis) : number_(static_cast<unsigned>(kind) * 8 + axis % 8) {}
  constexpr Role(CardRole role) : number_(static_cast<unsigned>(role)) {}  // NOLINT: a card's role is a role

  constexpr unsigned number() const { return number_; }
  constexpr bool of_an_axis() const { return number_ < kAxisRoles * 8; }
  constexpr unsigned axis() const { return number_ % 8; }  // of a role of an axis
  friend constexpr bool operator==(Role a, Role b) { return a.number_ == b.number_; }

 private:
  unsigned number_;
};

// "limit minus of axis 0", "feed hold".
std::string role_name(Role role);

// Roles that are active now, as the card sees them; bit n: axis n.
struct ActiveRoles {
  std::uint8_t limit_minus = 0;
  std::uint8_t limit_plus = 0;
  std::uint8_t drive_fault = 0;
  bool feed_hold = false;
  bool cycle_start = false;
  bool tool_setter = false;
  bool probe = false;
};

// Which limits and drives brought the fault that stands; bit n: axis n.
struct LimitState {
  std::uint8_t minus = 0;
  std::uint8_t plus = 0;
  std::uint8_t drive_fault = 0;
  // With FAULT.soft_limit: the axis that brought it, and whether at its positive end.
  std::uint8_t soft_axis = 0;
  bool soft_plus = false;
};

// Soft limits of an axis: the positions that it may go to, ends included, in pulses as the card counts them (modulo
// 2^32).
struct SoftRange {
  std::int32_t minus = 0;
  std::int32_t plus = 0;

  // Pulses; negative where it is no range.
  std::int32_t length() const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(plus) - static_cast<std::uint32_t>(minus));
  }
};

// How inputs stop the card. Bits of masks are axes.
struct InputStops {
  std::uint8_t any_step = 0;  // while a limit of any of these is active, every step of them is one into it (CoreXY)
  std::uint8_t shared = 0;    // one switch serves both ends
  bool probe = false;         // the probe outside probing stops the card
  bool tool_setter = false;   // the tool setter does
  // On a ramp; else at once.
  bool limit_ramps = false;
  bool drive_fault_ramps = true;
  bool probe_ramps = true;
  bool tool_setter_ramps = true;
};

}  // namespace trammel::driver
