// Golden model of the scan of roles, rtl/io/role_scan.sv. A role is active while at least one of the inputs in its
// mask is active. The scan looks at one of 64 roles per clock, with the mask of two clocks before. Not thread-safe;
// no errors are reported.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/model/buses.hpp"

namespace trammel::model {

class RoleScan {
 public:
  static constexpr unsigned kRoles = 64;  // 8 * kind + axis; a scan takes as many clocks
  // After this many clocks with constant levels and masks nothing changes: each role was looked at with its mask.
  static constexpr unsigned kSettled = kRoles + 2;
  // The kinds of role that exist per axis, and the card's own roles.
  static constexpr unsigned kLimitMinus = 0, kLimitPlus = 1, kDriveFault = 4;
  static constexpr unsigned kProbe = 48, kToolSetter = 49, kFeedHold = 50, kCycleStart = 51;

  struct Inputs {
    std::uint32_t levels = 0;    // bit n: input n, filtered
    bool set = false;            // never within kRoles clocks after a reset
    unsigned set_role = 0;       // 0 to 63
    std::uint32_t set_mask = 0;  // inputs of the card, a bit each
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    unsigned clock = 0;  // clock of the scan, 0 to 63
    bool clearing = true;
    InputRoles roles;
    std::array<std::uint32_t, kRoles> masks{};
    std::array<std::uint32_t, 2> mask_read{};  // mask at the RAM's output, and in the register behind it
    // Clocks since the levels or a mask changed, up to kSettled. Derived from the other state.
    std::uint32_t last_levels = 0;
    unsigned same = 0;
  };

  explicit RoleScan(unsigned axes) : axes_(axes) {}

  // One rising edge.
  void clock(const Inputs& in) {
    const bool same = in.levels == state_.last_levels && !in.set && !state_.clearing;
    state_.same = !same ? 0 : state_.same == kSettled ? kSettled : state_.same + 1;
    state_.last_levels = in.levels;
    const unsigned scanned = (state_.clock + kRoles - 2) % kRoles;
    look(scanned, !state_.clearing && (in.levels & state_.mask_read[1]) != 0);
    state_.mask_read = {state_.masks[state_.clock], state_.mask_read[0]};
    if (state_.clearing) {
      state_.masks[scanned] = 0;
    } else if (in.set) {
      state_.masks[in.set_role] = in.set_mask;
    }
    if (state_.clock == kRoles - 1) state_.clearing = false;
    state_.clock = (state_.clock + 1) % kRoles;
  }

  // True if levels, masks and roles do not change with these inputs.
  bool settled(const Inputs& in) const { return state_.same == kSettled && !in.set && in.levels == state_.last_levels; }
  const InputRoles& roles() const { return state_.roles; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  void look(unsigned role, bool active) {
    const unsigned axis = role % 8;
    switch (role) {
      case kProbe:
        state_.roles.probe = active;
        return;
      case kToolSetter:
        state_.roles.tool_setter = active;
        return;
      case kFeedHold:
        state_.roles.feed_hold = active;
        return;
      case kCycleStart:
        state_.roles.cycle_start = active;
        return;
      default:
        break;
    }
    if (axis >= axes_) return;
    const auto put = [&](std::uint8_t& mask) {
      mask = static_cast<std::uint8_t>((mask & ~(1U << axis)) | (active ? 1U << axis : 0U));
    };
    if (role / 8 == kLimitMinus) put(state_.roles.limit_minus);
    if (role / 8 == kLimitPlus) put(state_.roles.limit_plus);
    if (role / 8 == kDriveFault) put(state_.roles.drive_fault);
  }

  unsigned axes_;
  State state_;
};

}  // namespace trammel::model
