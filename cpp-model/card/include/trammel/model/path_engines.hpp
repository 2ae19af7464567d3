// Golden model of the path engines: the blocks between the tick of the card (feed domain) and the axes.
//
// Feed ticks and swaps leave 3 clocks later as path ticks and swaps. The prescaler has the same latency, so a path on
// prescaled ticks and a line after it keep their order. For engines other than lines the prescaler, a pulse
// generator, derives path ticks from feed ticks; they wait until the engine can take them. The engine's steps leave
// as a bit per axis.
//
// From a tick at c: path domain at c+3; the accumulator's tick at c+5 at the earliest, its step per axis at c+8.
// `done`, one clock late: no tick of a path on an engine is in the 3 clocks of delay, no path tick waits, and the
// accumulator has finished its last step.
// `payload_ready`: the same, for an engine's ticks only; it is already true in the last clocks of the accumulator's
// step (from the 6th clock after its tick on, in 8 directions from the 14th), since a load that is requested then
// arrives after the step.
// Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/arc_generator.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/clock_each.hpp"
#include "trammel/model/deviation_accumulator.hpp"
#include "trammel/model/pulse_generator.hpp"

namespace trammel::model {

class PathEngines {
 public:
  struct Inputs {
    bool cut = false;
    bool tick = false;  // feed domain
    bool swap = false;
    // Sampled with swap: the engine of the path, as card_map::engine. An engine other than lines is loaded by then.
    std::uint8_t engine = card_map::engine::kLines;
    LoadWord load;
    bool engine_taken = false;  // the path is on an engine and still takes feed ticks
  };
  struct Outputs {
    bool tick = false;  // path domain
    bool swap = false;
    bool path_tick = false;  // path tick of the accumulator
    std::uint8_t step = 0;   // steps of the engines, a bit per axis
    std::uint8_t dir = 0;    // 1 = negative; valid with a step
    bool ready = true;       // a feed tick may be taken
    bool payload_ready = true;
    bool shadows_free = true;  // the axes' increments may be loaded
    // Outputs of the arc generator: a halfword of an increment; load and swap, a bit per axis.
    std::uint16_t chord_word = 0;
    std::uint8_t chord_load = 0;
    std::uint8_t chord_swap = 0;
    bool done = false;
    bool missed_end = false;  // with done: the path did not end at the commanded end point
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    DeviationAccumulator accumulator;
    ArcGenerator arc;
    bool over = false;       // the arc is over; clears the arc generator
    bool over_next = false;  // `over` of the next clock
    bool gate_payload_ready = true;
    PulseGenerator prescaler;
    std::uint32_t ticks = 0;      // feed ticks on their way; bit k leaves in k clocks, bit 0 is visible
    std::uint32_t own_ticks = 0;  // ticks that go to the axes, as `ticks`
    bool chord_tick = false;      // the visible tick is the arc generator's
    std::uint32_t swaps = 0;
    std::uint32_t waiting = 0;                       // path ticks that wait for the engine
    std::uint8_t engine = card_map::engine::kLines;  // engine of the path that was swapped in last
    // The accumulator's axes, and its steps as a bit per axis.
    unsigned axis_x = 0;
    unsigned axis_y = 0;
    std::uint8_t routed_step = 0;
    std::uint8_t routed_dir = 0;
    Outputs out;
  };

  // One rising edge.
  void clock(const Inputs& in) { clock_parts(in, ClockEach()); }
  template <class ClockPart>
  void clock_parts(const Inputs& in, const ClockPart& clock_part) {
    const Said engine = said();
    const DeviationAccumulator::Outputs accumulator = state_.accumulator.outputs();
    const bool tick = state_.out.path_tick && state_.engine == card_map::engine::kAccumulator;
    judge(in, engine);
    const bool start = in.swap && in.engine == card_map::engine::kAccumulator;
    route(in.load, accumulator);
    clock_part(state_.accumulator, {false, in.load, start, tick, in.cut});
    const bool chord_tick = state_.prescaler.outputs().step && state_.engine == card_map::engine::kArcGenerator;
    clock_arc(in, chord_tick, clock_part);
    give(in.cut, engine.ready);
    clock_part(state_.prescaler, {in.cut, in.tick, in.swap, on_engine(in.engine), false, false,
                                  in.load.to(load_target::kPrescale), false, in.load.word});
    delay(in, chord_tick);
    if (in.swap) state_.engine = in.engine;
    if (in.cut) state_.engine = card_map::engine::kLines;
    step();
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // True if no path tick waits or is on its way to an engine, and no engine makes a step.
  bool quiet() const { return state_.gate_payload_ready; }

  // True if the visible tick is a path tick of an arc in chords.
  bool chord_tick() const { return state_.chord_tick; }

  // The state of an engine, as its registers show it.
  struct Said {
    bool ready = false;
    bool at_end = false;
    bool stepping = false;  // during a step, when no load may arrive
    std::uint8_t step = 0;  // a bit per axis
    std::uint8_t dir = 0;
  };
  // The state of the engine that runs the path.
  Said said() const {
    switch (state_.engine) {
      // The axes make the steps, and the path ends with its last tick.
      case card_map::engine::kLines:
      case card_map::engine::kArcGenerator:
        return {true, true, false, 0, 0};
      default:
        return {state_.accumulator.outputs().ready, state_.accumulator.outputs().at_end, state_.accumulator.stepping(),
                state_.routed_step, state_.routed_dir};
    }
  }

  static bool on_engine(std::uint8_t engine) { return engine != card_map::engine::kLines; }

 private:
  static constexpr unsigned kDelay = 3;  // feed domain to path domain

  // The conditions that the sequencer sees, one clock late.
  void judge(const Inputs& in, const Said& engine) {
    const bool feed_ticks = in.tick || state_.ticks != 0;
    const bool coming = feed_ticks && on_engine(state_.engine);
    const bool path_ticks = state_.waiting != 0 || state_.out.path_tick;
    state_.out.done = !coming && !path_ticks && engine.ready;
    state_.out.missed_end = !engine.at_end;
    state_.gate_payload_ready = !coming && !path_ticks && !engine.stepping;
    state_.over_next = state_.engine == card_map::engine::kArcGenerator && !in.engine_taken && !feed_ticks &&
                       !state_.arc.outputs().loadable;
  }

  // The accumulator steps the two axes of its plane.
  void route(const LoadWord& load, const DeviationAccumulator::Outputs& accumulator) {
    const unsigned x = 1U << state_.axis_x;
    const unsigned y = 1U << state_.axis_y;
    state_.routed_step = static_cast<std::uint8_t>((accumulator.step_x ? x : 0) | (accumulator.step_y ? y : 0));
    state_.routed_dir = static_cast<std::uint8_t>((accumulator.dir_y ? y : 0) | (accumulator.dir_x ? x : 0));
    if (load.to(load_target::kPlane)) {
      state_.axis_x = load.word >> 4 & 7;
      state_.axis_y = load.word >> 8 & 7;
    }
  }

  void step() {
    const Said engine = said();
    state_.out.step = engine.step;
    state_.out.dir = engine.dir;
  }

  // Path ticks wait for the engine, which answers a tick with ready low one clock later.
  void give(bool cut, bool engine_ready) {
    const bool given = state_.waiting != 0 && engine_ready && !state_.out.path_tick;
    const bool comes = state_.prescaler.outputs().step && state_.engine != card_map::engine::kArcGenerator;
    state_.waiting = cut ? 0 : state_.waiting + (comes ? 1U : 0U) - (given ? 1U : 0U);
    state_.out.path_tick = given && !cut;
    state_.out.ready = state_.waiting < 2 && state_.arc.outputs().ready;
    state_.out.payload_ready = state_.gate_payload_ready && state_.arc.outputs().loadable;
  }

  // The arc is over when its path takes no more feed ticks and no tick is on its way.
  template <class ClockPart>
  void clock_arc(const Inputs& in, bool tick, const ClockPart& clock_part) {
    const bool clear = in.cut || state_.over;
    state_.over = state_.over_next;
    const bool start = in.swap && in.engine == card_map::engine::kArcGenerator;
    clock_part(state_.arc, {clear, in.load, start, tick});
    const ArcGenerator::Outputs& arc = state_.arc.outputs();
    state_.out.shadows_free = arc.loadable;
    state_.out.chord_word = arc.word;
    state_.out.chord_load = arc.load;
    state_.out.chord_swap = arc.swap;
  }

  void delay(const Inputs& in, bool chord_tick) {
    state_.ticks = in.cut ? 0 : state_.ticks >> 1 | (in.tick ? 1U << (kDelay - 1) : 0);
    state_.swaps = in.cut ? 0 : state_.swaps >> 1 | (in.swap ? 1U << (kDelay - 1) : 0);
    // Ticks that go to the axes: feed ticks of lines, and path ticks of an arc, one clock after the arc generator's.
    const bool own = in.tick && state_.engine != card_map::engine::kArcGenerator;
    state_.own_ticks = in.cut ? 0 : state_.own_ticks >> 1 | (own ? 1U << (kDelay - 1) : 0) | (chord_tick ? 1 : 0);
    state_.chord_tick = chord_tick && !in.cut;
    state_.out.tick = (state_.own_ticks & 1) != 0;
    state_.out.swap = (state_.swaps & 1) != 0;
  }

  State state_;
};

}  // namespace trammel::model
