// Roles of a card's inputs. A role is the function of an input; an input may have several roles, a role several inputs.
// Plain data and pure functions, thread-safe.
#pragma once

#include <cstdint>
#include <string>

namespace trammel::driver {

// Roles that exist once per axis.
enum class AxisRole : std::uint8_t { kLimitMinus, kLimitPlus, kHome, kIndex, kDriveFault, kInPosition };
inline constexpr unsigned kAxisRoles = 6;
// Roles that exist once per card.
enum class CardRole : std::uint8_t { kProbe = 48, kToolSetter, kFeedHold, kCycleStart, kSpindleAtSpeed };

// A role by its number in the card (register ROLE), 0 to 63.
class Role {
 public:
  // `axis`: 0 to 7.
  constexpr Role(AxisRole kind, unsigned axis) : number_(static_cast<unsigned>(kind) * 8 + axis % 8) {}
  constexpr Role(CardRole role) : number_(static_cast<unsigned>(role)) {}  // NOLINT: a card's role is a role

  constexpr unsigned number() const { return number_; }
  constexpr bool of_an_axis() const { return number_ < kAxisRoles * 8; }
  constexpr unsigned axis() const { return number_ % 8; }  // meaningful if of_an_axis()
  friend constexpr bool operator==(Role a, Role b) { return a.number_ == b.number_; }

 private:
  unsigned number_;
};

// "limit minus of axis 0", "feed hold".
std::string role_name(Role role);

// Roles that are active now, as reported by the card; bit n: axis n.
struct ActiveRoles {
  std::uint8_t limit_minus = 0;
  std::uint8_t limit_plus = 0;
  std::uint8_t drive_fault = 0;
  bool feed_hold = false;
  bool cycle_start = false;
  bool tool_setter = false;
  bool probe = false;
};

// Limits and drives that caused the present fault; bit n: axis n.
struct LimitState {
  std::uint8_t minus = 0;
  std::uint8_t plus = 0;
  std::uint8_t drive_fault = 0;
  // With FAULT.soft_limit: the axis that caused it, and whether at its positive end.
  std::uint8_t soft_axis = 0;
  bool soft_plus = false;
};

// Soft limits of an axis: the allowed positions, ends included, in pulses as the card counts them (modulo 2^32).
struct SoftRange {
  std::int32_t minus = 0;
  std::int32_t plus = 0;

  // Pulses; negative if `plus` is below `minus`.
  std::int32_t length() const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(plus) - static_cast<std::uint32_t>(minus));
  }
};

// Stops by inputs. Bits of masks are axes.
struct InputStops {
  // CoreXY: while a limit of any of these axes is active, every step of each of them counts as one into the limit.
  std::uint8_t any_step = 0;
  std::uint8_t shared = 0;   // bit n: one switch serves both ends of axis n
  bool probe = false;        // an edge of the probe outside probing stops the card
  bool tool_setter = false;  // the tool setter stops the card
  // Reactions: true stops on a ramp, false at once.
  bool limit_ramps = false;
  bool drive_fault_ramps = true;
  bool probe_ramps = true;
  bool tool_setter_ramps = true;
};

}  // namespace trammel::driver
