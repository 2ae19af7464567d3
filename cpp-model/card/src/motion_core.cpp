#include "trammel/model/motion_core.hpp"

namespace trammel::model {

namespace {

void put(std::uint32_t& word, std::uint32_t bit, bool value) { word = value ? word | bit : word & ~bit; }

unsigned idle_level_of(std::uint32_t levels, unsigned axes, unsigned axis) {
  return (levels >> axis & 1) | (levels >> (axes + axis) & 1) << 1;
}

}  // namespace

MotionCore::MotionCore(unsigned axes, std::uint32_t idle_level, std::uint32_t engines, const PathCommands::Config& pins)
    : has_guard_(card_map::has_engine(engines, card_map::engine::kUnderrunHold)),
      has_machine_inputs_(card_map::has_engine(engines, card_map::engine::kMachineInputs)),
      has_soft_limits_(card_map::has_engine(engines, card_map::engine::kSoftLimits)),
      has_enables_(card_map::has_engine(engines, card_map::engine::kEnables)),
      state_{DirectLoader(axes), Sequencer(card_map::has_engine(engines, card_map::engine::kStreaming)),
             PathCommands(pins, card_map::has_engine(engines, card_map::engine::kPwm))} {
  state_.time_base = TimeBase(card_map::has_engine(engines, card_map::engine::kClasses));
  state_.limits = LimitCheck(axes);
  state_.soft_limits = SoftLimits(axes);
  state_.place = MachinePlace(axes);
  state_.probe = Probe(card_map::has_engine(engines, card_map::engine::kCaptures));
  state_.drives = DriveEnable(axes);
  for (unsigned n = 0; n < axes; ++n) {
    state_.axes.emplace_back(n, idle_level_of(idle_level, axes, n));
    put(state_.out.step, 1U << n, state_.axes[n].outputs().shaper.step);
    put(state_.out.dir, 1U << n, state_.axes[n].outputs().shaper.dir);
  }
}

Sequencer::Inputs MotionCore::sequencer_inputs(const Inputs& in, const Probe::Inputs& probe_in) const {
  Sequencer::Inputs s;
  s.halt = state_.probe.halt();
  s.drop = state_.probe.drops();
  s.probe_taken = state_.probe.takes(probe_in);
  s.met = state_.probe.met(probe_in.levels);
  s.stays = state_.probe.stays(probe_in);
  s.cut = state_.stop.outputs().cut;
  s.shut = state_.stop.shut();
  s.closing = state_.stop.closing();
  s.drives_wait = waits_for_drives();
  s.geometry_empty = in.geometry_empty;
  s.feed_empty = in.feed_empty;
  s.geometry_word = in.geometry_word;
  s.feed_word = in.feed_word;
  s.wait = has_guard_ && state_.guard.waits(state_.sequencer.outputs().feed_active);
  s.setting = in.setting;
  s.arrives = in.arrival.geometry_write || in.arrival.feed_write;
  s.arrived = in.arrival.drop || in.arrival.geometry_commit || in.arrival.feed_commit;
  s.at_rest = !state_.out.busy;
  s.direct_go = state_.loader.outputs().go;
  s.direct_mask = state_.loader.outputs().mask;
  s.direct_load = state_.loader.outputs().load;
  s.enable = state_.time_base.outputs().enable;
  s.feed_tick = state_.feed.outputs().tick;
  const PathEngines::Outputs& engines = state_.engines.outputs();
  s.engine_ready = engines.ready;
  s.payload_ready = engines.payload_ready;
  s.shadows_free = engines.shadows_free;
  s.engine_done = engines.done;
  s.missed_end = engines.missed_end;
  s.axes_live = state_.axes_live;
  return s;
}

UnderrunGuard::Inputs MotionCore::guard_inputs(const Inputs& in, const Sequencer::Inputs& sequencer_in) const {
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  UnderrunGuard::Inputs guard;
  guard.cut = state_.stop.outputs().cut || state_.sequencer.streaming().on;
  guard.lost = state_.probe.halt();
  guard.idle = s.idle && !state_.probing;
  guard.gone = in.session_gone;
  guard.arrival = in.arrival;
  guard.full = in.full;
  guard.load = state_.sequencer.feed_load();
  guard.take = s.feed_active && state_.sequencer.takes(sequencer_in);
  guard.swap = s.feed_swap;
  guard.active = s.feed_active;
  guard.decoded = state_.sequencer.piece_waits();
  guard.ratio = state_.time_base.outputs().ratio;
  return guard;
}

StopControl::Inputs MotionCore::stop_inputs(const Inputs& in, const Sequencer::Inputs& sequencer_in) const {
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  StopControl::Inputs stop;
  stop.step_fault = state_.out.step_fault;
  stop.mismatch = s.mismatch;
  stop.incomplete = s.incomplete;
  stop.missing = state_.sequencer.streaming().missing;
  stop.expired = state_.watchdog.expired();
  stop.link_lost = in.link_lost;
  stop.emergency = in.emergency;
  stop.causes = state_.limits.causes();
  stop.soft_limit = state_.soft_limits.cause();
  stop.button = state_.buttons.hold();
  stop.abort = in.abort;
  stop.clear = in.clear_fault;
  stop.at_rest = state_.time_base.outputs().ratio == 0;
  stop.moving = s.moving;
  stop.fixed = s.piece_class == card_map::constant::kClassFixed;
  stop.underrun = state_.guard.outputs().hold;
  stop.probe = state_.probe.holds();
  stop.take = state_.sequencer.takes(sequencer_in);
  stop.quiet = state_.engines.quiet();
  stop.pulses = state_.out.axis_busy != 0;
  stop.busy = state_.out.busy;
  stop.setting = in.setting;
  return stop;
}

LimitCheck::Inputs MotionCore::limit_inputs(const Inputs& in) const {
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  LimitCheck::Inputs limits;
  limits.roles = in.roles;
  limits.step = static_cast<std::uint8_t>(state_.out.path_step);
  limits.dir = static_cast<std::uint8_t>(state_.out.path_dir);
  limits.runs = s.path_active || s.direct;
  limits.probing = state_.probe.busy();
  limits.stopping = state_.stop.outputs().stopping;
  limits.clear = in.clear_fault;
  limits.setting = in.setting;
  return limits;
}

SoftLimits::Inputs MotionCore::soft_limit_inputs(const Inputs& in) const {
  SoftLimits::Inputs limits;
  for (unsigned n = 0; n < state_.axes.size(); ++n) {
    const StepShaper::State& shaper = state_.axes[n].state().shaper.state();
    limits.position[n] = shaper.out.position;
    if (!shaper.begins()) continue;
    limits.counts |= static_cast<std::uint8_t>(1U << n);
    if (shaper.back) limits.back |= static_cast<std::uint8_t>(1U << n);
  }
  limits.clear = (in.clear_fault & card_map::field::kFaultSoftLimit) != 0;
  limits.setting = in.setting;
  return limits;
}

MachinePlace::Inputs MotionCore::place_inputs(const Inputs& in) const {
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  MachinePlace::Inputs place;
  place.setting = in.setting;
  place.cut = state_.stop.outputs().cut || state_.stop.closing();
  place.at_rest = state_.time_base.outputs().ratio == 0;
  place.runs = s.feed_active || s.direct;
  place.step = static_cast<std::uint8_t>(state_.out.path_step);
  place.drives = in.roles.drive_fault;
  if (has_enables_) place.disabled = state_.drives.disables(drive_inputs(in));
  return place;
}

DriveEnable::Inputs MotionCore::drive_inputs(const Inputs& in) const {
  return {in.setting, wants_drives(), state_.out.busy, in.emergency, state_.stop.outputs().fault};
}

PathCommands::Inputs MotionCore::command_inputs(const Inputs& in, const StopControl::Inputs& stop) const {
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  PathCommands::Inputs c;
  c.cut = state_.stop.outputs().cut || state_.stop.closing();
  c.caused = state_.stop.caused(stop);
  c.halt = state_.probe.halt();
  c.output = state_.sequencer.takes_output(state_.probe.drops());
  c.mark = state_.sequencer.takes_mark(state_.probe.drops());
  c.pwm = state_.sequencer.takes_pwm(state_.probe.drops());
  c.over = s.over;
  c.runs = s.path_active;
  c.load = state_.sequencer.load();
  c.setting = in.setting;
  c.speed = {s.path_active, s.feed_active && !waits_for_drives(), s.silent, state_.feed.outputs().rate,
             state_.time_base.outputs().ratio};
  return c;
}

Axis::Inputs MotionCore::axis_inputs(const Inputs& in) const {
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  const PathEngines::Outputs& engines = state_.engines.outputs();
  Axis::Inputs axis;
  axis.tick = engines.tick;
  axis.swap = engines.swap;
  axis.direct = s.direct;
  axis.silent = s.silent;
  axis.wait_tick = state_.wait_timer.tick();
  axis.load = state_.sequencer.load();
  axis.chord_word = engines.chord_word;
  axis.setting = in.setting;
  return axis;
}

void MotionCore::show_axis(unsigned n) {
  const std::uint32_t bit = 1U << n;
  const Axis::Outputs o = state_.axes[n].outputs();
  put(state_.out.step, bit, o.shaper.step);
  put(state_.out.dir, bit, o.shaper.dir);
  put(state_.out.path_step, bit, o.path_step);
  put(state_.out.path_dir, bit, o.path_dir);
  put(state_.out.live, bit, o.live);
  put(state_.out.axis_busy, bit, o.shaper.busy);
  put(state_.out.step_fault, bit, o.shaper.fault);
}

void MotionCore::clock_busy() {
  if (state_.running)
    state_.busy_left = kBusyClocks;
  else if (state_.busy_left != 0)
    --state_.busy_left;
  state_.out.busy = state_.busy_left != 0;
  const Sequencer::Outputs& s = state_.sequencer.outputs();
  state_.running = !s.idle || state_.probing || s.direct || state_.out.axis_busy != 0;
  state_.probing = state_.probe.busy();
}

}  // namespace trammel::model
