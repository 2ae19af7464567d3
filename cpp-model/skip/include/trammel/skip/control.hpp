// Adaptors of stop control, watchdog, probe, inputs and path commands. See horizon.hpp.
#pragma once

#include <algorithm>
#include <cstdint>

#include "trammel/model/button_hold.hpp"
#include "trammel/model/captures.hpp"
#include "trammel/model/card_health.hpp"
#include "trammel/model/drive_enable.hpp"
#include "trammel/model/emergency_stop.hpp"
#include "trammel/model/limit_check.hpp"
#include "trammel/model/machine_place.hpp"
#include "trammel/model/path_commands.hpp"
#include "trammel/model/probe.hpp"
#include "trammel/model/soft_limits.hpp"
#include "trammel/model/stop_control.hpp"
#include "trammel/model/watchdog.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

inline std::uint64_t horizon(const model::StopControl& block, const model::StopControl::Inputs& in) {
  using Mode = model::StopControl::Mode;
  const model::StopControl::State& s = block.state();
  const bool events = in.step_fault != 0 || in.mismatch || in.incomplete || in.missing || in.abort || in.clear != 0 ||
                      in.setting.set || in.soft_limit || s.out.cut || s.out.stop;
  const bool pulses = in.causes.limit || in.causes.probe || in.causes.tool_setter;
  // Causes that persist: once they are in FAULT and the card is stopped, they change nothing more.
  const std::uint32_t lasting = (in.expired ? card_map::field::kFaultWatchdog : 0) |
                                (in.link_lost ? card_map::field::kFaultLinkLoss : 0) |
                                (in.emergency ? card_map::field::kFaultEmergencyStop : 0) |
                                (in.causes.drive_fault ? card_map::field::kFaultDriveFault : 0);
  const bool new_cause = lasting != 0 && (s.mode != Mode::Stopped || (lasting & ~s.out.fault) != 0);
  const bool settles = block.counts(in) ? !block.settled() : s.settled != 0;
  if (events || pulses || new_cause || settles || s.mode == Mode::Ramp || s.mode == Mode::Closing ||
      (s.mode == Mode::Stopped && s.out.fault == 0 && lasting == 0))
    return 0;
  const bool made = in.underrun || in.probe;
  const bool hold = block.asked_hold(in) || made;
  return forever_if(made == s.made_to_hold && block.stays(in) == s.hold_stays && hold == s.out.hold &&
                    s.out.closed == (s.out.fault != 0 || s.mode != Mode::Run));
}
inline void advance(model::StopControl&, const model::StopControl::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::LimitCheck& block, const model::LimitCheck::Inputs& in) {
  return forever_if(block.rests(in));
}
inline void advance(model::LimitCheck&, const model::LimitCheck::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::SoftLimits& block, const model::SoftLimits::Inputs& in) {
  const model::SoftLimits::State& s = block.state();
  return forever_if(in.counts == 0 && s.moved == 0 && !s.judged.any && !s.cause.any && !in.clear && !in.setting.set);
}
// Clocks without a pulse. Axes that have moved must be within their limits.
inline void pass(model::SoftLimits& block, std::uint64_t clocks) {
  // Two rounds look at all axes that have moved; after that only the phase changes.
  const std::uint64_t rounds = 2 * block.round();
  if (clocks > rounds) block.state().phase = static_cast<unsigned>((block.state().phase + clocks) % block.round());
  for (std::uint64_t i = std::min(clocks, rounds); i != 0; --i) block.look(0);
}
inline void advance(model::SoftLimits& block, const model::SoftLimits::Inputs&, std::uint64_t clocks) {
  pass(block, clocks);
}

inline std::uint64_t horizon(const model::MachinePlace& block, const model::MachinePlace::Inputs& in) {
  return forever_if(block.rests(in));
}
inline void advance(model::MachinePlace&, const model::MachinePlace::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::ButtonHold& block, const model::ButtonHold::Inputs& in) {
  const model::ButtonHold::State& s = block.state();
  return forever_if(in.cycle_start == s.cycle_start && (s.hold || !in.feed_hold));
}
inline void advance(model::ButtonHold&, const model::ButtonHold::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::EmergencyStop& block, const model::EmergencyStop::Inputs& in) {
  return forever_if(block.rests(in));
}
inline void advance(model::EmergencyStop&, const model::EmergencyStop::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::DriveEnable& block, const model::DriveEnable::Inputs& in) {
  return block.quiet_clocks(in);
}
inline void advance(model::DriveEnable& block, const model::DriveEnable::Inputs& in, std::uint64_t clocks) {
  block.pass(in, clocks);
}

inline std::uint64_t horizon(const model::CardHealth& block, const model::CardHealth::Inputs& in) {
  return block.quiet_clocks(in);
}
inline void advance(model::CardHealth& block, const model::CardHealth::Inputs&, std::uint64_t clocks) {
  block.pass(clocks);
}

inline std::uint64_t horizon(const model::Watchdog& block, const model::Setting& in) {
  if (in.set && in.address == card_map::reg::kWatchdog) return 0;
  return block.state().left == 0 ? kForever : block.state().left - 1;
}
inline void advance(model::Watchdog& block, const model::Setting&, std::uint64_t clocks) {
  if (block.state().left != 0) block.state().left -= clocks;
}

inline std::uint64_t horizon(const model::Probe& block, const model::Probe::Inputs& in) {
  using Mode = model::Probe::Mode;
  const model::Probe::State& s = block.state();
  const bool moves = (s.mode == Mode::Armed && (block.edges(in) || in.ends)) || (s.mode == Mode::Ramp && in.at_rest) ||
                     (s.mode == Mode::Dropping && in.ends && !s.probed) || block.touched_after(in) != s.touched ||
                     block.before_after(in) != s.before || s.late;
  if (in.cut || in.clear || in.load.valid || s.halt || moves) return 0;
  if (!in.waits) return forever_if(s.waited == 0);
  return block.takes(in) || s.waited < model::Probe::kSettle ? 0 : kForever;
}
inline void advance(model::Probe& block, const model::Probe::Inputs& in, std::uint64_t clocks) {
  if (in.waits) block.state().waited += static_cast<unsigned>(clocks);
}

inline std::uint64_t horizon(const model::Captures& block, const model::Captures::Inputs& in) {
  return forever_if(block.asks(in) == 0 && block.rests(in));
}
inline void advance(model::Captures&, const model::Captures::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::PathCommands& block, const model::PathCommands::Inputs& in) {
  const model::PathCommands::State& s = block.state();
  const bool events =
      in.cut || in.halt || in.output || in.mark || in.load.to(model::load_target::kCommand) || in.setting.set;
  const bool waits = s.output_waits || s.mark_waits;
  if (in.caused && !s.outputs.safe()) return 0;
  const bool rests = !events && s.left == 0 && !s.merges && !s.mark && (!waits || (in.runs && !in.over));
  if (!rests || in.pwm) return 0;
  return block.has_pwm() ? s.pwm.quiet_clocks(block.pwm_inputs(in)) : kForever;
}
inline void advance(model::PathCommands& block, const model::PathCommands::Inputs& in, std::uint64_t clocks) {
  if (block.has_pwm()) block.state().pwm.pass(block.pwm_inputs(in), clocks);
}

}  // namespace trammel::skip
