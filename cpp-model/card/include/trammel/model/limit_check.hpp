// Golden model of the limit check: derives causes of a stop from the machine's inputs. Causes are a step into an
// active limit, a drive's fault, the probe outside probing, and the tool setter; the stop control decides how to
// react.
//
// An event in clock c is a cause in c+1, and is in FAULT and LIMIT_STATE at c+2. Not thread-safe; no errors are
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
    std::uint8_t step = 0;  // steps on the path, a bit per axis
    std::uint8_t dir = 0;   // direction of each axis's last step, 1 = negative
    bool runs = false;      // a path or a direct move is under way
    bool probing = false;
    bool stopping = false;    // the ramp of a fault is under way
    std::uint32_t clear = 0;  // event: ones written to FAULT
    Setting setting;          // STOP_CAUSES, LIMIT_OVERRIDE, OVERTRAVEL of each axis
  };
  // Flags of an axis: index 0 is the negative end, 1 the positive end.
  using Ends = std::array<bool, 2>;
  struct AxisState {
    Ends overridden{};
    Ends reached{};        // side of the last step when the limit became active; both before the first step
    Ends blamed{};         // ends to report together with `causes`
    bool moved = false;    // the axis has made a step since reset
    bool pressed = false;  // a limit of the axis was active in the last clock
    std::uint32_t overtravel = 0;
    std::uint32_t left = 0;  // steps into a limit that the axis may still make
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::array<AxisState, kMaxAxes> axes{};
    std::uint8_t any_step = 0;
    std::uint8_t shared = 0;
    bool probe_counts = false;
    bool tool_setter_counts = false;
    bool probe = true;  // levels in the last clock
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
  // True if nothing changes while no step is made and these inputs stay.
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
