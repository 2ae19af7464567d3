#include "trammel/model/sequencer.hpp"

#include <algorithm>

namespace trammel::model {

// A path on an engine or a direct move whose last tick was taken.
bool Sequencer::judged(const Inputs& in) const {
  if (!drained_ || path_ == Path::None) return false;
  if (path_ == Path::Engine) return now_ >= drained_at_ + kEngineJudged && in.engine_done;
  return now_ >= drained_at_ + kDirectJudged && !in.axes_live;
}

bool Sequencer::takes(const Inputs& in) const {
  return owed_ != 0 && ticking_path() && in.engine_ready && (out_.feed_active || out_.direct);
}

Sequencer::Decision Sequencer::decide(const Inputs& in) const {
  Decision d;
  d.take = takes(in);
  d.path_ends = d.take && !drained_ && !out_.stale && path_left_ == 1;
  d.path_over = judged(in);
  d.piece_ends = d.take && out_.feed_active && !out_.spent && piece_left_ == 1;
  const PositionStreaming::Outputs& streaming = streaming_.outputs();
  const bool free = path_ == Path::None || out_.stale || (path_ == Path::Line && d.path_ends);
  d.at_probe_end = geometry_.decoded() && geometry_.is_probe_end();
  d.path_dropped = geometry_drops(in);
  d.piece_dropped = feed_drops(in);
  d.path_begins = path_waits() && free && !out_.incomplete && !streaming.lost && !in.drop;
  d.period = streaming.on && path_ == Path::Line && d.path_ends;
  const bool barrier = geometry_.decoded() && geometry_.is_barrier() && !d.path_dropped && !streaming.lost;
  d.goes_on = (d.period || out_.stale) && !d.path_begins && !barrier;
  d.piece_begins = piece_waits() && !in.wait && !in.drop && (!out_.feed_active || out_.spent || d.piece_ends);
  d.piece_goes_on = (d.piece_ends ? streaming.on : out_.spent && ticking_path()) && !d.piece_begins;
  d.barrier_begins = barrier_ == Barrier::Beginning && now_ == barrier_at_;
  d.barrier_ends = barrier_over(in);
  d.barrier_done = barrier_ == Barrier::Done;
  d.piece_runs = out_.feed_active;
  d.direct = out_.direct;
  // An engine's state is in use until its path's last feed tick has reached it.
  d.payload_ready = in.payload_ready && !engine_taken();
  return d;
}

// A barrier's last clock: a WAIT_INPUT's count is a time-out (0: none), a PROBE_END stays for as long as it must.
bool Sequencer::barrier_over(const Inputs& in) const {
  if (barrier_ != Barrier::Running) return false;
  if (geometry_.is_wait()) return in.met || ((path_count_ & kCountMask) != 0 && now_ == barrier_at_);
  if (geometry_.is_probe_end()) return !in.stays;
  return now_ == barrier_at_;
}

// One queue at a barrier while the other still has ticks to give or to take.
bool Sequencer::mismatches() const {
  const bool path_ticks = (path_ == Path::Line || path_ == Path::Engine) && !drained_;
  const bool geometry_alone = geometry_stands_ && (out_.feed_active || piece_waits());
  const bool feed_alone = feed_stands_ && (path_ticks || path_waits());
  return (geometry_alone || feed_alone) && barrier_ != Barrier::Done;
}

void Sequencer::clock(const Inputs& in) {
  const unsigned inputs = (in.cut ? 1U : 0) | (in.geometry_empty ? 2U : 0) | (in.feed_empty ? 4U : 0) |
                          (in.direct_go ? 8U : 0) | (in.direct_load.valid ? 16U : 0) | (in.wait ? 32U : 0) |
                          (in.halt ? 64U : 0) | (in.drop ? 128U : 0) | (in.probe_taken ? 256U : 0) |
                          (in.at_rest ? 512U : 0);
  const bool arrivals = in.setting.set || in.arrives || in.arrived;
  if (!calm_ || arrivals || inputs != calm_inputs_) {
    calm_ = !clock_all_ && calm(in);
    calm_inputs_ = inputs;
  }
  const bool take = takes(in);
  const bool ends = take && ticks_left() == 1;
  if (!calm_ || ends || barrier_over(in)) {
    calm_ = false;
    return clock_all(in);
  }
  clock_ticks(in, take);
  path_left_ -= take ? 1 : 0;
  piece_left_ -= take && !out_.spent ? 1 : 0;
  out_.moving = out_.moving || take;
  ++now_;
}

void Sequencer::clock_all(const Inputs& in) {
  const Decision d = decide(in);
  if (has_streaming_) clock_streaming(in, d);
  const bool mismatch = mismatches();
  const bool feed_idle = feed_.idle();
  out_.idle = geometry_idle_ && feed_idle && in.feed_empty && !out_.feed_active;
  geometry_idle_ = geometry_.idle() && in.geometry_empty && path_ == Path::None && barrier_ == Barrier::None;
  out_.mismatch = mismatch && !in.drop;
  out_.over = d.path_over || (d.path_ends && path_ == Path::Line) || (out_.stale && !d.goes_on);
  out_.incomplete = d.path_over && path_ == Path::Engine && in.elsewhere;
  const bool path_drop_counts = drop_counts(geometry_, d.path_dropped);
  record_ = {d.path_begins || d.barrier_begins || path_drop_counts, in.direct_go};
  count_begun(in, d, path_drop_counts, drop_counts(feed_, d.piece_dropped));
  clock_ticks(in, d.take);
  clock_barrier(d);
  stand(d);
  clock_path(in, d);
  clock_piece(d);
  clock_fetches(in, d);
  if (in.halt) halt(d);
  if (in.cut) cut();
  ++now_;
}

// What is dropped counts as if it began, but for what never counts and a barrier that has.
bool Sequencer::drop_counts(const CommandFetch& fetch, bool dropped) const {
  const bool has_counted = barrier_ == Barrier::Running || barrier_ == Barrier::Done;
  return dropped && !fetch.is_instant() && !has_counted;
}

// Paths and pieces count a clock after their swap shows, barriers as they begin; a cut shows in the counters last.
void Sequencer::count_begun(const Inputs& in, const Decision& d, bool path_drops, bool piece_drops) {
  if (cut_before_) out_.geometry_begun = out_.feed_begun = 0;
  cut_before_ = in.cut;
  if (!in.cut) {
    if (path_begun_ || d.barrier_begins || path_drops) ++out_.geometry_begun;
    if (piece_begun_ || d.barrier_begins || piece_drops) ++out_.feed_begun;
  }
  path_begun_ = d.path_begins && !in.cut;
  piece_begun_ = d.piece_begins && !in.cut;
}

// Ticks made, owed and taken.
void Sequencer::clock_ticks(const Inputs& in, bool take) {
  const bool running = out_.feed_active || out_.direct;
  const bool ticking = ticking_path();
  const bool stall = owed_ > 1;
  out_.tick = take;
  out_.feed_enable = in.enable && out_.feed_active && ticking && !stall;
  out_.feed_clear = !out_.feed_active;
  owed_ = running ? owed_ + (tick_arrives_ ? 1U : 0U) - (take ? 1U : 0U) : 0;
  tick_arrives_ = out_.direct ? in.enable && ticking : in.feed_tick && out_.feed_active;
}

// A decoded barrier with nothing before it that runs.
void Sequencer::stand(const Decision& d) {
  const bool geometry_over = d.barrier_done || d.path_dropped;
  const bool feed_over = d.barrier_done || d.piece_dropped;
  geometry_stands_ = geometry_.decoded() && geometry_.is_barrier() && path_ == Path::None && !geometry_over;
  feed_stands_ = feed_.decoded() && feed_.is_barrier() && !out_.feed_active && !feed_over;
}

// The fetches see a command as taken when it begins, a barrier in the clock after its last one.
void Sequencer::clock_fetches(const Inputs& in, const Decision& d) {
  if (load_.to(load_target::kTicks)) shift_in<48>(path_count_, load_.word);
  const bool over = d.barrier_done || d.path_dropped || instant() || in.probe_taken;
  geometry_.clock(
      {in.cut, d.path_begins || over, d.payload_ready, in.shadows_free, in.geometry_empty, in.geometry_word});
  load_ = in.direct_load.valid ? in.direct_load : geometry_.bus();
  if (feed_.bus().to(feed_target::kTicks)) shift_in<48>(piece_count_, feed_.bus().word);
  feed_.clock(
      {in.cut, d.piece_begins || d.barrier_done || d.piece_dropped, !d.piece_runs, true, in.feed_empty, in.feed_word});
}

// From both queues standing at it to the clock in which they go on.
void Sequencer::clock_barrier(const Decision& d) {
  if (d.barrier_begins) {
    barrier_ = Barrier::Running;
    barrier_at_ = now_ + std::max<std::uint64_t>(1, path_count_ & kCountMask);
  } else if (d.barrier_ends) {
    barrier_ = Barrier::Done;
  } else if (barrier_ == Barrier::Done) {
    barrier_ = Barrier::None;
  } else if (barrier_ == Barrier::None && geometry_stands_ && feed_stands_) {
    barrier_ = Barrier::Beginning;
    barrier_at_ = now_ + kBarrierBegins;
  }
}

void Sequencer::clock_path(const Inputs& in, const Decision& d) {
  out_.swap = d.path_begins || in.direct_go;
  if (d.take && !out_.stale) --path_left_;
  if (out_.swap) {
    out_.engine = in.direct_go ? card_map::engine::kLines : geometry_.engine();
    const bool on_lines = out_.engine == card_map::engine::kLines;
    path_ = in.direct_go ? Path::Direct : on_lines ? Path::Line : Path::Engine;
    path_left_ = path_count_ & kCountMask;
    drained_ = false;
    const bool steps_elsewhere = !on_lines && out_.engine != card_map::engine::kArcGenerator;
    out_.active = in.direct_go ? in.direct_mask : steps_elsewhere ? std::uint8_t{0} : geometry_.mask();
  } else if (d.path_ends && path_ != Path::Line) {
    drained_ = true;
    drained_at_ = now_;
  } else if ((d.path_ends || d.path_over || out_.stale) && !d.goes_on) {
    path_ = Path::None;
  }
  out_.stale = d.goes_on;
  out_.direct = path_ == Path::Direct;
  out_.path_active = path_ != Path::None;
  if (out_.swap || d.barrier_begins)
    out_.ended = false;
  else if (d.barrier_ends && geometry_.is_end())
    out_.ended = true;
}

void Sequencer::clock_piece(const Decision& d) {
  out_.feed_swap = d.piece_begins;
  if (d.direct)
    out_.piece_class = card_map::constant::kClassFeed;
  else if (d.piece_begins)
    out_.piece_class = feed_.flags();
  const bool over = (d.piece_ends || out_.spent) && !d.piece_goes_on && !d.piece_begins;
  if (d.take || out_.spent) out_.moving = d.piece_runs && !over;
  if (d.take && !out_.spent) --piece_left_;
  if (d.piece_begins) {
    out_.feed_active = true;
    piece_left_ = piece_count_ & kCountMask;
  } else if (over) {
    out_.feed_active = false;
  }
  out_.spent = d.piece_goes_on;
}

bool Sequencer::settled(const Inputs& in) const {
  if (!calm(in) || barrier_over(in)) return false;
  if (ticking()) return in.engine_ready && owed_ <= 1;
  return !takes(in) && !tick_arrives_ && !out_.tick && !out_.feed_enable && !in.feed_tick &&
         (out_.feed_active || owed_ == 0);
}

PositionStreaming::Inputs Sequencer::streaming_inputs(const Inputs& in) const {
  PositionStreaming::Inputs s;
  s.cut = in.cut;
  s.setting = in.setting;
  s.write = in.arrives;
  s.whole = in.arrived;
  s.rest = out_.idle && in.at_rest;
  return s;
}

void Sequencer::clock_streaming(const Inputs& in, const Decision& d) {
  PositionStreaming::Inputs s = streaming_inputs(in);
  s.begin = d.path_begins || in.direct_go;
  s.ticks = path_count_ & kCountMask;
  s.period = d.period;
  s.goes_on = d.goes_on;
  s.stale_tick = d.take && out_.stale;
  streaming_.clock(s);
}

// With inputs as these nothing is decided but ticks, and a dwell's end.
bool Sequencer::calm(const Inputs& in) const {
  const bool nothing_shows = !(out_.swap || out_.feed_swap || out_.mismatch || out_.incomplete || out_.over) &&
                             !(path_begun_ || piece_begun_ || cut_before_ || in.cut || in.direct_go) &&
                             !(load_.valid || in.direct_load.valid || record_.command || record_.direct);
  if (!nothing_shows || drained_ || path_ == Path::Direct || !(geometry_.quiet() && feed_.quiet())) return false;
  if ((geometry_.idle() && !in.geometry_empty) || (feed_.idle() && !in.feed_empty)) return false;
  if (geometry_.waiting() && path_ != Path::Engine) return false;
  if (instant() || in.halt || in.probe_taken) return false;
  if (out_.stale || (out_.spent && !ticking_path())) return false;
  if (has_streaming_ && !streaming_.quiet(streaming_inputs(in))) return false;
  if (geometry_drops(in) || feed_drops(in)) return false;
  const bool piece_may_begin = piece_waits() && !in.wait;
  if ((path_waits() && path_ == Path::None) || (piece_may_begin && (!out_.feed_active || out_.spent))) return false;
  if (barrier_ == Barrier::Beginning || barrier_ == Barrier::Done || (mismatches() && !in.drop)) return false;
  const bool geometry_stands = geometry_.decoded() && geometry_.is_barrier() && path_ == Path::None;
  const bool feed_stands = feed_.decoded() && feed_.is_barrier() && !out_.feed_active;
  if (geometry_stands != geometry_stands_ || feed_stands != feed_stands_) return false;
  if (barrier_ == Barrier::None && geometry_stands && feed_stands) return false;
  const bool geometry_idle = geometry_.idle() && in.geometry_empty && path_ == Path::None && barrier_ == Barrier::None;
  const bool idle = geometry_idle && feed_.idle() && in.feed_empty && !out_.feed_active;
  return geometry_idle == geometry_idle_ && idle == out_.idle && out_.feed_clear != out_.feed_active;
}

void Sequencer::jump(std::uint64_t clocks, std::uint64_t ticks, unsigned in_flight, bool feed_enable) {
  now_ += clocks;
  if (!ticking()) return;
  path_left_ -= ticks;
  out_.moving = out_.moving || ticks != 0;
  if (!out_.spent) piece_left_ -= ticks;
  tick_arrives_ = (in_flight >> kArrives & 1) != 0;
  owed_ = in_flight >> kOwed & 1;
  out_.tick = (in_flight >> kTaken & 1) != 0;
  out_.feed_enable = feed_enable;
}

// What runs is over where it stands, a barrier too, unless it is PROBE_END; what is decoded stays.
void Sequencer::halt(const Decision& d) {
  out_.direct = out_.path_active = out_.feed_active = out_.moving = out_.stale = out_.spent = false;
  out_.piece_class = card_map::constant::kClassFeed;
  path_ = Path::None;
  drained_ = false;
  if (d.at_probe_end) return;
  barrier_ = Barrier::None;
  out_.ended = false;
}

// Everything decoded or running is gone; the chains keep what they have.
void Sequencer::cut() {
  const Outputs before = out_;
  out_ = Outputs{};
  out_.idle = before.idle;
  out_.geometry_begun = before.geometry_begun;
  out_.feed_begun = before.feed_begun;
  path_ = Path::None;
  drained_ = tick_arrives_ = geometry_stands_ = feed_stands_ = false;
  owed_ = 0;
  barrier_ = Barrier::None;
  record_ = {};
}

}  // namespace trammel::model
