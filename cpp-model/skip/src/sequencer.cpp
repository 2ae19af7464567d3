#include "trammel/skip/sequencer.hpp"

namespace trammel::skip {

using model::Sequencer;

namespace {

// True if only a tick, an enable or a pop can change the fetch. A waiting fetch also depends on payload_ready.
bool at_rest(const model::CommandFetch& fetch) {
  using Mode = model::CommandFetch::Mode;
  const model::CommandFetch::State& s = fetch.state();
  return s.asked < 0 && s.arriving[0] < 0 && s.arriving[1] < 0 && !s.bus.valid &&
         (s.mode == Mode::Idle || s.mode == Mode::Decoded || s.mode == Mode::Waiting);
}

// True if these inputs decide nothing except ticks and the end of a dwell.
bool counts_only(const model::Sequencer& block, const model::Sequencer::Inputs& in) {
  const model::Sequencer::State& s = block.state();
  const bool nothing_shows = !(s.out.swap || s.out.feed_swap || s.out.mismatch || s.out.incomplete || s.out.over) &&
                             !(s.path_begun || s.piece_begun || in.cut || in.closing || in.direct_go) &&
                             !(s.load.valid || in.direct_load.valid || s.record.command || s.record.direct);
  if (!nothing_shows || s.drained || s.path == Sequencer::Path::Direct || !(at_rest(s.geometry) && at_rest(s.feed)))
    return false;
  if ((s.geometry.idle() && !in.geometry_empty) || (s.feed.idle() && !in.feed_empty)) return false;
  if (s.geometry.waiting() && s.path != Sequencer::Path::Engine) return false;
  if (block.instant() || in.halt || in.probe_taken || s.out.silent) return false;
  if (s.out.stale || (s.out.spent && !block.ticking_path())) return false;
  if (block.has_streaming() && horizon(s.streaming, block.streaming_inputs(in)) == 0) return false;
  if (block.geometry_drops(in) || block.feed_drops(in)) return false;
  const bool piece_may_begin = block.piece_waits() && !in.wait;
  if ((block.path_waits() && s.path == Sequencer::Path::None) ||
      (piece_may_begin && (!s.out.feed_active || s.out.spent)))
    return false;
  if (s.barrier == Sequencer::Barrier::Beginning || s.barrier == Sequencer::Barrier::Done ||
      (block.mismatches() && !in.drop))
    return false;
  const bool geometry_stands = s.geometry.decoded() && s.geometry.is_barrier() && s.path == Sequencer::Path::None;
  const bool feed_stands = s.feed.decoded() && s.feed.is_barrier() && !s.out.feed_active;
  if (geometry_stands != s.geometry_stands || feed_stands != s.feed_stands) return false;
  if (s.barrier == Sequencer::Barrier::None && geometry_stands && feed_stands) return false;
  const bool geometry_idle = s.geometry.idle() && in.geometry_empty && s.path == Sequencer::Path::None &&
                             s.barrier == Sequencer::Barrier::None;
  const bool idle = geometry_idle && s.feed.idle() && in.feed_empty && !s.out.feed_active;
  return geometry_idle == s.geometry_idle && idle == s.out.idle && s.out.feed_clear != s.out.feed_active;
}

}  // namespace

std::uint64_t horizon(const model::CommandFetch& fetch, const model::CommandFetch::Inputs& in) {
  const bool begins = (fetch.idle() && !in.empty) || fetch.waiting();
  return forever_if(!in.clear && !in.pop && !begins && at_rest(fetch));
}

bool count(model::Sequencer& block, const model::Sequencer::Inputs& in) {
  if (!counts_only(block, in) || block.barrier_over(in)) return false;
  const bool take = block.takes(in);
  if (take && block.ticks_left() == 1) return false;
  model::Sequencer::State& s = block.state();
  block.clock_ticks(in, take);
  if (take) {
    --s.path_left;
    if (!s.out.spent) --s.piece_left;
    s.out.moving = true;
  }
  ++s.now;
  return true;
}

bool only_counts_move(const model::Sequencer& block, const model::Sequencer::Inputs& in) {
  const model::Sequencer::State& s = block.state();
  if (!counts_only(block, in) || block.barrier_over(in)) return false;
  if (block.ticking()) return in.engine_ready && s.owed <= 1;
  return !block.takes(in) && !s.tick_arrives && !s.out.tick && !s.out.feed_enable && !in.feed_tick &&
         (s.out.feed_active || s.owed == 0);
}

std::uint64_t counting_clocks(const model::Sequencer& block) {
  const model::Sequencer::State& s = block.state();
  return s.barrier == Sequencer::Barrier::Running && s.barrier_at > s.now ? s.barrier_at - s.now : kForever;
}

std::uint64_t horizon(const model::Sequencer& block, const model::Sequencer::Inputs& in) {
  const model::Sequencer::State& s = block.state();
  const bool ticks = block.takes(in) || s.tick_arrives || s.out.tick || (in.feed_tick && s.out.feed_active);
  const bool enable = in.enable && s.out.feed_active && block.ticking_path() && s.owed <= 1;
  if (ticks || enable != s.out.feed_enable || (s.owed != 0 && !s.out.feed_active)) return 0;
  return counts_only(block, in) && !block.barrier_over(in) ? counting_clocks(block) : 0;
}

void advance(model::Sequencer& block, std::uint64_t clocks, std::uint64_t ticks, unsigned in_flight, bool feed_enable) {
  model::Sequencer::State& s = block.state();
  s.now += clocks;
  if (!block.ticking()) return;
  s.path_left -= ticks;
  s.out.moving = s.out.moving || ticks != 0;
  if (!s.out.spent) s.piece_left -= ticks;
  s.tick_arrives = (in_flight >> kArrives & 1) != 0;
  s.owed = in_flight >> kOwed & 1;
  s.out.tick = (in_flight >> kTaken & 1) != 0;
  s.out.feed_enable = feed_enable;
}

}  // namespace trammel::skip
