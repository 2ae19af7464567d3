#include "trammel/model/motion_core.hpp"

namespace trammel::model {

namespace {

void put(std::uint32_t& word, std::uint32_t bit, bool value) { word = value ? word | bit : word & ~bit; }

unsigned idle_level_of(std::uint32_t levels, unsigned axes, unsigned axis) {
  return (levels >> axis & 1) | (levels >> (axes + axis) & 1) << 1;
}

}  // namespace

MotionCore::MotionCore(unsigned axes, std::uint32_t idle_level, bool clock_all, std::uint32_t engines,
                       const PathCommands::Config& pins)
    : clock_all_(clock_all),
      has_guard_(card_map::has_engine(engines, card_map::engine::kUnderrunHold)),
      loader_(axes),
      sequencer_(clock_all, card_map::has_engine(engines, card_map::engine::kStreaming)),
      engines_(clock_all),
      commands_(pins) {
  for (unsigned n = 0; n < axes; ++n) {
    axes_.emplace_back(n, idle_level_of(idle_level, axes, n), clock_all);
    put(out_.step, 1U << n, axes_[n].shaper().outputs().step);
    put(out_.dir, 1U << n, axes_[n].shaper().outputs().dir);
  }
}

Probe::Inputs MotionCore::probe_inputs(const Inputs& in) const {
  Probe::Inputs probe;
  probe.cut = stop_.outputs().cut;
  probe.levels = commands_.levels();
  probe.waits = sequencer_.probe_waits();
  probe.ends = sequencer_.probe_ends();
  probe.at_rest = time_base_.outputs().ratio == 0;
  probe.stopping = stop_.outputs().stopping;
  probe.clear = in.probe_clear;
  probe.load = sequencer_.load();
  return probe;
}

Sequencer::Inputs MotionCore::sequencer_inputs(const Inputs& in) const {
  Sequencer::Inputs s;
  const Probe::Inputs probe_in = probe_inputs(in);
  s.halt = probe_.halt();
  s.drop = probe_.drops();
  s.probe_taken = probe_.takes(probe_in);
  s.met = probe_.met(probe_in.levels);
  s.stays = probe_.stays(probe_in);
  s.cut = stop_.outputs().cut;
  s.geometry_empty = in.geometry_empty;
  s.feed_empty = in.feed_empty;
  s.geometry_word = in.geometry_word;
  s.feed_word = in.feed_word;
  s.wait = has_guard_ && guard_.waits(sequencer_.outputs().feed_active);
  s.setting = in.setting;
  s.arrives = in.arrival.geometry_write || in.arrival.feed_write;
  s.arrived = in.arrival.drop || in.arrival.geometry_commit || in.arrival.feed_commit;
  s.at_rest = !out_.busy;
  s.direct_go = loader_.outputs().go;
  s.direct_mask = loader_.outputs().mask;
  s.direct_load = loader_.outputs().load;
  s.enable = time_base_.outputs().enable;
  s.feed_tick = feed_.outputs().tick;
  const PathEngines::Outputs& engines = engines_.outputs();
  s.engine_ready = engines.ready;
  s.payload_ready = engines.payload_ready;
  s.shadows_free = engines.shadows_free;
  s.engine_done = engines.done;
  s.elsewhere = engines.elsewhere;
  s.axes_live = axes_live_;
  return s;
}

UnderrunGuard::Inputs MotionCore::guard_inputs(const Inputs& in, const Sequencer::Inputs& sequencer_in) const {
  const Sequencer::Outputs& s = sequencer_.outputs();
  UnderrunGuard::Inputs guard;
  guard.cut = stop_.outputs().cut || sequencer_.streaming().on;
  guard.lost = probe_.halt();
  guard.idle = s.idle && !probing_;
  guard.arrival = in.arrival;
  guard.full = in.full;
  guard.load = sequencer_.feed_load();
  guard.take = s.feed_active && sequencer_.takes(sequencer_in);
  guard.swap = s.feed_swap;
  guard.active = s.feed_active;
  guard.decoded = sequencer_.piece_waits();
  guard.ratio = time_base_.outputs().ratio;
  return guard;
}

// Each consumer before its producer: what a block sees is what stood before this edge.
void MotionCore::clock(const Inputs& in) {
  const Sequencer::Inputs sequencer_in = sequencer_inputs(in);
  const Probe::Inputs probe_in = probe_inputs(in);
  const Sequencer::Outputs& s = sequencer_.outputs();
  const StopControl::Outputs stop = stop_.outputs();
  loader_.clock({false, out_.busy, stop.closed, in.start, in.start_mask, in.loader_data});
  const bool at_rest = time_base_.outputs().ratio == 0;
  const bool fixed = s.piece_class == card_map::constant::kClassFixed;
  const bool missing = sequencer_.streaming().missing;
  const bool events = out_.step_fault != 0 || s.mismatch || s.incomplete || missing || in.abort || in.clear_fault != 0;
  const bool underrun = guard_.outputs().hold;
  const bool probe_holds = probe_.holds();
  const bool over = stop.cut || probe_.halt();
  if (has_guard_) guard_.clock(guard_inputs(in, sequencer_in));
  if (clock_all_ || events || in.setting.set || (underrun || probe_holds) != stop_.made_to_hold() ||
      !stop_.quiet(s.moving, fixed, at_rest))
    stop_.clock({out_.step_fault, s.mismatch, s.incomplete, missing, in.abort, in.clear_fault, at_rest, s.moving, fixed,
                 underrun, probe_holds, in.setting});
  clock_commands(in, stop.cut);
  clock_busy();
  axes_live_ = out_.live != 0;
  clock_axes(in, over);
  wait_timer_.clock(in.setting);
  engines_.clock({over, s.tick, s.swap, s.engine, sequencer_.load(), sequencer_.engine_taken()});
  feed_.clock({s.feed_clear, s.feed_enable, s.spent, sequencer_.feed_load(), s.feed_swap});
  time_base_.clock({stop.hold, in.setting, s.piece_class});
  if (clock_all_ || !probe_.quiet(probe_in)) probe_.clock(probe_in);
  sequencer_.clock(sequencer_in);
}

void MotionCore::clock_commands(const Inputs& in, bool cut) {
  const Sequencer::Outputs& s = sequencer_.outputs();
  PathCommands::Inputs c;
  c.cut = cut;
  c.halt = probe_.halt();
  c.output = sequencer_.takes_output(probe_.drops());
  c.mark = sequencer_.takes_mark(probe_.drops());
  c.over = s.over;
  c.runs = s.path_active;
  c.pins = in.pins;
  c.load = sequencer_.load();
  c.setting = in.setting;
  const bool events =
      cut || c.halt || c.output || c.mark || c.over || c.load.to(load_target::kCommand) || in.setting.set;
  if (clock_all_ || events || !commands_.quiet(in.pins, s.path_active)) commands_.clock(c);
}

void MotionCore::clock_axes(const Inputs& in, bool cut) {
  const Sequencer::Outputs& s = sequencer_.outputs();
  const PathEngines::Outputs& engines = engines_.outputs();
  Axis::Inputs axis;
  axis.cut = cut;
  axis.tick = engines.tick;
  axis.swap = engines.swap;
  axis.direct = s.direct;
  axis.wait_tick = wait_timer_.tick();
  axis.load = sequencer_.load();
  axis.chord_word = engines.chord_word;
  axis.setting = in.setting;
  out_.engine_step = engines.step;
  const bool common = cut || engines.tick || engines.swap || in.setting.set || axis.load.valid;
  const std::uint32_t due =
      common || clock_all_ ? ~0U : engines.step | engines.chord_load | engines.chord_swap | restless_;
  for (unsigned n = 0; n < axes_.size(); ++n) {
    const std::uint32_t bit = 1U << n;
    if ((due & bit) == 0) continue;
    axis.active = (s.active & bit) != 0;
    axis.chord_load = (engines.chord_load & bit) != 0;
    axis.chord_swap = (engines.chord_swap & bit) != 0;
    axis.engine_step = (engines.step & bit) != 0;
    axis.engine_dir = (engines.dir & bit) != 0;
    axes_[n].clock(axis);
    show_axis(n);
  }
}

void MotionCore::show_axis(unsigned n) {
  const std::uint32_t bit = 1U << n;
  const Axis::Outputs o = axes_[n].outputs();
  put(out_.step, bit, o.shaper.step);
  put(out_.dir, bit, o.shaper.dir);
  put(out_.path_step, bit, o.path_step);
  put(out_.path_dir, bit, o.path_dir);
  put(out_.live, bit, o.live);
  put(out_.axis_busy, bit, o.shaper.busy);
  put(out_.step_fault, bit, o.shaper.fault);
  put(restless_, bit, !axes_[n].quiet());
}

void MotionCore::clock_busy() {
  if (running_)
    busy_left_ = kBusyClocks;
  else if (busy_left_ != 0)
    --busy_left_;
  out_.busy = busy_left_ != 0;
  const Sequencer::Outputs& s = sequencer_.outputs();
  running_ = !s.idle || probing_ || s.direct || out_.axis_busy != 0;
  probing_ = probe_.busy();
}

}  // namespace trammel::model
