// Adaptors of the path engines and their parts. EngineTicks handles ticks on their way. See horizon.hpp.
#pragma once

#include <cstdint>

#include "trammel/model/path_engines.hpp"
#include "trammel/skip/axis.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

inline bool at_rest(const model::DeviationAccumulator& block) {
  const model::DeviationAccumulator::State& s = block.state();
  return s.wait == 0 && !s.emit && !s.out.step_x && !s.out.step_y;
}
inline std::uint64_t horizon(const model::DeviationAccumulator& block, const model::DeviationAccumulator::Inputs& in) {
  const bool asked = in.rst || in.start || in.clear || (in.tick && block.outputs().ready && !block.outputs().at_end) ||
                     model::DeviationAccumulator::is_own(in.load);
  if (asked || block.state().emit || block.outputs().step_x || block.outputs().step_y) return 0;
  return block.state().wait == 0 ? kForever : block.state().wait - 1;
}
inline void advance(model::DeviationAccumulator& block, const model::DeviationAccumulator::Inputs&,
                    std::uint64_t clocks) {
  if (block.state().wait != 0) block.state().wait -= static_cast<unsigned>(clocks);
}

inline bool at_rest(const model::ArcGenerator& block) {
  const model::ArcGenerator::State& s = block.state();
  return s.out.load == 0 && s.out.swap == 0 && (!s.under_way || (s.left == 0 && s.begun && s.full_x && s.full_y));
}
// Path ticks up to and including the one that ends a half chord; kForever if none does.
inline std::uint64_t ticks_left(const model::ArcGenerator& block) {
  const unsigned m = block.state().path.state.m;
  if (m < model::ArcGenerator::kMinChordBits) return kForever;
  const std::uint64_t half = std::uint64_t{1} << (m - 1);
  return half - (block.state().ticks & (half - 1));
}
// With `tick` every clock is a path tick.
inline std::uint64_t horizon(const model::ArcGenerator& block, const model::ArcGenerator::Inputs& in) {
  const model::ArcGenerator::State& s = block.state();
  if (in.clear || in.load.valid || in.start || !at_rest(block)) return 0;
  return in.tick && s.under_way ? ticks_left(block) - 1 : kForever;
}
inline void advance(model::ArcGenerator& block, const model::ArcGenerator::Inputs& in, std::uint64_t clocks) {
  if (in.tick && block.state().under_way) block.state().ticks += clocks;
}

// True if the path runs on the arc generator: its axes step on path ticks.
inline bool on_chords(const model::PathEngines& block) {
  return block.state().engine == card_map::engine::kArcGenerator;
}
// True if, without inputs, nothing moves except ticks on their way through the 3 clocks of delay.
inline bool only_ticks_move(const model::PathEngines& block) {
  const model::PathEngines::State& s = block.state();
  if (!at_rest(s.arc) || s.over || s.over_next || (on_chords(block) && s.own_ticks != 0)) return false;
  return s.swaps == 0 && !s.out.swap && s.waiting == 0 && !s.out.path_tick && s.out.step == 0 && s.routed_step == 0 &&
         at_rest(s.prescaler) && at_rest(s.accumulator);
}
inline bool at_rest(const model::PathEngines& block) {
  const model::PathEngines::State& s = block.state();
  return only_ticks_move(block) && s.ticks == 0 && s.own_ticks == 0 && !s.chord_tick && !s.out.tick &&
         s.out.done == block.said().ready && s.out.missed_end == !block.said().at_end && s.out.payload_ready;
}

// True if the outputs that follow the parts one clock late show their present state.
inline bool shows_parts(const model::PathEngines& block) {
  const model::PathEngines::State& s = block.state();
  const model::DeviationAccumulator::Outputs& a = s.accumulator.outputs();
  const model::ArcGenerator::Outputs& arc = s.arc.outputs();
  const unsigned dir = (a.dir_x ? 1U << s.axis_x : 0) | (a.dir_y ? 1U << s.axis_y : 0);
  return s.routed_dir == dir && s.out.dir == block.said().dir && s.out.chord_word == arc.word &&
         s.out.ready == arc.ready && s.out.shadows_free == arc.loadable && s.out.chord_load == 0 &&
         s.out.chord_swap == 0 && s.gate_payload_ready != block.said().stepping;
}

inline std::uint64_t horizon(const model::PathEngines& block, const model::PathEngines::Inputs& in) {
  const model::PathEngines::State& s = block.state();
  const bool arc_ends = on_chords(block) && !in.engine_taken && !s.arc.outputs().loadable;
  return forever_if(!in.cut && !in.tick && !in.swap && !in.load.valid && !arc_ends && at_rest(block) &&
                    shows_parts(block));
}
inline void advance(model::PathEngines&, const model::PathEngines::Inputs&, std::uint64_t) {}

// Ticks on their way: bit k belongs to an accumulation of the feed generator k clocks ago.
class EngineTicks {
 public:
  // Ticks of an arc in chords that were passed.
  struct PathTicks {
    std::uint64_t at_axes = 0;
    bool visible = false;  // one more tick is visible and leaves for the axes
  };

  explicit EngineTicks(model::PathEngines& block) : block_(block), s_(block.state()) {}

  unsigned in_flight() const { return (s_.ticks >> 2 & 1) << 6 | (s_.ticks >> 1 & 1) << 7 | (s_.ticks & 1) << 8; }
  // Number of the feed tick, from the prescaler's present state, before which a jump must end. On an arc in chords it
  // is the one that ends a half chord, otherwise the first one that makes a path tick.
  std::uint64_t tick_that_stops() const {
    return PulsesAhead(s_.prescaler).ticks_until(on_chords(block_) ? ticks_left(s_.arc) : 1);
  }
  // To be called before jump(). Passes the `ticks` feed ticks that the prescaler took, of which those in `in_flight`
  // are still on their way; returns their path ticks.
  PathTicks jump_chords(std::uint64_t ticks, unsigned in_flight) {
    PathTicks made;
    unsigned late = 0;
    for (unsigned k = kPrescaled; k < kPrescaled + kAtAxes; ++k) late += in_flight >> k & 1;
    made.at_axes = PulsesAhead(s_.prescaler).pass(ticks - late);
    std::uint32_t steps = 0;
    for (unsigned k = kAtAxes; k-- > 0;) {
      if ((in_flight >> (kPrescaled + k) & 1) != 0 && PulsesAhead(s_.prescaler).pass(1) != 0) steps |= 1U << k;
    }
    for (unsigned k = 0; k + 1 < kAtAxes; ++k) {
      if ((steps >> k & 1) != 0) PulsesAhead(s_.prescaler).place_step(k, false);
    }
    made.visible = (steps >> (kAtAxes - 1) & 1) != 0;
    s_.chord_tick = made.visible;
    s_.own_ticks = made.visible ? 1 : 0;
    s_.arc.state().ticks += made.at_axes + s_.own_ticks;
    return made;
  }
  // The state after clocks in which the prescaler took `ticks`, with those of `in_flight` still on their way (bit 9:
  // the one before). Except on an arc in chords the prescaler must make no step.
  void jump(std::uint64_t ticks, unsigned in_flight) {
    if (!on_chords(block_)) PulsesAhead(s_.prescaler).silent_ticks(ticks);
    s_.ticks = (in_flight >> 6 & 1) << 2 | (in_flight >> 7 & 1) << 1 | (in_flight >> 8 & 1);
    if (!on_chords(block_)) s_.own_ticks = s_.ticks;
    s_.out.tick = (s_.own_ticks & 1) != 0;
    const bool coming = (in_flight >> 6 & 0xF) != 0 && model::PathEngines::on_engine(s_.engine);
    s_.out.done = !coming && block_.said().ready;
    s_.out.missed_end = !block_.said().at_end;
    s_.gate_payload_ready = !coming;
    s_.out.payload_ready = s_.gate_payload_ready && s_.arc.outputs().loadable;
  }

 private:
  // Clocks from an accumulation of the feed generator to the prescaler, and from there to the axes on an arc in
  // chords.
  static constexpr unsigned kPrescaled = 6;
  static constexpr unsigned kAtAxes = 4;

  model::PathEngines& block_;
  model::PathEngines::State& s_;
};

}  // namespace trammel::skip
