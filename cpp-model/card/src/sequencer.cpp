#include "trammel/model/sequencer.hpp"

#include <algorithm>

namespace trammel::model {

// True when a path on an engine, or a direct move, has finished after its last tick.
bool Sequencer::judged(const Inputs& in) const {
  if (!state_.drained || state_.path == Path::None) return false;
  if (state_.path == Path::Engine) return state_.now >= state_.drained_at + kEngineJudged && in.engine_done;
  return state_.now >= state_.drained_at + kDirectJudged && !in.axes_live;
}

bool Sequencer::takes(const Inputs& in) const {
  return !in.shut && !in.drives_wait && state_.owed != 0 && ticking_path() && in.engine_ready &&
         (state_.out.feed_active || state_.out.direct);
}

Sequencer::Decision Sequencer::decide(const Inputs& in) const {
  Decision d;
  d.take = takes(in);
  d.path_ends = d.take && !state_.drained && !state_.out.stale && state_.path_left == 1;
  d.path_over = judged(in);
  d.piece_ends = d.take && state_.out.feed_active && !state_.out.spent && state_.piece_left == 1;
  const PositionStreaming::Outputs& streaming = state_.streaming.outputs();
  const bool lost = streaming.lost || in.closing;
  const bool free = state_.path == Path::None || state_.out.stale || (state_.path == Path::Line && d.path_ends);
  d.at_probe_end = state_.geometry.decoded() && state_.geometry.is_probe_end();
  d.path_dropped = geometry_drops(in);
  d.piece_dropped = feed_drops(in);
  d.path_begins = path_waits() && free && !state_.out.incomplete && !lost && !in.drop;
  d.period = streaming.on && state_.path == Path::Line && d.path_ends;
  const bool barrier = state_.geometry.decoded() && state_.geometry.is_barrier() && !d.path_dropped && !lost;
  d.goes_on = (d.period || state_.out.stale) && !d.path_begins && !barrier;
  d.piece_begins = piece_waits() && !in.wait && !in.drop && !(state_.out.silent && !piece_silent()) &&
                   (!state_.out.feed_active || state_.out.spent || d.piece_ends);
  d.piece_goes_on =
      (d.piece_ends ? streaming.on && !state_.out.silent : state_.out.spent && ticking_path()) && !d.piece_begins;
  d.barrier_begins = state_.barrier == Barrier::Beginning && state_.now == state_.barrier_at;
  d.barrier_ends = barrier_over(in);
  d.barrier_done = state_.barrier == Barrier::Done;
  d.piece_runs = state_.out.feed_active;
  d.direct = state_.out.direct;
  // The state of an engine is in use until the last feed tick of its path has reached it.
  d.payload_ready = in.payload_ready && !engine_taken();
  return d;
}

// True in a barrier's last clock. The count of a WAIT_INPUT is a time-out (0: none); a PROBE_END waits until it may
// end.
bool Sequencer::barrier_over(const Inputs& in) const {
  if (state_.barrier != Barrier::Running) return false;
  if (state_.geometry.is_wait())
    return in.met || ((state_.path_count & kCountMask) != 0 && state_.now == state_.barrier_at);
  if (state_.geometry.is_probe_end()) return !in.stays;
  return state_.now == state_.barrier_at;
}

// True if one queue is at a barrier while the other still has ticks to give or to take.
bool Sequencer::mismatches() const {
  const bool path_ticks = (state_.path == Path::Line || state_.path == Path::Engine) && !state_.drained;
  const bool geometry_alone = state_.geometry_stands && (state_.out.feed_active || piece_waits());
  const bool feed_alone = state_.feed_stands && (path_ticks || path_waits());
  return (geometry_alone || feed_alone) && state_.barrier != Barrier::Done;
}

void Sequencer::clock(const Inputs& in) {
  const Decision d = decide(in);
  if (has_streaming_) clock_streaming(in, d);
  const bool mismatch = mismatches();
  const bool feed_idle = state_.feed.idle();
  state_.out.idle = state_.geometry_idle && feed_idle && in.feed_empty && !state_.out.feed_active;
  state_.geometry_idle =
      state_.geometry.idle() && in.geometry_empty && state_.path == Path::None && state_.barrier == Barrier::None;
  state_.out.mismatch = mismatch && !in.drop;
  state_.out.over = d.path_over || (d.path_ends && state_.path == Path::Line) || (state_.out.stale && !d.goes_on);
  state_.out.incomplete = d.path_over && state_.path == Path::Engine && in.missed_end;
  const bool path_drop_counts = drop_counts(state_.geometry, d.path_dropped);
  state_.record = {d.path_begins || d.barrier_begins || path_drop_counts, in.direct_go};
  count_begun(in, d, path_drop_counts, drop_counts(state_.feed, d.piece_dropped));
  clock_ticks(in, d.take);
  clock_barrier(d);
  stand(d);
  clock_path(in, d);
  clock_silence(in, d);
  clock_piece(d);
  clock_fetches(in, d);
  if (in.halt) halt(d);
  if (in.cut) cut();
  ++state_.now;
}

// A dropped command counts as begun. Exceptions: commands that never count, and a barrier that has already counted.
bool Sequencer::drop_counts(const CommandFetch& fetch, bool dropped) const {
  const bool has_counted = state_.barrier == Barrier::Running || state_.barrier == Barrier::Done;
  return dropped && !fetch.is_instant() && !has_counted;
}

// Paths and pieces are counted one clock after their swap shows, barriers as they begin.
void Sequencer::count_begun(const Inputs& in, const Decision& d, bool path_drops, bool piece_drops) {
  if (state_.path_begun || d.barrier_begins || path_drops) ++state_.out.geometry_begun;
  if (state_.piece_begun || d.barrier_begins || piece_drops) ++state_.out.feed_begun;
  state_.path_begun = d.path_begins && !in.cut;
  state_.piece_begun = d.piece_begins && !in.cut;
}

void Sequencer::clock_ticks(const Inputs& in, bool take) {
  const bool running = state_.out.feed_active || state_.out.direct;
  const bool ticking = ticking_path();
  const bool stall = state_.owed > 1;
  state_.out.tick = take;
  // During a silent piece every clock is enabled.
  const bool enabled = in.enable || state_.out.silent;
  state_.out.feed_enable = enabled && state_.out.feed_active && ticking && !stall && !in.drives_wait;
  state_.out.feed_clear = !state_.out.feed_active;
  state_.owed = running ? state_.owed + (state_.tick_arrives ? 1U : 0U) - (take ? 1U : 0U) : 0;
  state_.tick_arrives =
      state_.out.direct ? in.enable && ticking && !in.drives_wait : in.feed_tick && state_.out.feed_active;
}

// A queue has reached a barrier when it is decoded and nothing before it runs.
void Sequencer::stand(const Decision& d) {
  const bool geometry_over = d.barrier_done || d.path_dropped;
  const bool feed_over = d.barrier_done || d.piece_dropped;
  state_.geometry_stands =
      state_.geometry.decoded() && state_.geometry.is_barrier() && state_.path == Path::None && !geometry_over;
  state_.feed_stands = state_.feed.decoded() && state_.feed.is_barrier() && !state_.out.feed_active && !feed_over;
}

// The fetches see a command as taken when it begins; a barrier, in the clock after its last one.
void Sequencer::clock_fetches(const Inputs& in, const Decision& d) {
  if (state_.load.to(load_target::kTicks)) shift_in<48>(state_.path_count, state_.load.word);
  const bool over = d.barrier_done || d.path_dropped || instant() || in.probe_taken;
  state_.geometry.clock(
      {in.cut, d.path_begins || over, d.payload_ready, in.shadows_free, in.geometry_empty, in.geometry_word});
  state_.load = in.direct_load.valid ? in.direct_load : state_.geometry.bus();
  if (state_.feed.bus().to(feed_target::kTicks)) shift_in<48>(state_.piece_count, state_.feed.bus().word);
  state_.feed.clock(
      {in.cut, d.piece_begins || d.barrier_done || d.piece_dropped, !d.piece_runs, true, in.feed_empty, in.feed_word});
}

// From the clock in which both queues have reached the barrier to the one in which they continue.
void Sequencer::clock_barrier(const Decision& d) {
  if (d.barrier_begins) {
    state_.barrier = Barrier::Running;
    state_.barrier_at = state_.now + std::max<std::uint64_t>(1, state_.path_count & kCountMask);
  } else if (d.barrier_ends) {
    state_.barrier = Barrier::Done;
  } else if (state_.barrier == Barrier::Done) {
    state_.barrier = Barrier::None;
  } else if (state_.barrier == Barrier::None && state_.geometry_stands && state_.feed_stands) {
    state_.barrier = Barrier::Beginning;
    state_.barrier_at = state_.now + kBarrierBegins;
  }
}

void Sequencer::clock_path(const Inputs& in, const Decision& d) {
  state_.out.swap = d.path_begins || in.direct_go;
  if (d.take && !state_.out.stale) --state_.path_left;
  if (state_.out.swap) {
    state_.out.engine = in.direct_go ? card_map::engine::kLines : state_.geometry.engine();
    const bool on_lines = state_.out.engine == card_map::engine::kLines;
    state_.path = in.direct_go ? Path::Direct : on_lines ? Path::Line : Path::Engine;
    state_.path_left = state_.path_count & kCountMask;
    state_.drained = false;
    const bool engine_steps = !on_lines && state_.out.engine != card_map::engine::kArcGenerator;
    state_.out.active = in.direct_go ? in.direct_mask : engine_steps ? std::uint8_t{0} : state_.geometry.mask();
  } else if (d.path_ends && state_.path != Path::Line) {
    state_.drained = true;
    state_.drained_at = state_.now;
  } else if ((d.path_ends || d.path_over || state_.out.stale) && !d.goes_on) {
    state_.path = Path::None;
  }
  state_.out.stale = d.goes_on;
  state_.out.direct = state_.path == Path::Direct;
  state_.out.path_active = state_.path != Path::None;
  if (state_.out.swap || d.barrier_begins)
    state_.out.ended = false;
  else if (d.barrier_ends && state_.geometry.is_end())
    state_.out.ended = true;
}

// A cut does not end a silence: steps on their way to the axes stay silent.
void Sequencer::clock_silence(const Inputs& in, const Decision& d) {
  const bool over = state_.settled == kSettleClocks - 1;
  state_.settled = state_.out.silent && !d.piece_runs && in.engine_done && !over ? state_.settled + 1 : 0;
  if (d.piece_begins && !in.cut)
    state_.out.silent = piece_silent();
  else if (over)
    state_.out.silent = false;
}

void Sequencer::clock_piece(const Decision& d) {
  state_.out.feed_swap = d.piece_begins;
  if (d.direct) {
    state_.out.piece_class = card_map::constant::kClassFeed;
    state_.out.slew_shift = 0;
  } else if (d.piece_begins) {
    const std::uint8_t flags = state_.feed.flags();
    state_.out.piece_class = static_cast<std::uint8_t>(flags % card_map::constant::kPieceSilent);
    state_.out.slew_shift = static_cast<std::uint8_t>(flags / card_map::constant::kPieceDoubling);
  }
  const bool over = (d.piece_ends || state_.out.spent) && !d.piece_goes_on && !d.piece_begins;
  if (d.take || state_.out.spent) state_.out.moving = d.piece_runs && !over;
  if (d.take && !state_.out.spent) --state_.piece_left;
  if (d.piece_begins) {
    state_.out.feed_active = true;
    state_.piece_left = state_.piece_count & kCountMask;
  } else if (over) {
    state_.out.feed_active = false;
  }
  state_.out.spent = d.piece_goes_on;
}

PositionStreaming::Inputs Sequencer::streaming_inputs(const Inputs& in) const {
  PositionStreaming::Inputs s;
  s.cut = in.cut;
  s.setting = in.setting;
  s.write = in.arrives;
  s.whole = in.arrived;
  s.rest = state_.out.idle && in.at_rest;
  return s;
}

void Sequencer::clock_streaming(const Inputs& in, const Decision& d) {
  PositionStreaming::Inputs s = streaming_inputs(in);
  s.begin = d.path_begins || in.direct_go;
  s.ticks = state_.path_count & kCountMask;
  s.period = d.period;
  s.goes_on = d.goes_on;
  s.stale_tick = d.take && state_.out.stale;
  state_.streaming.clock(s);
}

// Ends the path, the piece and the barrier under way, except PROBE_END. Decoded commands stay.
void Sequencer::halt(const Decision& d) {
  state_.out.direct = state_.out.path_active = state_.out.feed_active = state_.out.moving = state_.out.stale =
      state_.out.spent = false;
  state_.out.piece_class = card_map::constant::kClassFeed;
  state_.out.slew_shift = 0;
  state_.path = Path::None;
  state_.drained = false;
  if (d.at_probe_end) return;
  state_.barrier = Barrier::None;
  state_.out.ended = false;
}

// Drops all that is decoded or runs; the shift chains keep their contents.
void Sequencer::cut() {
  const Outputs before = state_.out;
  state_.out = Outputs{};
  state_.out.idle = before.idle;
  state_.out.silent = before.silent;
  state_.path = Path::None;
  state_.drained = state_.tick_arrives = state_.geometry_stands = state_.feed_stands = false;
  state_.owed = 0;
  state_.barrier = Barrier::None;
  state_.record = {};
}

}  // namespace trammel::model
