#include "trammel/skip/jump.hpp"

#include <algorithm>

#include "trammel/card_map.hpp"
#include "trammel/skip/axis.hpp"
#include "trammel/skip/commands.hpp"
#include "trammel/skip/control.hpp"
#include "trammel/skip/feed_generator.hpp"
#include "trammel/skip/path_engines.hpp"
#include "trammel/skip/sequencer.hpp"
#include "trammel/skip/time_base.hpp"
#include "trammel/skip/underrun_guard.hpp"

namespace trammel::skip {

namespace {

constexpr unsigned kTakenBits = 0x1E0;      // bits of in_flight: taken, but not yet at the axes
constexpr unsigned kPrescaledBits = 0x1C0;  // bits of in_flight: at the prescaler, but not yet at the axes

std::uint64_t count(unsigned bits) {
  std::uint64_t ones = 0;
  for (; bits != 0; bits &= bits - 1) ++ones;
  return ones;
}

// Clocks for which the ratio is known in advance; 0 if it is not.
std::uint64_t ratio_known_for(model::MotionCore& core) {
  return TimeBaseAhead(core.state().time_base).clocks_ahead(core.time_inputs());
}

// Puts the step of a tick taken `clocks_ago` clocks ago in flight; it is not yet at the shaper.
void place_step(model::Axis& axis, std::uint64_t clocks_ago, bool backwards) {
  model::Axis::State& s = axis.state();
  PulsesAhead(s.generator).place_step(clocks_ago, backwards);
  s.path_step = clocks_ago == 3;
  if (clocks_ago >= 3) s.path_dir = backwards;
}

// True if no step is on its way to the shaper, and none waits there.
bool ready_to_jump(model::Axis& axis) {
  model::Axis::State& s = axis.state();
  return at_rest(s.generator) && !s.path_step && no_step_waits(s.shaper) && s.times.mode == s.shaper.state().mode &&
         !s.generator.outputs().live && PulsesAhead(s.generator).within_a_pulse();
}

}  // namespace

Jump::Jump(model::MotionCore& core, model::StepRecord& record, std::uint64_t cycle, std::uint64_t limit)
    : core_(core),
      record_(record),
      cycle_(cycle),
      end_(
          static_cast<std::int64_t>(std::min({limit, counting_clocks(core.state().sequencer), ratio_known_for(core)}))),
      ticking_(core.state().sequencer.ticking()),
      chords_(ticking_ && on_chords(core.state().engines)),
      to_axis_(chords_ ? 10 : 9),
      first_(core.state().sequencer.outputs().feed_enable ? 1 : 0),
      second_(core.state().time_base.outputs().enable ? 1 : 0),
      axes_(static_cast<unsigned>(core.state().axes.size())) {
  if (!ticking_) return;
  for (unsigned k = 0; k < 3; ++k) in_flight_ |= carried(core.state().feed, k) ? 1U << k : 0;
  in_flight_ |= in_flight(core.state().sequencer) | EngineTicks(core.state().engines).in_flight();
  for (int k = 8; k >= 0; --k) {
    if ((in_flight_ >> k & 1) != 0) flight_[flying_++] = -k;
  }
  taken_before_ = record.taken() - count(in_flight_ & kTakenBits);
}

std::uint64_t Jump::go() {
  if (ticking_) walk();
  if (end_ <= 0 || (end_ < kShortest && !moved_)) return 0;
  commit();
  return static_cast<std::uint64_t>(end_);
}

// Accumulations of the feed generator at edges 1 .. `edge`. The enables on their way at the start come first.
std::uint64_t Jump::accumulations_to(std::int64_t edge) const {
  if (edge < 2) return edge < 1 ? 0 : first_;
  return first_ + second_ + TimeBaseAhead(core_.state().time_base).enabled_in(static_cast<std::uint64_t>(edge - 2));
}

// The edge of an accumulation; accumulations are numbered from 1.
std::int64_t Jump::edge_of(std::uint64_t accumulation) const {
  if (accumulation <= first_) return 1;
  if (accumulation <= first_ + second_) return 2;
  return 2 +
         static_cast<std::int64_t>(TimeBaseAhead(core_.state().time_base).clocks_for(accumulation - first_ - second_));
}

// The first tick that must not be taken, or must not reach the prescaler.
std::uint64_t Jump::first_that_stops() const {
  std::uint64_t left = core_.state().sequencer.ticks_left();
  if (core_.guards()) left = std::min(left, ticks_to_change(core_.state().guard));
  const std::uint64_t last = left + count(in_flight_ & kTakenBits);
  const std::uint64_t stops = EngineTicks(core_.state().engines).tick_that_stops();
  if (stops >= last) return last;
  return std::min(last, stops + count(in_flight_ & kPrescaledBits));
}

// Finds the axis's next step, from the present state of the generator, which has passed t.ticks ticks.
void Jump::look_ahead(AxisCursor& t, model::PulseGenerator& generator) const {
  const std::uint64_t silent = PulsesAhead(generator).silent_ticks();
  t.next = kNever;
  if (silent == UINT64_MAX) return;
  t.at = t.ticks + silent + 1;
  if (!chords_) {
    t.next = t.at;
    return;
  }
  const std::uint64_t prescaled = PulsesAhead(core_.state().engines.state().prescaler).ticks_until(t.at);
  if (prescaled != UINT64_MAX) t.next = prescaled + count(in_flight_ & kPrescaledBits);
}

void Jump::walk() {
  const std::uint64_t stop = first_that_stops();
  for (unsigned n = 0; n < axes_; ++n) look_ahead(cursors_[n], core_.state().axes[n].state().generator);
  for (;;) {
    std::uint64_t next = stop;
    for (unsigned n = 0; n < axes_; ++n) next = std::min(next, cursors_[n].next);
    model::FeedGenerator generator;
    std::uint64_t done = done_;
    std::int64_t edge = 0;
    const bool in_flight = next <= flying_;
    if (in_flight)
      edge = flight_[static_cast<std::size_t>(next - 1)];
    else if (!find(next, generator, done, edge))
      return;
    if (next == stop) return stop_before(stop);
    const std::int64_t arrival = edge + to_axis_;
    // Ticks are at least one clock apart. If the stop is at least this many ticks away, it comes after this tick's
    // arrival.
    const bool close = stop - next < static_cast<std::uint64_t>(to_axis_ - kLastTake);
    if (close || arrival > end_) stop_before(stop);
    if (arrival > end_) return;
    report_until(arrival - 1);
    if (!step_all(next, arrival)) {
      end_ = arrival - 1;
      return;
    }
    moved_ = true;
    if (in_flight) continue;
    core_.state().feed = generator;
    done_ = done;
    made_ = next - flying_;
    edge_ = edge;
  }
}

// Ends the jump before a tick that must not be taken.
void Jump::stop_before(std::uint64_t tick) {
  model::FeedGenerator generator;
  std::uint64_t done = 0;
  std::int64_t edge = 0;
  if (tick <= flying_)
    edge = flight_[static_cast<std::size_t>(tick - 1)];
  else if (!find(tick, generator, done, edge))
    return;
  end_ = std::min(end_, edge + kLastTake);
}

// Finds the edge at which a tick is made, and the generator's state there; false if that is after the end.
bool Jump::find(std::uint64_t tick, model::FeedGenerator& generator, std::uint64_t& done, std::int64_t& edge) const {
  generator = core_.state().feed;
  const std::uint64_t wanted = tick - flying_ - made_;
  const FeedAhead::Advanced gone = FeedAhead(generator).advance(accumulations_to(end_) - done_, wanted);
  if (gone.carries < wanted) return false;
  done = done_ + gone.enables;
  edge = edge_of(done);
  return true;
}

// Makes the steps of this tick on all its axes; returns false and makes none if one axis may not step.
bool Jump::step_all(std::uint64_t tick, std::int64_t arrival) {
  std::array<std::int64_t, card_map::kMaxAxes> served;
  std::array<model::StepShaper, card_map::kMaxAxes> after;
  for (unsigned n = 0; n < axes_; ++n) {
    if (cursors_[n].next == tick && !may_step(n, arrival, after[n], served[n])) return false;
  }
  for (unsigned n = 0; n < axes_; ++n) {
    if (cursors_[n].next != tick) continue;
    step(n, tick, arrival, served[n]);
    cursors_[n].after = after[n];
  }
  return true;
}

// Computes the pulse of a step. True if it is the only one under way and cannot be late at a wait tick.
bool Jump::may_step(unsigned axis, std::int64_t arrival, model::StepShaper& after, std::int64_t& served) const {
  const AxisCursor& t = cursors_[axis];
  if (t.under_way && t.served >= arrival) return false;
  model::StepShaper::Inputs in = core_.state().axes[axis].state().times;
  in.step = in.wait_tick = false;
  after = t.under_way ? t.after : core_.state().axes[axis].state().shaper;
  const std::int64_t from = t.under_way ? t.served : t.edge;
  served = arrival + kToShaper;
  pass(after, in, static_cast<std::uint64_t>(served - 1 - from));
  const std::uint32_t position = after.outputs().position;
  in.step = true;
  in.dir = core_.state().axes[axis].state().generator.state().increment < 0;
  after.clock(in);
  in.step = false;
  const std::int64_t late = served + core_.state().wait_timer.limit();
  for (; after.outputs().position == position; ++served) {
    if (served >= late) return false;
    after.clock(in);
  }
  return !core_.has_soft_limits() ||
         !core_.state().soft_limits.too_far(axis, after.outputs().position, after.state().back);
}

void Jump::step(unsigned axis, std::uint64_t tick, std::int64_t arrival, std::int64_t served) {
  AxisCursor& t = cursors_[axis];
  model::Axis& a = core_.state().axes[axis];
  if (t.under_way) {
    a.state().shaper = t.after;
    place_step(a, kToShaper, t.backwards);
    t.edge = t.served;
  }
  PulsesAhead(a.state().generator).silent_ticks(t.at - 1 - t.ticks);
  t.backwards = PulsesAhead(a.state().generator).step_at_once();
  t.ticks = t.at;
  // The tick shows 4 edges before it reaches the axes.
  record_.place(cycle_ + static_cast<std::uint64_t>(arrival) - 4,
                chords_ ? record_.path_ticks() + t.at : taken_before_ + tick);
  look_ahead(t, a.state().generator);
  t.under_way = t.path_due = t.pin_due = true;
  t.arrival = arrival;
  t.served = served;
  next_report_ = std::min({next_report_, arrival + kToPath, served});
}

// Reports in order of time: at the same time pins before the path, then by axis.
void Jump::report_until(std::int64_t edge) {
  while (next_report_ <= edge) {
    std::int64_t first = INT64_MAX;
    for (unsigned n = 0; n < axes_; ++n) {
      const AxisCursor& t = cursors_[n];
      if (t.pin_due) first = std::min(first, t.served);
      if (t.path_due) first = std::min(first, t.arrival + kToPath);
    }
    next_report_ = first;
    if (first > edge) return;
    const std::uint64_t cycle = cycle_ + static_cast<std::uint64_t>(first);
    std::uint8_t counts = 0;
    std::uint8_t back = 0;
    for (unsigned n = 0; n < axes_; ++n) {
      AxisCursor& t = cursors_[n];
      if (!t.pin_due || t.served != first) continue;
      counts |= static_cast<std::uint8_t>(1U << n);
      if (t.backwards) back |= static_cast<std::uint8_t>(1U << n);
      record_.pin(cycle, n, t.after.outputs().position);
      t.pin_due = false;
    }
    if (counts != 0 && core_.has_soft_limits()) look_at_limits(first, counts, back);
    for (unsigned n = 0; n < axes_; ++n) {
      AxisCursor& t = cursors_[n];
      if (!t.path_due || t.arrival + kToPath != first) continue;
      record_.line_step(cycle, n, t.backwards);
      t.path_due = false;
    }
  }
}

// Advances the soft limits to this edge, at which these axes make pulses, all of them within their limits.
void Jump::look_at_limits(std::int64_t edge, std::uint8_t counts, std::uint8_t back) {
  model::SoftLimits& limits = core_.state().soft_limits;
  pass(limits, static_cast<std::uint64_t>(edge - looked_until_) - 1);
  limits.look(counts);
  limits.state().back = static_cast<std::uint8_t>((limits.state().back & ~counts) | back);
  looked_until_ = edge;
}

void Jump::commit() {
  report_until(end_);
  if (core_.has_soft_limits()) pass(core_.state().soft_limits, static_cast<std::uint64_t>(end_ - looked_until_));
  const auto clocks = static_cast<std::uint64_t>(end_);
  std::uint64_t at_axes = 0;
  std::uint64_t taken = 0;
  bool feed_enable = false;
  unsigned in_flight = 0;
  if (ticking_) {
    in_flight = commit_generator();
    const std::uint64_t all = flying_ + made_;
    taken = all - count(in_flight & 0x1F) - count(in_flight_ & kTakenBits);
    const std::uint64_t prescaled = all - count(in_flight & 0x3F) - count(in_flight_ & kPrescaledBits);
    at_axes = chords_ ? commit_chords(prescaled, in_flight) : all - count(in_flight & 0x1FF);
    EngineTicks(core_.state().engines).jump(prescaled, in_flight);
    const TimeBaseAhead time(core_.state().time_base);
    feed_enable = clocks < 2 ? second_ != 0 : time.enabled_in(clocks - 1) != time.enabled_in(clocks - 2);
    record_.take(taken);
    if (!chords_) place_takes(in_flight);
  }
  for (unsigned n = 0; n < axes_; ++n) commit_axis(n, at_axes);
  advance(core_.state().sequencer, clocks, taken, in_flight, feed_enable);
  if (core_.guards())
    advance(core_.state().guard, clocks, taken, in_flight >> skip::kTaken);
  else
    advance(core_.state().guard, clocks, 0, 0);
  advance(core_.state().time_base, {}, clocks);
  pass(core_.state().wait_timer, clocks);
  advance(core_.state().watchdog, {}, clocks);
  core_.state().out.engine_step = 0;
}

// Brings the generator to the end of the jump. The last clocks run one by one, to find the ticks in flight; bit k of
// the result belongs to the edge k before the end.
unsigned Jump::commit_generator() {
  constexpr std::int64_t kTail = 10;
  unsigned in_flight = edge_ == 0 ? in_flight_ : 1;
  if (end_ > edge_ + kTail) {
    edge_ = end_ - kTail;
    const std::uint64_t done = accumulations_to(edge_);
    made_ += FeedAhead(core_.state().feed).advance(done - done_, kNever).carries;
    done_ = done;
    in_flight = 0;
  }
  while (edge_ != end_) {
    model::FeedGenerator::Inputs in;
    const std::uint64_t done = accumulations_to(++edge_);
    in.enable = done != done_;
    in.freeze = core_.state().sequencer.outputs().spent;
    done_ = done;
    core_.state().feed.clock(in);
    const bool carry = carried(core_.state().feed, 0);
    made_ += carry ? 1 : 0;
    in_flight = in_flight << 1 | (carry ? 1U : 0U);
  }
  return in_flight;
}

// Passes the feed ticks that the prescaler has taken; returns the path ticks at the axes.
std::uint64_t Jump::commit_chords(std::uint64_t prescaled, unsigned in_flight) {
  const EngineTicks::PathTicks made = EngineTicks(core_.state().engines).jump_chords(prescaled, in_flight);
  record_.take_path_ticks(made.at_axes);
  if (made.visible) record_.chord_tick(cycle_ + static_cast<std::uint64_t>(end_));
  return made.at_axes;
}

// Records the ticks that are taken and not yet at the axes.
void Jump::place_takes(unsigned in_flight) {
  std::uint64_t tick = record_.taken();
  for (unsigned k = kTaken; k < static_cast<unsigned>(to_axis_); ++k) {
    if ((in_flight >> k & 1) != 0) record_.place(cycle_ + static_cast<std::uint64_t>(end_) - (k - kTaken), tick--);
  }
}

void Jump::commit_axis(unsigned axis, std::uint64_t ticks) {
  const AxisCursor& t = cursors_[axis];
  model::Axis& a = core_.state().axes[axis];
  if (ticking_) PulsesAhead(a.state().generator).silent_ticks(ticks - t.ticks);
  model::StepShaper::Inputs in = a.state().times;
  in.step = in.wait_tick = false;
  const std::int64_t at_shaper = t.arrival + kToShaper;
  if (t.under_way && t.served <= end_) {
    a.state().shaper = t.after;
    pass(a.state().shaper, in, static_cast<std::uint64_t>(end_ - t.served));
  } else if (t.under_way && at_shaper <= end_) {
    pass(a.state().shaper, in, static_cast<std::uint64_t>(at_shaper - 1 - t.edge));
    model::WaitTimer timer = core_.state().wait_timer;
    pass(timer, static_cast<std::uint64_t>(at_shaper - 1));
    in.dir = t.backwards;
    for (std::int64_t edge = at_shaper; edge <= end_; ++edge) {
      in.step = edge == at_shaper;
      in.wait_tick = timer.tick();
      a.state().shaper.clock(in);
      timer.clock({});
    }
  } else {
    pass(a.state().shaper, in, static_cast<std::uint64_t>(end_ - t.edge));
  }
  if (t.under_way) place_step(a, static_cast<std::uint64_t>(std::min(end_ - t.arrival, kToShaper)), t.backwards);
  core_.show_axis(axis);
  if (t.under_way && (t.edge != 0 || t.arrival + kToPath <= end_)) core_.state().limits.state().axes[axis].moved = true;
  // A step that shows on the path in the jump's last clock is seen in the next one.
  if (t.under_way && (t.edge != 0 || t.arrival + kToPath < end_))
    core_.state().place.state().moved |= static_cast<std::uint8_t>(1U << axis);
}

namespace {

// True if neither causes nor buttons change. While a limit is active, each step must be checked.
bool limits_rest(model::MotionCore& core, const model::MotionCore::Inputs& in) {
  const bool pressed = (in.roles.limit_minus | in.roles.limit_plus) != 0;
  if (pressed && core.state().sequencer.ticking()) return false;
  return horizon(core.state().limits, core.limit_inputs(in)) != 0 && horizon(core.state().buttons, in.roles) != 0;
}

model::PathCommands::Inputs commands_of(model::MotionCore& core, const model::MotionCore::Inputs& in) {
  return core.command_inputs(in, core.stop_inputs(in, core.sequencer_inputs(in, core.probe_inputs(in))));
}

// True if nothing is decided and the host makes no access.
bool may_jump(model::MotionCore& core, const model::MotionCore::Inputs& in) {
  model::MotionCore::State& m = core.state();
  const model::Sequencer::Outputs& s = m.sequencer.outputs();
  if (s.swap || s.feed_swap || s.direct || s.silent || m.out.path_step != 0 || m.axes_live || m.out.step_fault != 0)
    return false;
  if (in.setting.set || in.abort || in.clear_fault != 0 || in.probe_clear || in.start) return false;
  if (horizon(m.loader, {}) == 0) return false;
  if (core.has_machine_inputs() && !limits_rest(core, in)) return false;
  if (core.has_soft_limits() && horizon(m.soft_limits, core.soft_limit_inputs(in)) == 0) return false;
  if (horizon(m.place, core.place_inputs(in)) == 0) return false;
  if (core.waits_for_drives() && (m.sequencer.ticking() || m.sequencer.outputs().direct)) return false;
  if (!only_ticks_move(m.engines) || ratio_known_for(core) == 0) return false;
  if (horizon(m.probe, core.probe_inputs(in)) == 0 || m.probing != m.probe.busy()) return false;
  for (model::Axis& axis : m.axes) {
    if (!ready_to_jump(axis)) return false;
  }
  if (m.running != (!s.idle || m.probing || m.out.axis_busy != 0) ||
      m.busy_left != (m.running ? model::MotionCore::kBusyClocks : 0))
    return false;
  if (s.idle && m.out.axis_busy != 0) return false;
  const model::Sequencer::Inputs sequencer = core.sequencer_inputs(in, core.probe_inputs(in));
  // At rest a pulse under way may end within the jump; the clocks without a pulse are counted from its end.
  const model::StopControl::Inputs stop = core.stop_inputs(in, sequencer);
  if (horizon(m.commands, core.command_inputs(in, stop)) == 0) return false;
  if (horizon(m.stop, stop) == 0 || ((stop.at_rest || m.stop.shut()) && !m.stop.settled())) return false;
  if (!only_counts_move(m.sequencer, sequencer)) return false;
  if (core.guards() && !only_counts_move(m.guard, core.guard_inputs(in, sequencer))) return false;
  return m.sequencer.ticking() ||
         (at_rest(m.feed) && at_rest(m.engines) && (!s.feed_clear || m.feed.state().phase == 0));
}

}  // namespace

std::uint64_t advance(model::MotionCore& core, std::uint64_t limit, const model::MotionCore::Inputs& in,
                      std::uint64_t cycle, model::StepRecord& record) {
  constexpr std::uint64_t kLongest = std::uint64_t{1} << 40;
  limit = std::min({limit, kLongest, horizon(core.state().watchdog, in.setting)});
  if (core.has_enables()) {
    limit = std::min({limit, horizon(core.state().drives, core.drive_inputs(in)),
                      horizon(core.state().health, core.health_inputs(in))});
  }
  if (limit == 0 || !may_jump(core, in)) return 0;
  const model::DriveEnable::Inputs drives = core.drive_inputs(in);
  const model::PathCommands::Inputs commands = commands_of(core, in);
  limit = std::min(limit, horizon(core.state().commands, commands));
  const std::uint64_t gone = Jump(core, record, cycle, limit).go();
  if (gone != 0) advance(core.state().commands, commands, gone);
  if (core.has_enables()) {
    advance(core.state().drives, drives, gone);
    advance(core.state().health, {}, gone);
  }
  return gone;
}

}  // namespace trammel::skip
