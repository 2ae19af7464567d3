// Going from tick to tick: CardModel::run().
//
// A jump starts and ends with nothing on its way: no tick, step, decode or access in flight, a steady time base. Within
// it feed ticks may pass that make no step on any axis, none in the prescaler, and are not the last of their path or
// piece: they only move phases and counters. Everything else, and the last clocks of a run, goes clock by clock.
#include <algorithm>

#include "trammel/model/card_model.hpp"

namespace trammel::model {

namespace {

// Clocks from the accumulation that carries to the state in which its tick has left no trace but counters: 3 in the
// feed generator, then owed, taken, at the axes, worked off.
constexpr std::uint64_t kTickTail = 10;
// Clocks at the end of a run that go one by one: signals that lag behind are exact again.
constexpr std::uint64_t kRunTail = 8;
constexpr std::uint64_t kShortestJump = 24;
// After a jump that came to nothing: clocks before the next is tried.
constexpr std::uint64_t kPause = 16;

}  // namespace

void CardModel::run(std::uint64_t clocks) {
  const Inputs none;
  while (clocks > kRunTail + kShortestJump) {
    std::uint64_t gone = may_jump() ? jump(clocks - kRunTail) : 0;
    if (gone == 0) {
      for (gone = 0; gone < kPause; ++gone) {
        clock(none);
        if (may_jump()) {
          ++gone;
          break;
        }
      }
    }
    clocks -= gone;
  }
  for (; clocks != 0; --clocks) clock(none);
}

bool CardModel::may_jump() const {
  if (awake_ != 0 || watched() != watched_ || !sequencer_.cruising_or_still()) return false;
  if (!feed_.quiet() || !prescaler_.quiet() || !accumulator_.quiet() || router_.step() != 0) return false;
  if (axis_state_.path_step != 0 || !busy_timer_.quiet(running_)) return false;
  const Sequencer::Outputs& s = sequencer_.outputs();
  if (running_ != (!s.idle || s.direct || axis_state_.busy != 0) || any_live_) return false;
  return sequencer_.quiet(sequencer_inputs()) && geometry_queue_.quiet() && feed_queue_.quiet() && loader_.quiet() &&
         time_base_.steady(time_in_);
}

// Accumulations of the feed generator in the next `clocks` clocks, at least 2: the enables on their way come first.
std::uint64_t CardModel::accumulations_in(std::uint64_t clocks) const {
  return (sequencer_.outputs().feed_enable ? 1U : 0U) + (time_base_.outputs().enable ? 1U : 0U) +
         time_base_.enabled_in(clocks - 2);
}

// The clock, from 1, of the given accumulation, from 1.
std::uint64_t CardModel::clock_of(std::uint64_t accumulation) const {
  const unsigned now = sequencer_.outputs().feed_enable ? 1 : 0;
  const unsigned next = time_base_.outputs().enable ? 1 : 0;
  if (accumulation <= now) return 1;
  if (accumulation <= now + next) return 2;
  return 2 + time_base_.clocks_for(accumulation - now - next);
}

std::uint64_t CardModel::silent_ticks() const {
  std::uint64_t ticks = std::min(sequencer_.silent_ticks(), prescaler_.silent_ticks());
  for (const Axis& axis : axes_) ticks = std::min(ticks, axis.generator().silent_ticks());
  return ticks;
}

// Jumps up to `limit` clocks and returns how many; 0 when it is not worth it.
std::uint64_t CardModel::jump(std::uint64_t limit) {
  for (const Axis& axis : axes_) limit = std::min(limit, axis.idle_clocks());
  if (sequencer_.dwelling()) limit = std::min(limit, sequencer_.dwell_clocks());
  if (limit < kShortestJump) return 0;
  if (!sequencer_.cruising()) {
    land(limit, 0, false);
    return limit;
  }

  const FeedGenerator before = feed_;
  const std::uint64_t most = accumulations_in(limit);
  const std::uint64_t most_carries = accumulations_in(limit - kTickTail);
  const std::uint64_t silent = silent_ticks();
  std::uint64_t done = 0;
  std::uint64_t ticks = 0;
  std::uint64_t last_carry = 0;
  if (feed_.constant()) {
    ticks = std::min(silent, feed_.ticks_in(most_carries));
    last_carry = feed_.enables_for(ticks);
    done = std::min(most, feed_.enables_for(ticks + 1) - 1);
    feed_.leap(done);
  } else {
    while (ticks < silent) {
      done += feed_.skip(most_carries - done);
      if (done == most_carries) break;
      feed_.carry_silently();
      last_carry = ++done;
      ++ticks;
    }
    done += feed_.skip(most - done);
  }
  const std::uint64_t clocks = done == most ? limit : clock_of(done + 1) - 1;
  const std::uint64_t least = ticks == 0 ? kShortestJump : std::max(kShortestJump, clock_of(last_carry) + kTickTail);
  if (clocks < least) {
    feed_ = before;
    return 0;
  }
  land(clocks, ticks, time_base_.enabled_in(clocks - 1) != time_base_.enabled_in(clocks - 2));
  return clocks;
}

// Brings everything but the feed generator `clocks` clocks and `ticks` silent ticks on.
void CardModel::land(std::uint64_t clocks, std::uint64_t ticks, bool feed_enable) {
  if (sequencer_.dwelling()) sequencer_.dwell(clocks);
  sequencer_.take_silently(ticks, feed_enable);
  time_base_.advance(clocks);
  hold_timer_.advance(registers_.outputs().hold_limit, clocks);
  prescaler_.silent_ticks(ticks);
  for (Axis& axis : axes_) {
    if (ticks != 0) axis.generator().silent_ticks(ticks);
    axis.advance(clocks);
  }
  registers_.advance(clocks);
  cycles_ += clocks;
  path_taken_ += ticks;
}

}  // namespace trammel::model
