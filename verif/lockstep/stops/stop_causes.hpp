// The causes of a stop, one line each: how the test causes it, its bit of FAULT, its latest time.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "stop_programs.hpp"

namespace trammel::test {

enum class Reaction { kAtOnce, kRamp, kShortRamp, kOff, kNone };

inline const char* name_of(Reaction reaction) {
  constexpr const char* kNames[] = {"at once", "ramp", "ramp with a short overtravel", "switched off", "as ever"};
  return kNames[static_cast<int>(reaction)];
}

// The effect of a cause on a state. kByPulses: depends on whether the pins show a step after it, for switches that
// need a step.
enum class Effect { kStop, kNothing, kByPulses, kHold, kCut };

struct Write {
  std::uint32_t address = 0;
  std::uint32_t value = 0;
};

struct Cause {
  const char* name;
  std::uint32_t fault;  // 0: none
  std::vector<Reaction> reactions;
  Effect (*effect)(const State&);
  // The trigger, one of: a rising input, a register write, the program itself, a time set before.
  std::variant<Input, Write, void (*)(Program&, unsigned), std::uint64_t> strike;
  // Bounds of the clocks from the trigger to the time in the area STOP, if there are bounds.
  std::uint64_t soonest = 0;
  std::uint64_t latest = 0;
  // FAULT can be cleared while the cause lasts.
  bool cleared_while_it_lasts = true;
  void (*prepare)(StopBench&) = nullptr;  // before the program is sent
  void (*end)(StopBench&) = nullptr;      // ends the cause; for an input: its falling edge
  // Only for limits.
  unsigned axis = 0;
  int direction = 0;
  // The cause is active again after a reset.
  bool outlives_reset = false;
  // The axis may lose steps during a ramp.
  bool loses_steps = false;
  // The cause comes if the host makes no access for the time of `strike`; the program begins by an input.
  bool of_silence = false;

  bool of_program() const { return std::holds_alternative<void (*)(Program&, unsigned)>(strike); }
  bool timed() const { return std::holds_alternative<std::uint64_t>(strike); }
};

// From a pin to its role (the scan takes 64 clocks), and from there to FAULT: behaviour.md. STOP is taken one clock
// later.
inline constexpr std::uint64_t kRoleSoonest = 3;
inline constexpr std::uint64_t kRoleLatest = 66;
inline constexpr std::uint64_t kRoleToStop = 3;

inline constexpr std::uint16_t kShortOvertravel = 3;  // steps
inline constexpr std::uint32_t kLateSpace = 400;      // clocks: with this STEP_SPACE steps wait too long
inline constexpr unsigned kFirstWindowTick = 30;      // for causes made by a program

inline driver::FeedCommand& last_piece(Program& program) {
  driver::FeedCommand* found = nullptr;
  for (driver::Command& command : program.commands) {
    if (auto* piece = std::get_if<driver::FeedCommand>(&command)) found = piece;
  }
  return *found;
}
template <class Kind>
Kind& first_of(Program& program) {
  for (driver::Command& command : program.commands) {
    if (auto* path = std::get_if<Kind>(&command)) return *path;
  }
  throw std::logic_error("the program has no such command");
}

inline void break_pieces(Program& program, unsigned clock) {
  std::uint64_t& ticks = last_piece(program).ticks;
  if (ticks == kFirstWindowTick + clock) throw std::logic_error("the piece is not broken by what it has already");
  ticks = kFirstWindowTick + clock;
}
inline void break_arc(Program& program, unsigned clock) {
  auto& arc = first_of<driver::ArcCommand>(program);
  arc.ticks = arc.path_ticks = program.paths[0].ticks = last_piece(program).ticks = kFirstWindowTick + clock;
}
inline void end_periods(Program& program, unsigned clock) {
  first_of<driver::LineCommand>(program).ticks = program.paths[0].ticks = kFirstWindowTick + clock;
}

template <Effect kEffect>
Effect unless_reset(const State& state) {
  return state.resets ? Effect::kNothing : kEffect;
}
inline Effect in_motion(const State& state) {
  return state.runs ? unless_reset<Effect::kStop>(state) : Effect::kNothing;
}
inline Effect outside_probing(const State& state) { return state.probing ? Effect::kNothing : in_motion(state); }
// Steps of axis 0 come, in the window or when the program continues.
inline Effect with_steps(const State& state) {
  return std::string(state.name) == "between commands" ? Effect::kNothing : unless_reset<Effect::kStop>(state);
}
inline Effect in_streaming(const State& state) { return state.streaming ? Effect::kStop : Effect::kNothing; }
inline Effect with_pieces(const State& state) {
  const bool moves = state.moves && !state.streaming && state.program().direct == nullptr;
  return moves ? unless_reset<Effect::kStop>(state) : Effect::kNothing;
}
inline Effect with_an_arc(const State& state) {
  const std::vector<driver::Command>& commands = state.program().commands;
  const bool arc = std::any_of(commands.begin(), commands.end(),
                               [](const auto& c) { return std::holds_alternative<driver::ArcCommand>(c); });
  return arc ? Effect::kStop : Effect::kNothing;
}

inline Cause of_role(const char* name, std::uint32_t fault, std::vector<Reaction> reactions,
                     Effect (*effect)(const State&), Input input) {
  Cause cause{name, fault, std::move(reactions), effect, input};
  cause.soonest = kRoleSoonest + kRoleToStop;
  cause.latest = kRoleLatest + kRoleToStop;
  return cause;
}
inline Cause limit(const char* name, Input input, unsigned axis, int direction) {
  Cause cause{name,
              field::kFaultLimit,
              {Reaction::kAtOnce, Reaction::kRamp, Reaction::kShortRamp},
              unless_reset<Effect::kByPulses>,
              input};
  cause.axis = axis;
  cause.direction = direction;
  return cause;
}
inline Cause drive_fault() {
  Cause cause = of_role("drive fault", field::kFaultDriveFault, {Reaction::kRamp, Reaction::kAtOnce},
                        unless_reset<Effect::kStop>, kDriveInput);
  cause.cleared_while_it_lasts = false;
  return cause;
}
inline Cause watchdog() {
  Cause cause{"watchdog",
              field::kFaultWatchdog,
              {Reaction::kRamp, Reaction::kAtOnce},
              unless_reset<Effect::kStop>,
              std::uint64_t{65536}};
  cause.prepare = [](StopBench& bench) { bench.write(reg::kWatchdog, 1); };
  cause.end = [](StopBench& bench) { bench.write(reg::kWatchdog, 0); };
  cause.soonest = 1;
  cause.latest = 8;
  cause.cleared_while_it_lasts = false;
  return cause;
}
// A unit of LINK_TIMEOUT passes at each multiple of 65,536 clocks. The link is lost at the second multiple after the
// last access.
inline Cause link_loss() {
  Cause cause{"link loss",
              field::kFaultLinkLoss,
              {Reaction::kRamp, Reaction::kAtOnce},
              unless_reset<Effect::kStop>,
              std::uint64_t{65536}};
  cause.prepare = [](StopBench& bench) { bench.write(reg::kLinkTimeout, 1); };
  cause.end = [](StopBench& bench) { bench.write(reg::kLinkTimeout, 0); };
  cause.soonest = 1;
  cause.latest = 8;
  cause.cleared_while_it_lasts = false;
  cause.of_silence = true;
  return cause;
}
// Through its synchroniser and latch.
inline Cause emergency_stop() {
  Cause cause{"emergency stop",
              field::kFaultEmergencyStop,
              {Reaction::kAtOnce, Reaction::kRamp},
              unless_reset<Effect::kStop>,
              kEmergencyStopPin};
  cause.soonest = 2;
  cause.latest = 6;
  cause.cleared_while_it_lasts = false;
  cause.outlives_reset = true;
  return cause;
}
// The new end is at a position that the axis has passed: its next step outward is one too far.
inline Cause soft_limit() {
  constexpr std::uint32_t kFarMinus = 0xC0000000U;
  constexpr std::uint32_t kFarPlus = 0x3FFFFFFFU;
  Cause cause{"soft limit",
              field::kFaultSoftLimit,
              {Reaction::kRamp, Reaction::kAtOnce},
              unless_reset<Effect::kByPulses>,
              Write{reg::soft_plus(0), kFarMinus}};
  cause.prepare = [](StopBench& bench) {
    bench.write(reg::soft_minus(0), kFarMinus);
    bench.write(reg::soft_plus(0), kFarPlus);
    bench.write(reg::kSoftLimits, 1);
  };
  cause.end = [](StopBench& bench) { bench.write(reg::soft_plus(0), kFarPlus); };
  cause.axis = 0;
  cause.direction = 1;
  return cause;
}
inline Cause step_fault() {
  Cause cause{"step fault",
              field::kFaultStep,
              {Reaction::kAtOnce, Reaction::kRamp},
              with_steps,
              Write{reg::step_space(0), kLateSpace}};
  cause.prepare = [](StopBench& bench) { bench.write(reg::kHoldLimit, 20); };
  cause.end = [](StopBench& bench) { bench.write(reg::step_space(0), kAxisPins[0].space); };
  cause.loses_steps = true;
  return cause;
}
inline Cause missing_period() {
  Cause cause{
      "missing period", field::kFaultMissingPeriod, {Reaction::kAtOnce, Reaction::kRamp}, in_streaming, end_periods};
  cause.prepare = [](StopBench& bench) { bench.write(reg::kStreaming, field::kStreamingOn); };
  return cause;
}

inline const std::vector<Cause>& causes() {
  using R = Reaction;
  static const std::vector<Cause> all{
      limit("limit plus", kLimitPlusInput, 0, 1),
      limit("limit minus", kLimitMinusInput, 1, -1),
      drive_fault(),
      of_role("probe", field::kFaultProbe, {R::kRamp, R::kAtOnce, R::kOff}, outside_probing, kProbeRoleInput),
      of_role("tool setter", field::kFaultToolSetter, {R::kRamp, R::kAtOnce, R::kOff}, in_motion, kToolSetterInput),
      watchdog(),
      link_loss(),
      emergency_stop(),
      soft_limit(),
      step_fault(),
      {"tick mismatch", field::kFaultTickMismatch, {R::kAtOnce}, with_pieces, break_pieces},
      {"path incomplete", field::kFaultPathIncomplete, {R::kAtOnce}, with_an_arc, break_arc},
      missing_period(),
      {"abort", 0, {R::kNone}, unless_reset<Effect::kCut>, Write{reg::kControl, field::kControlAbort}},
      {"feed hold button", 0, {R::kNone}, unless_reset<Effect::kHold>, kFeedHoldInput},
  };
  return all;
}

}  // namespace trammel::test
