// Adaptors of the sequencers and their parts, also for clocks with ticks on their way. See horizon.hpp.
#pragma once

#include <cstdint>

#include "trammel/model/sequencer.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

std::uint64_t horizon(const model::CommandFetch& fetch, const model::CommandFetch::Inputs& in);
inline void advance(model::CommandFetch&, const model::CommandFetch::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::PositionStreaming& block, const model::PositionStreaming::Inputs& in) {
  const model::PositionStreaming::State& s = block.state();
  const bool events = in.cut || in.setting.set || in.write || in.whole || in.begin || in.period || in.stale_tick;
  const bool settles = in.rest && !s.inside;
  return forever_if(!events && !s.out.missing && (s.out.on == s.on || !settles));
}
inline void advance(model::PositionStreaming&, const model::PositionStreaming::Inputs&, std::uint64_t) {}

std::uint64_t horizon(const model::Sequencer& block, const model::Sequencer::Inputs& in);
inline void advance(model::Sequencer& block, const model::Sequencer::Inputs&, std::uint64_t clocks) {
  block.state().now += clocks;
}

// One clock in which only ticks and counters move. Returns true and leaves the state of clock(in), or false if more
// would move.
bool count(model::Sequencer& block, const model::Sequencer::Inputs& in);

// Positions of ticks on their way: bit k of `in_flight` belongs to an accumulation k clocks ago.
inline constexpr unsigned kArrives = 3;
inline constexpr unsigned kOwed = 4;
inline constexpr unsigned kTaken = 5;
inline unsigned in_flight(const model::Sequencer& block) {
  const model::Sequencer::State& s = block.state();
  return (s.tick_arrives ? 1U << kArrives : 0) | (s.owed != 0 ? 1U << kOwed : 0) | (s.out.tick ? 1U << kTaken : 0);
}
// True if these inputs, apart from enables and ticks made, move only counters. counting_clocks(): for how many clocks
// at most.
bool only_counts_move(const model::Sequencer& block, const model::Sequencer::Inputs& in);
std::uint64_t counting_clocks(const model::Sequencer& block);
// Passes `clocks` clocks in which `ticks` are taken, none of them a last one; `in_flight`: ticks on their way
// afterwards.
void advance(model::Sequencer& block, std::uint64_t clocks, std::uint64_t ticks, unsigned in_flight, bool feed_enable);

}  // namespace trammel::skip
