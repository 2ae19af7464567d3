#include "trammel/model/limit_check.hpp"

namespace trammel::model {

namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

bool bit(std::uint32_t mask, unsigned n) { return (mask >> n & 1) != 0; }

}  // namespace

// By role, without overrides. A shared switch counts at both ends.
LimitCheck::Ends LimitCheck::pressed(unsigned axis, const InputRoles& roles) const {
  const bool minus = bit(roles.limit_minus, axis);
  const bool plus = bit(roles.limit_plus, axis);
  return bit(state_.shared, axis) ? Ends{minus || plus, minus || plus} : Ends{minus, plus};
}

LimitCheck::Ends LimitCheck::active(unsigned axis, const InputRoles& roles) const {
  Ends ends = pressed(axis, roles);
  for (unsigned end = 0; end < 2; ++end) ends[end] = ends[end] && !state_.axes[axis].overridden[end];
  return ends;
}

bool LimitCheck::any_limit(const InputRoles& roles) const {
  for (unsigned n = 0; n < axes_; ++n) {
    const Ends ends = active(n, roles);
    if (bit(state_.any_step, n) && (ends[0] || ends[1])) return true;
  }
  return false;
}

void LimitCheck::clock(const Inputs& in) {
  show(in.clear);
  const bool on_ramp = in.stopping || state_.causes.limit;
  const bool under_any_rule = any_limit(in.roles);
  const bool any_into = under_any_rule && (in.step & state_.any_step) != 0;
  StopCauses causes;
  for (unsigned n = 0; n < axes_; ++n) {
    AxisState& axis = state_.axes[n];
    const bool step = bit(in.step, n);
    const unsigned end = bit(in.dir, n) ? 0 : 1;
    const Ends ends = active(n, in.roles);
    axis.moved = axis.moved || step;
    const bool pressed_now = bit(in.roles.limit_minus | in.roles.limit_plus, n);
    if (pressed_now && !axis.pressed) axis.reached = axis.moved ? Ends{end == 0, end == 1} : Ends{true, true};
    axis.pressed = pressed_now;
    bool into = false;
    if (bit(state_.any_step, n)) {
      into = step && under_any_rule;
      axis.blamed = any_into ? ends : Ends{};
    } else {
      into = step && ends[end] && (!bit(state_.shared, n) || axis.reached[end]);
      axis.blamed = {into && end == 0, into && end == 1};
    }
    if (!on_ramp) axis.left = axis.overtravel;
    causes.limit = causes.limit || into;
    causes.beyond = causes.beyond || (into && axis.left == 0);
    if (into && axis.left != 0) --axis.left;
  }
  state_.drives = static_cast<std::uint8_t>(in.roles.drive_fault & ((1U << axes_) - 1));
  causes.drive_fault = state_.drives != 0;
  causes.probe = state_.probe_counts && in.roles.probe && !state_.probe && in.runs && !in.probing;
  causes.tool_setter = state_.tool_setter_counts && in.roles.tool_setter && !state_.tool_setter && in.runs;
  state_.causes = causes;
  state_.probe = in.roles.probe;
  state_.tool_setter = in.roles.tool_setter;
  set(in.setting, in.roles);
}

bool LimitCheck::rests(const Inputs& in) const {
  const StopCauses& causes = state_.causes;
  if (in.step != 0 || in.clear != 0 || in.setting.set || causes.limit || causes.probe || causes.tool_setter)
    return false;
  if (in.roles.probe != state_.probe || in.roles.tool_setter != state_.tool_setter) return false;
  const std::uint32_t drives = in.roles.drive_fault & ((1U << axes_) - 1);
  if (drives != state_.drives || (drives << field::kLimitStateDriveFaultShift & ~state_.shown) != 0) return false;
  for (unsigned n = 0; n < axes_; ++n) {
    const AxisState& axis = state_.axes[n];
    const Ends now = pressed(n, in.roles);
    const bool released = (axis.overridden[0] && !now[0]) || (axis.overridden[1] && !now[1]);
    if (released || axis.blamed[0] || axis.blamed[1] || (axis.left != axis.overtravel && !in.stopping)) return false;
    if (axis.pressed != bit(in.roles.limit_minus | in.roles.limit_plus, n)) return false;
  }
  return true;
}

// LIMIT_STATE changes in the clock in which FAULT takes the causes.
void LimitCheck::show(std::uint32_t clear) {
  if ((clear & field::kFaultLimit) != 0) state_.shown &= ~(field::kLimitStateMinus | field::kLimitStatePlus);
  if ((clear & field::kFaultDriveFault) != 0) state_.shown &= ~field::kLimitStateDriveFault;
  for (unsigned n = 0; n < axes_; ++n) {
    if (state_.axes[n].blamed[0]) state_.shown |= 1U << (field::kLimitStateMinusShift + n);
    if (state_.axes[n].blamed[1]) state_.shown |= 1U << (field::kLimitStatePlusShift + n);
  }
  state_.shown |= std::uint32_t{state_.drives} << field::kLimitStateDriveFaultShift;
}

// An override ends when its switch is released.
void LimitCheck::set(const Setting& setting, const InputRoles& roles) {
  for (unsigned n = 0; n < axes_; ++n) {
    AxisState& axis = state_.axes[n];
    if (setting.set && setting.address == reg::kLimitOverride)
      axis.overridden = {bit(setting.data, n), bit(setting.data, 8 + n)};
    const Ends now = pressed(n, roles);
    for (unsigned end = 0; end < 2; ++end) axis.overridden[end] = axis.overridden[end] && now[end];
    if (setting.set && setting.address == reg::overtravel(n)) axis.overtravel = setting.data;
  }
  if (!setting.set || setting.address != reg::kStopCauses) return;
  const std::uint32_t present = (1U << axes_) - 1;
  state_.any_step = static_cast<std::uint8_t>(setting.data & present);
  state_.shared = static_cast<std::uint8_t>(setting.data >> field::kStopCausesSharedShift & present);
  state_.probe_counts = (setting.data & field::kStopCausesProbe) != 0;
  state_.tool_setter_counts = (setting.data & field::kStopCausesToolSetter) != 0;
}

}  // namespace trammel::model
