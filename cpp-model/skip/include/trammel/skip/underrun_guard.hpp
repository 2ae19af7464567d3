// Adaptor of the under-run guard, also for clocks in which ticks are taken. See horizon.hpp.
#pragma once

#include <cstdint>

#include "trammel/model/underrun_guard.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

// True if these inputs change nothing but counts, as long as fewer ticks are taken than ticks_to_change().
inline bool only_counts_move(const model::UnderrunGuard& block, const model::UnderrunGuard::Inputs& in) {
  const model::UnderrunGuard::State& s = block.state();
  const bool follow = block.follows(in.active);
  if (s.unknown != s.lost || s.since < model::UnderrunGuard::kLag) return false;
  const bool counts = s.paths != 0 || s.pieces != 0 || s.owed != 0;
  if (s.lost && (counts || s.at_rest || s.at_barrier)) return false;
  if (s.lost && (in.lost || in.idle || s.since < model::UnderrunGuard::kLag)) return false;
  if (in.lost || in.cut || in.swap || in.load.valid || in.arrival.any() || s.pending.any) return false;
  if (s.due || (follow && (s.distance != s.next || s.ruled == block.next_zero()))) return false;
  if (s.decoded_before != in.decoded || s.from_rest_before != (!in.active || s.ends)) return false;
  if (s.judged != (in.decoded && follow) || s.doubled != (s.judged && !in.full) ||
      (s.flags.covered && !s.covered && !s.unknown))
    return false;
  if ((!s.out.hold && s.ratio != model::UnderrunGuard::in_256ths(in.ratio)) ||
      s.factor != block.factor(in.ratio == 0, in.full))
    return false;
  if (s.product != block.product() || !(s.flags == block.compared(s.owed))) return false;
  const bool is_short = s.ruled && block.judged_short();
  const bool waits = block.waits_for_more(is_short, in.gone);
  return s.out.hold == block.holds(is_short, follow, in.full, in.gone) && s.enough == (s.judged && !waits) &&
         s.waits == (s.judged && !in.active && waits);
}
inline std::uint64_t ticks_to_change(const model::UnderrunGuard& block) {
  const model::UnderrunGuard::State& s = block.state();
  std::uint64_t least = kForever;
  for (const std::int64_t queued : {s.paths, s.pieces}) {
    const std::int64_t beyond = queued - static_cast<std::int64_t>(s.owed) - block.reserved();
    if (beyond > 0 && static_cast<std::uint64_t>(beyond) < least) least = static_cast<std::uint64_t>(beyond);
  }
  return least;
}
// Passes `clocks` clocks in which `ticks` are taken; bit k of `taken`: a tick was taken k clocks before the last one.
inline void advance(model::UnderrunGuard& block, std::uint64_t clocks, std::uint64_t ticks, unsigned taken) {
  model::UnderrunGuard::State& s = block.state();
  const std::uint64_t to_pass = model::UnderrunGuard::kPass - 1 - s.round % model::UnderrunGuard::kPass;
  s.round = static_cast<unsigned>((s.round + clocks) % model::UnderrunGuard::kRound);
  std::uint64_t owed = s.owed + ticks;
  if (s.lost && clocks != 0) owed = 0;
  if (clocks > to_pass) {
    const std::uint64_t all = owed;
    owed = 0;
    for (unsigned k = 0; k < s.round % model::UnderrunGuard::kPass; ++k) owed += taken >> k & 1;
    s.paths -= static_cast<std::int64_t>(all - owed);
    s.pieces -= static_cast<std::int64_t>(all - owed);
  }
  s.owed = owed;
}

inline std::uint64_t horizon(const model::UnderrunGuard& block, const model::UnderrunGuard::Inputs& in) {
  return forever_if(!in.take && only_counts_move(block, in));
}
inline void advance(model::UnderrunGuard& block, const model::UnderrunGuard::Inputs&, std::uint64_t clocks) {
  advance(block, clocks, 0, 0);
}

}  // namespace trammel::skip
