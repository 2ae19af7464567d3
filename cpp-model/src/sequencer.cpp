#include "trammel/model/sequencer.hpp"

#include <algorithm>

namespace trammel::model {

namespace {

constexpr std::uint64_t kCountMask = (std::uint64_t{1} << 40) - 1;
constexpr int kSettleClocks = 7;

std::uint64_t count_of(std::uint64_t chain) { return chain & kCountMask; }
std::uint8_t number_of(std::uint64_t chain) { return static_cast<std::uint8_t>(chain >> 40); }

}  // namespace

// What the state of this clock decides, before anything moves.
struct Sequencer::Wires {
  bool clear;
  bool take;
  bool ending;     // the path's last tick is taken
  bool over;       // the engine has finished behind it
  bool swap;       // the decoded path begins
  bool path_load;  // the path's counter is loaded for a path
  bool feed_swap;
  bool feed_ending;
  bool path_waits;   // a decoded path
  bool piece_waits;  // a decoded piece
  bool barrier_done;
};

void Sequencer::work(const Inputs& in) {
  Wires w{};
  w.barrier_done = barrier_.done();
  w.clear = in.abort || in.reset;
  w.take = gate_.owed() && taking_ && path_gate_.ready() && go_ && (out_.feed_active || out_.direct);
  w.ending = w.take && path_left_.last() && !drain_;
  w.over = settled_ && (arc_ ? path_gate_.empty() : !in.axes_live);
  w.path_waits = geometry_.valid() && geometry_.is_path();
  w.piece_waits = feed_.valid() && feed_.is_feed();
  w.swap = w.path_waits && go_ && (idle_ || (w.ending && !arc_ && !out_.direct));
  w.path_load = w.swap || in.direct_go;
  w.feed_ending = w.take && feed_left_.last();
  w.feed_swap = w.piece_waits && go_ && (!out_.feed_active || w.feed_ending);

  const bool fault_event = out_.mismatch || out_.incomplete;
  const bool geometry_at = geometry_at_;
  const bool feed_at = feed_at_;
  const bool stall = gate_.stall();
  const bool feed_active = out_.feed_active;
  const bool taking = taking_;
  const bool direct = out_.direct;
  const bool feed_idle = feed_.idle();

  out_.idle = geometry_idle_ && feed_idle && in.feed_empty && !feed_active;
  geometry_idle_ = geometry_.idle() && in.geometry_empty && !out_.path_active && barrier_.idle();
  out_.mismatch =
      ((geometry_at && (feed_active || w.piece_waits)) || (feed_at && ((taking && !direct) || w.path_waits))) && go_ &&
      !w.barrier_done && !w.clear;
  step_path(in, w);
  step_feed(in, w);

  out_.tick = w.take && !w.clear;
  out_.feed_enable = in.enable && feed_active && taking && !stall && go_ && !w.clear;
  out_.feed_clear = !feed_active || w.clear;
  gate_.clock(in.reset || in.abort || !(feed_active || direct), source_tick_, w.take);
  path_gate_.clock(w.clear, in.prescaler_step, in.engine_ready);
  source_tick_ = (direct ? in.enable && taking : in.feed_tick && feed_active) && !w.clear;
  step_faults(in, fault_event);
  took_ = w.take;
  // A tick, a reset or an abort is never the end of it: no need to look.
  if (w.take || w.clear || source_tick_ || barrier_.counting() || !in.same_but_enable(last_in_) || !quiet(in))
    calm_ = 0;
  else if (calm_ < kCalm)
    ++calm_;
  last_in_ = in;
}

void Sequencer::step_path(const Inputs& in, const Wires& w) {
  const std::uint64_t next_count = count_of(path_chain_);
  const std::uint8_t next_number = number_of(path_chain_);
  const bool done = w.barrier_done;
  const bool barrier_load = barrier_.load();
  began_ = (w.swap || barrier_load) && !w.clear;
  began_direct_ = in.direct_go && !w.clear;

  // Status.
  if (w.clear || w.path_load || barrier_load)
    out_.ended = false;
  else if (barrier_.ended())
    out_.ended = true;
  if (w.clear)
    out_.geometry_number = 0;
  else if (w.swap || barrier_load)
    out_.geometry_number = next_number;

  // What leaves with the tick.
  out_.swap = w.path_load && !w.clear;
  out_.arc_start = w.swap && geometry_.is_arc() && !w.clear;
  out_.incomplete = w.over && arc_ && !in.engine_at_end && !w.clear;
  if (w.swap) {
    out_.active = geometry_.is_line() ? geometry_.mask() : 0;
    out_.prescaler = geometry_.is_arc();
  } else if (in.direct_go) {
    out_.active = in.direct_mask;
    out_.prescaler = false;
  }

  const bool was_idle = idle_;
  const bool at_barrier = geometry_.valid() && !geometry_.is_path() && was_idle && !done && !w.clear;
  const bool was_arc_busy = arc_;
  settled_ = drain_ && settle_ == 0 && !w.over && !w.clear;
  if (!drain_)
    settle_ = kSettleClocks;
  else if (settle_ != 0)
    --settle_;
  if (w.clear) {
    idle_ = true;
    taking_ = drain_ = arc_ = out_.direct = false;
  } else if (w.path_load) {
    idle_ = false;
    taking_ = true;
    drain_ = false;
    arc_ = w.swap && geometry_.is_arc();
    out_.direct = !w.swap;
  } else if (w.ending) {
    idle_ = !arc_ && !out_.direct;
    taking_ = out_.direct;
    drain_ = !idle_;
  } else if (w.over) {
    idle_ = true;
    taking_ = drain_ = arc_ = out_.direct = false;
  }
  out_.path_active = !idle_;

  // Barrier, counter and fetch.
  const bool nothing_to_count = next_count == 0;
  const bool last = path_left_.last();
  const bool counting = barrier_.counting();
  barrier_.clock({w.clear, go_, geometry_at_ && feed_at_, nothing_to_count || last, geometry_.is_end()});
  geometry_at_ = at_barrier;
  path_left_.clock(w.path_load || barrier_load, next_count, w.take || counting);
  if (load_.count) shift_count(path_chain_, load_.word);
  geometry_.clock({w.clear, w.swap || done, was_arc_busy, in.geometry_empty, in.geometry_word});
  load_ = geometry_.load();
  if (in.direct_increment || in.direct_steps || in.direct_length) {
    const auto axis = static_cast<std::uint8_t>(1U << in.direct_axis);
    load_.word = in.direct_word;
    if (in.direct_increment) load_.increment = axis;
    if (in.direct_steps) load_.steps = axis;
    if (in.direct_length) load_.count = true;
  }
}

void Sequencer::step_feed(const Inputs& in, const Wires& w) {
  const bool done = w.barrier_done;
  if (w.clear)
    out_.feed_number = 0;
  else if (w.feed_swap || done)
    out_.feed_number = number_of(feed_chain_);
  out_.feed_swap = w.feed_swap && !w.clear;
  feed_at_ = feed_.valid() && !feed_.is_feed() && !out_.feed_active && !done && !w.clear;
  feed_left_.clock(w.feed_swap, count_of(feed_chain_), w.take);
  if (w.clear)
    out_.feed_active = false;
  else if (w.feed_swap)
    out_.feed_active = true;
  else if (w.feed_ending)
    out_.feed_active = false;
  if (feed_.load().count) shift_count(feed_chain_, feed_.load().word);
  feed_.clock({w.clear, w.feed_swap || done, false, in.feed_empty, in.feed_word});
}

void Sequencer::step_faults(const Inputs& in, bool event) {
  const bool any = event || in.faulted;
  const bool go = !any && !fault_seen_ && !abort_due_;
  if (in.abort)
    abort_due_ = false;
  else if (any && !fault_seen_)
    abort_due_ = true;
  fault_seen_ = any;
  go_ = go;
  if (in.reset) {
    fault_seen_ = abort_due_ = false;
    go_ = true;
  }
}

bool Sequencer::quiet(const Inputs& in) const {
  const bool fetching = !geometry_.quiet() || !feed_.quiet() || (geometry_.idle() && !in.geometry_empty) ||
                        (feed_.idle() && !in.feed_empty) || (geometry_.waiting() && !arc_) || load_.any();
  const bool moving = out_.tick || out_.swap || out_.feed_swap || source_tick_ || gate_.owed() || path_gate_.tick() ||
                      path_gate_.waiting() || took_ || began_ || began_direct_ || drain_ || out_.direct;
  // A barrier that is neither awaited nor counting, and flags that have not yet followed.
  const bool meeting = !barrier_.idle() && !barrier_.counting();
  const bool waits_here = geometry_.valid() && !geometry_.is_path() && idle_;
  const bool feed_waits_here = feed_.valid() && !feed_.is_feed() && !out_.feed_active;
  const bool flags = geometry_at_ == waits_here && feed_at_ == feed_waits_here &&
                     !(barrier_.idle() && geometry_at_ && feed_at_ && go_);
  // A decoded command that could begin now.
  const bool begins = go_ && ((geometry_.valid() && geometry_.is_path() && idle_) ||
                              (feed_.valid() && feed_.is_feed() && !out_.feed_active));
  const bool geometry_idle = geometry_.idle() && in.geometry_empty && !out_.path_active && barrier_.idle();
  const bool idle = geometry_idle && feed_.idle() && in.feed_empty && !out_.feed_active;
  const bool faults =
      out_.mismatch || out_.incomplete || in.faulted != fault_seen_ || go_ != (!fault_seen_ && !abort_due_);
  return !fetching && !moving && !meeting && flags && !begins && geometry_idle_ == geometry_idle && out_.idle == idle &&
         !faults && out_.feed_clear == !out_.feed_active;
}

std::uint64_t Sequencer::silent_ticks() const { return std::min(path_left_.left(), feed_left_.left()) - 1; }

std::uint64_t Sequencer::dwell_clocks() const {
  return barrier_.counting() && go_ && path_left_.left() > 2 ? path_left_.left() - 2 : 0;
}

}  // namespace trammel::model
