// Golden model of the limit check: what the machine's inputs say about stops. A step into an active limit, a drive's
// fault, the probe outside probing and the tool setter are causes; the stop control decides what they do.
//
// What comes in clock c is a cause in c+1, and is in FAULT and LIMIT_STATE at c+2. Not thread-safe; no errors are
// reported.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class LimitCheck {
 public:
  static constexpr unsigned kMaxAxes = 8;

  struct Inputs {
    InputRoles roles;
    std::uint8_t step = 0;  // steps on the path, a bit an axis
    std::uint8_t dir = 0;   // of each axis's last one: 1 backwards
    bool runs = false;      // a path or a direct move is under way
    bool probing = false;
    bool stopping = false;    // a fault's ramp
    std::uint32_t clear = 0;  // event: ones written to FAULT
    Setting setting;          // STOP_CAUSES, LIMIT_OVERRIDE, OVERTRAVEL of each axis
  };
  // Of an axis; index 0 is its negative end, 1 its positive one.
  using Ends = std::array<bool, 2>;
  struct AxisState {
    Ends overridden{};
    Ends reached{};        // whence its limit was reached: where the last step went; both before the first one
    Ends blamed{};         // with `causes`
    bool moved = false;    // there was a step since reset
    bool pressed = false;  // some limit, in the last clock
    std::uint32_t overtravel = 0;
    std::uint32_t left = 0;  // steps into a limit that the axis may still make
  };
  // All that the next clock() depends on beside its inputs.
  struct State {
    std::array<AxisState, kMaxAxes> axes{};
    std::uint8_t any_step = 0;
    std::uint8_t shared = 0;
    bool probe_counts = false;
    bool tool_setter_counts = false;
    bool probe = true;  // their last levels
    bool tool_setter = true;
    std::uint8_t drives = 0;
    StopCauses causes{};
    std::uint32_t shown = 0;  // LIMIT_STATE
  };

  explicit LimitCheck(unsigned axes = kMaxAxes) : axes_(axes) {}

  // One rising edge.
  void clock(const Inputs& in);

  const State& state() const { return state_; }
  State& state() { return state_; }
  const StopCauses& causes() const { return state_.causes; }
  std::uint32_t limit_state() const { return state_.shown; }
  // Nothing changes while no step is made and these inputs stay.
  bool rests(const Inputs& in) const;

 private:
  Ends pressed(unsigned axis, const InputRoles& roles) const;
  Ends active(unsigned axis, const InputRoles& roles) const;
  bool any_limit(const InputRoles& roles) const;
  void show(std::uint32_t clear);
  void set(const Setting& setting, const InputRoles& roles);

  unsigned axes_;

  State state_;
};

}  // namespace trammel::model
