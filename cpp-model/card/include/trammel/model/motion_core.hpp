// Golden model of the motion core: sequencers, time base, path engines, axes and stop control, between the queues and
// the pins. All parts take one rising edge together: each sees the state from before it. Not thread-safe; no errors are
// reported.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trammel/model/axis.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/button_hold.hpp"
#include "trammel/model/card_health.hpp"
#include "trammel/model/clock_each.hpp"
#include "trammel/model/direct_loader.hpp"
#include "trammel/model/drive_enable.hpp"
#include "trammel/model/feed_generator.hpp"
#include "trammel/model/limit_check.hpp"
#include "trammel/model/machine_place.hpp"
#include "trammel/model/path_commands.hpp"
#include "trammel/model/path_engines.hpp"
#include "trammel/model/probe.hpp"
#include "trammel/model/sequencer.hpp"
#include "trammel/model/soft_limits.hpp"
#include "trammel/model/stop_control.hpp"
#include "trammel/model/time_base.hpp"
#include "trammel/model/underrun_guard.hpp"
#include "trammel/model/wait_timer.hpp"
#include "trammel/model/watchdog.hpp"

namespace trammel::model {

class MotionCore {
 public:
  struct Inputs {
    Setting setting;
    bool abort = false;
    std::uint32_t clear_fault = 0;
    bool session_gone = false;  // the session that wrote the stream is gone
    bool link_lost = false;
    bool probe_clear = false;
    // queues
    bool geometry_empty = true;
    bool feed_empty = true;
    std::uint16_t geometry_word = 0;
    std::uint16_t feed_word = 0;
    UnderrunGuard::Arrival arrival;
    bool full = false;  // a queue may have no room for the next command
    // direct mode
    bool start = false;
    std::uint8_t start_mask = 0;
    std::uint32_t loader_data = 0;
    std::uint32_t levels = 0;  // filtered levels of the card's inputs
    std::uint32_t raw = 0;     // levels before the filters
    std::uint32_t quiet = 0;   // inputs that are quiet; only cards with captures
    InputRoles roles;          // only cards with machine inputs
    bool emergency = false;    // level: the emergency stop's cause
  };
  // A bit per axis.
  struct Outputs {
    std::uint32_t step = 0;  // pins
    std::uint32_t dir = 0;
    std::uint32_t path_step = 0;
    std::uint32_t path_dir = 0;
    std::uint32_t live = 0;
    std::uint32_t axis_busy = 0;
    std::uint32_t step_fault = 0;
    std::uint32_t engine_step = 0;  // the bits of path_step that came from a path engine
    bool busy = false;
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    DirectLoader loader;
    Sequencer sequencer;
    PathCommands commands;
    StopControl stop{};
    Watchdog watchdog{};
    LimitCheck limits{};
    SoftLimits soft_limits{};
    ButtonHold buttons{};
    MachinePlace place{};
    DriveEnable drives{};
    CardHealth health{};
    UnderrunGuard guard{};
    TimeBase time_base{};
    FeedGenerator feed{};
    PathEngines engines{};
    WaitTimer wait_timer{};
    Probe probe{};
    std::vector<Axis> axes{};
    bool axes_live = false;  // an axis is live; one clock late
    bool running = false;    // something runs; one clock late
    bool probing = false;    // the probe is busy; one clock late
    unsigned busy_left = 0;  // clocks until `busy` falls
    Outputs out{};
  };

  // `idle_level`: {second pins, first pins}, `axes` bits each. `engines`: mask of the optional engines that are built
  // in.
  MotionCore(unsigned axes, std::uint32_t idle_level, std::uint32_t engines = 0, const PathCommands::Config& pins = {});

  // One rising edge.
  void clock(const Inputs& in) { clock_parts(in, ClockEach()); }
  template <class ClockPart>
  void clock_parts(const Inputs& in, const ClockPart& clock_part);

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }
  const Sequencer& sequencer() const { return state_.sequencer; }
  const StopControl::Outputs& stop() const { return state_.stop.outputs(); }
  const DirectLoader::Outputs& loader() const { return state_.loader.outputs(); }
  const UnderrunGuard::Outputs& underrun() const { return state_.guard.outputs(); }
  const TimeBase::Outputs& time() const { return state_.time_base.outputs(); }
  const FeedGenerator::Outputs& feed() const { return state_.feed.outputs(); }
  const PathCommands& commands() const { return state_.commands; }
  const Probe& probe() const { return state_.probe; }
  // True if the probe asks for a snapshot in this clock, with these inputs.
  bool probe_asks(const Inputs& in) const {
    // If neither is true, the probe cannot ask: its inputs need not be computed.
    if (!state_.probe.busy() && !state_.sequencer.probe_waits()) return false;
    return state_.probe.asks(probe_inputs(in));
  }
  // True if the snapshot REST is requested in this clock.
  bool rests(const Inputs& in) const {
    if (!in.abort && !state_.stop.closing()) return false;
    const Probe::Inputs probe = probe_inputs(in);
    return state_.stop.rests(stop_inputs(in, sequencer_inputs(in, probe)));
  }
  // STATUS.settled.
  bool settled() const { return state_.stop.settled() && !state_.sequencer.outputs().swap; }
  const PathEngines::Outputs& engines() const { return state_.engines.outputs(); }
  bool chord_tick() const { return state_.engines.chord_tick(); }
  std::uint32_t position(unsigned axis) const { return state_.axes[axis].state().shaper.outputs().position; }

  // Copies the outputs of the axis to the outputs of this block.
  void show_axis(unsigned n);
  // The inputs of the parts.
  Probe::Inputs probe_inputs(const Inputs& in) const;
  Sequencer::Inputs sequencer_inputs(const Inputs& in, const Probe::Inputs& probe) const;
  UnderrunGuard::Inputs guard_inputs(const Inputs& in, const Sequencer::Inputs& sequencer_in) const;
  // True while the under-run guard counts. It does not count in position streaming.
  bool guards() const { return has_guard_ && !state_.sequencer.streaming().on; }

  // STATUS.busy falls after this many clocks in which nothing ran.
  static constexpr unsigned kBusyClocks = 11;

  PathCommands::Inputs command_inputs(const Inputs& in, const StopControl::Inputs& stop) const;
  // The setting is left empty.
  TimeBase::Inputs time_inputs() const {
    const Sequencer::Outputs& s = state_.sequencer.outputs();
    return {state_.stop.outputs().hold, {}, s.piece_class, s.slew_shift};
  }
  StopControl::Inputs stop_inputs(const Inputs& in, const Sequencer::Inputs& sequencer_in) const;
  LimitCheck::Inputs limit_inputs(const Inputs& in) const;
  SoftLimits::Inputs soft_limit_inputs(const Inputs& in) const;
  MachinePlace::Inputs place_inputs(const Inputs& in) const;
  DriveEnable::Inputs drive_inputs(const Inputs& in) const;
  CardHealth::Inputs health_inputs(const Inputs& in) const {
    return {in.setting, state_.stop.outputs().fault, state_.watchdog.running()};
  }
  // True while no tick is taken because the drives are not enabled.
  bool waits_for_drives() const { return has_enables_ && state_.drives.waits(); }
  bool wants_drives() const { return state_.sequencer.outputs().direct || state_.sequencer.ticking_path(); }
  // Levels of the outputs, without PWM pulses; `latched`: the emergency stop's latch is set.
  std::uint16_t output_levels(bool latched) const {
    const OutputRoleLevels roles{state_.drives.enabled(), state_.drives.released(), state_.health.pump(),
                                 state_.health.healthy()};
    return state_.commands.outputs(latched, roles);
  }
  // Levels at the output pins, with PWM pulses.
  std::uint16_t output_pins(bool latched) const {
    return state_.commands.pins(output_levels(latched), state_.sequencer.outputs().silent,
                                state_.time_base.outputs().ratio == 0);
  }
  bool has_machine_inputs() const { return has_machine_inputs_; }
  bool has_soft_limits() const { return has_soft_limits_; }
  // The register LIMIT_STATE.
  std::uint32_t limit_state() const { return state_.limits.limit_state() | state_.soft_limits.limit_state(); }
  bool has_enables() const { return has_enables_; }

 private:
  Axis::Inputs axis_inputs(const Inputs& in) const;
  void clock_busy();

  bool has_guard_;
  bool has_machine_inputs_;
  bool has_soft_limits_;
  bool has_enables_;

  State state_;
};

inline Probe::Inputs MotionCore::probe_inputs(const Inputs& in) const {
  Probe::Inputs probe;
  probe.cut = state_.stop.outputs().cut;
  probe.levels = in.levels;
  probe.raw = in.raw;
  probe.quiet = in.quiet;
  probe.waits = state_.sequencer.probe_waits();
  probe.ends = state_.sequencer.probe_ends();
  probe.at_rest = state_.time_base.outputs().ratio == 0;
  probe.stopping = state_.stop.outputs().stopping;
  probe.clear = in.probe_clear;
  probe.load = state_.sequencer.load();
  return probe;
}

// Each consumer is clocked before its producer, so that it sees the producer's outputs from before the edge.
template <class ClockPart>
void MotionCore::clock_parts(const Inputs& in, const ClockPart& clock_part) {
  const Probe::Inputs probe = probe_inputs(in);
  const Sequencer::Inputs sequencer = sequencer_inputs(in, probe);
  const StopControl::Outputs stop = state_.stop.outputs();
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  const bool over = stop.cut || state_.probe.halt();
  clock_part(state_.loader, {false, state_.out.busy, stop.closed, in.start, in.start_mask, in.loader_data});
  const StopControl::Inputs stop_in = stop_inputs(in, sequencer);
  TimeBase::Inputs time = time_inputs();
  time.setting = in.setting;
  const PathCommands::Inputs commands = command_inputs(in, stop_in);
  if (has_machine_inputs_) {
    clock_part(state_.limits, limit_inputs(in));
    clock_part(state_.buttons, in.roles);
  }
  if (has_soft_limits_) clock_part(state_.soft_limits, soft_limit_inputs(in));
  const MachinePlace::Inputs place = place_inputs(in);
  if (has_enables_) {
    clock_part(state_.drives, drive_inputs(in));
    clock_part(state_.health, health_inputs(in));
  }
  clock_part(state_.place, place);
  if (has_guard_) clock_part(state_.guard, guard_inputs(in, sequencer));
  clock_part(state_.stop, stop_in);
  clock_part(state_.commands, commands);
  clock_busy();
  state_.axes_live = state_.out.live != 0;
  Axis::Inputs axis = axis_inputs(in);
  axis.cut = over;
  const PathEngines::Outputs& engines = state_.engines.outputs();
  state_.out.engine_step = engines.step;
  for (unsigned n = 0; n < state_.axes.size(); ++n) {
    const std::uint32_t bit = 1U << n;
    axis.active = (s.active & bit) != 0;
    axis.chord_load = (engines.chord_load & bit) != 0;
    axis.chord_swap = (engines.chord_swap & bit) != 0;
    axis.engine_step = (engines.step & bit) != 0;
    axis.engine_dir = (engines.dir & bit) != 0;
    if (clock_part(state_.axes[n], axis)) show_axis(n);
  }
  clock_part(state_.wait_timer, in.setting);
  clock_part(state_.watchdog, in.setting);
  clock_part(state_.engines,
             {over, s.tick, s.swap, s.engine, state_.sequencer.load(), state_.sequencer.engine_taken()});
  clock_part(state_.feed, {s.feed_clear, s.feed_enable, s.spent, state_.sequencer.feed_load(), s.feed_swap});
  clock_part(state_.time_base, time);
  clock_part(state_.probe, probe);
  clock_part(state_.sequencer, sequencer);
}

}  // namespace trammel::model
