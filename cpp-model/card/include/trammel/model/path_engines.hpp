// Golden model of the path engines: what stands between the tick of the card (feed domain) and the axes.
//
// Feed ticks and swaps leave 3 clocks later as path ticks and swaps: as long as the prescaler takes, so that a path on
// prescaled ticks and a line after it keep their order. On another engine than lines the prescaler, a pulse generator,
// makes path ticks from feed ticks; they wait until the engine can take them. Its steps leave by axis.
//
// From a tick at c: path domain at c+3; the accumulator's tick at c+5 at the earliest, its step at c+8 by axis.
// `done`: no tick is in the 3 clocks, no path tick waits and the accumulator has finished the last one; a clock late.
// `payload_ready`: as that for an engine's ticks alone, but already in the last clocks of the accumulator's step (from
// the 6th clock after its tick on, in 8 directions from the 14th): a load that is asked for then comes after it.
// Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/arc_generator.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/deviation_accumulator.hpp"
#include "trammel/model/pulse_generator.hpp"

namespace trammel::model {

class PathEngines {
 public:
  struct Inputs {
    bool cut = false;
    bool tick = false;  // feed domain
    bool swap = false;
    // Sampled with swap: what the path runs on, by its card_map::engine; the state of one that is not lines is loaded.
    std::uint8_t engine = card_map::engine::kLines;
    LoadWord load;
    bool engine_taken = false;  // the path is on an engine and still takes feed ticks
  };
  struct Outputs {
    bool tick = false;  // path domain
    bool swap = false;
    bool path_tick = false;  // of the accumulator
    std::uint8_t step = 0;   // engines' steps, by axis
    std::uint8_t dir = 0;    // 1 = negative; means something with a step
    bool ready = true;       // a feed tick may be taken
    bool payload_ready = true;
    bool shadows_free = true;  // the axes' increments may be loaded
    // The arc generator's, by axis.
    std::uint16_t chord_word = 0;
    std::uint8_t chord_load = 0;
    std::uint8_t chord_swap = 0;
    bool done = false;
    bool elsewhere = false;  // with done: not on the commanded end point
  };

  // `clock_all`: neither part ever rests.
  explicit PathEngines(bool clock_all = false) : clock_all_(clock_all) {}

  // One rising edge.
  void clock(const Inputs& in) {
    const Said engine = said();
    const DeviationAccumulator::Outputs accumulator = accumulator_.outputs();
    const bool tick = out_.path_tick && engine_ == card_map::engine::kAccumulator;
    judge(in, engine);
    const bool start = in.swap && in.engine == card_map::engine::kAccumulator;
    const bool commanded = in.cut || in.load.valid || clock_all_;
    if (commanded || routed_step_ != 0 || !accumulator_.quiet()) route(in.load, accumulator);
    if (commanded || start || tick || !accumulator_.quiet()) accumulator_.clock({false, in.load, start, tick, in.cut});
    const bool chord_tick = prescaler_.outputs().step && engine_ == card_map::engine::kArcGenerator;
    clock_arc(in, chord_tick);
    give(in.cut, engine.ready);
    if (commanded || in.tick || in.swap || !prescaler_.quiet()) clock_prescaler(in);
    delay(in, chord_tick);
    if (in.swap) engine_ = in.engine;
    if (in.cut) engine_ = card_map::engine::kLines;
    step();
  }

  const Outputs& outputs() const { return out_; }

  // The tick that shows is a path tick of an arc in chords.
  bool chord_tick() const { return chord_tick_; }

  // The path runs on the arc generator: its axes step on path ticks.
  bool on_chords() const { return engine_ == card_map::engine::kArcGenerator; }

  // For jumps. settled(): but for ticks on their way through the 3 clocks, nothing moves without inputs.
  bool settled() const {
    const bool arc = arc_.quiet() && !over_ && !over_next_ && (!on_chords() || own_ticks_ == 0);
    return arc && swaps_ == 0 && !out_.swap && waiting_ == 0 && !out_.path_tick && out_.step == 0 &&
           prescaler_.quiet() && accumulator_.quiet();
  }
  // As settled(), and without ticks.
  bool quiet() const {
    return settled() && ticks_ == 0 && !out_.tick && out_.done == said().ready && out_.elsewhere == !said().at_end &&
           out_.payload_ready;
  }
  // Ticks on their way: bit k belongs to an accumulation of the feed generator k clocks ago.
  unsigned in_flight() const { return (ticks_ >> 2 & 1) << 6 | (ticks_ >> 1 & 1) << 7 | (ticks_ & 1) << 8; }
  // The feed tick, from the prescaler's present state, before which a jump must end: on an arc in chords that which
  // ends a half chord, else the first that makes a path tick.
  std::uint64_t tick_that_stops() const { return prescaler_.ticks_until(on_chords() ? arc_.ticks_left() : 1); }

  // On an arc in chords.
  struct PathTicks {
    std::uint64_t at_axes = 0;
    bool visible = false;  // and one more leaves
  };
  // Before jump(): the path ticks of the `ticks` feed ticks that the prescaler took, of which these are on their way.
  PathTicks jump_chords(std::uint64_t ticks, unsigned in_flight) {
    PathTicks made;
    unsigned late = 0;
    for (unsigned k = kPrescaled; k < kPrescaled + kAtAxes; ++k) late += in_flight >> k & 1;
    made.at_axes = prescaler_.pass(ticks - late);
    std::uint32_t steps = 0;
    for (unsigned k = kAtAxes; k-- > 0;) {
      if ((in_flight >> (kPrescaled + k) & 1) != 0 && prescaler_.pass(1) != 0) steps |= 1U << k;
    }
    for (unsigned k = 0; k + 1 < kAtAxes; ++k) {
      if ((steps >> k & 1) != 0) prescaler_.place_step(k, false);
    }
    made.visible = (steps >> (kAtAxes - 1) & 1) != 0;
    chord_tick_ = made.visible;
    own_ticks_ = made.visible ? 1 : 0;
    arc_.pass(made.at_axes + own_ticks_);
    return made;
  }
  // What shows after clocks in which the prescaler took `ticks`, without a step but on an arc in chords, and these are
  // on their way (bit 9: the one before).
  void jump(std::uint64_t ticks, unsigned in_flight) {
    if (!on_chords()) prescaler_.silent_ticks(ticks);
    ticks_ = (in_flight >> 6 & 1) << 2 | (in_flight >> 7 & 1) << 1 | (in_flight >> 8 & 1);
    if (!on_chords()) own_ticks_ = ticks_;
    out_.tick = (own_ticks_ & 1) != 0;
    const bool feed_ticks = (in_flight >> 6 & 0xF) != 0;
    out_.done = !feed_ticks && said().ready;
    out_.elsewhere = !said().at_end;
    gate_payload_ready_ = !(feed_ticks && on_engine(engine_));
    out_.payload_ready = gate_payload_ready_ && arc_.outputs().loadable;
  }

  const PulseGenerator& prescaler() const { return prescaler_; }
  PulseGenerator& prescaler() { return prescaler_; }
  const DeviationAccumulator& accumulator() const { return accumulator_; }

 private:
  static constexpr unsigned kDelay = 3;  // feed domain to path domain
  // Clocks from an accumulation of the feed generator to the prescaler; from there to the axes on an arc in chords.
  static constexpr unsigned kPrescaled = 6;
  static constexpr unsigned kAtAxes = 4;

  static bool on_engine(std::uint8_t engine) { return engine != card_map::engine::kLines; }

  // What an engine says, from its registers.
  struct Said {
    bool ready = false;
    bool at_end = false;
    bool stepping = false;  // no load may come yet
    std::uint8_t step = 0;  // by axis
    std::uint8_t dir = 0;
  };
  // Of the engine on which the path runs. On lines nothing is asked.
  Said said() const {
    switch (engine_) {
      case card_map::engine::kArcGenerator:  // its steps are the axes' own, and it ends where they do
        return {true, true, false, 0, 0};
      default:
        return {accumulator_.outputs().ready, accumulator_.outputs().at_end, accumulator_.stepping(), routed_step_,
                routed_dir_};
    }
  }

  // What the sequencer may know of it, a clock late.
  void judge(const Inputs& in, const Said& engine) {
    const bool feed_ticks = in.tick || ticks_ != 0;
    const bool path_ticks = waiting_ != 0 || out_.path_tick;
    out_.done = !feed_ticks && !path_ticks && engine.ready;
    out_.elsewhere = !engine.at_end;
    gate_payload_ready_ = !(feed_ticks && on_engine(engine_)) && !path_ticks && !engine.stepping;
    over_next_ =
        engine_ == card_map::engine::kArcGenerator && !in.engine_taken && !feed_ticks && !arc_.outputs().loadable;
  }

  // The accumulator's two axes are those of its plane.
  void route(const LoadWord& load, const DeviationAccumulator::Outputs& accumulator) {
    const unsigned x = 1U << axis_x_;
    const unsigned y = 1U << axis_y_;
    routed_step_ = static_cast<std::uint8_t>((accumulator.step_x ? x : 0) | (accumulator.step_y ? y : 0));
    routed_dir_ = static_cast<std::uint8_t>((accumulator.dir_y ? y : 0) | (accumulator.dir_x ? x : 0));
    if (load.to(load_target::kPlane)) {
      axis_x_ = load.word >> 4 & 7;
      axis_y_ = load.word >> 8 & 7;
    }
  }

  void step() {
    const Said engine = said();
    out_.step = engine.step;
    out_.dir = engine.dir;
  }

  // Path ticks wait for the engine, which answers a tick with ready low a clock later.
  void give(bool cut, bool engine_ready) {
    const bool given = waiting_ != 0 && engine_ready && !out_.path_tick;
    const bool comes = prescaler_.outputs().step && engine_ != card_map::engine::kArcGenerator;
    waiting_ = cut ? 0 : waiting_ + (comes ? 1U : 0U) - (given ? 1U : 0U);
    out_.path_tick = given && !cut;
    out_.ready = waiting_ < 2 && arc_.outputs().ready;
    out_.payload_ready = gate_payload_ready_ && arc_.outputs().loadable;
  }

  void clock_prescaler(const Inputs& in) {
    prescaler_.clock({in.cut, in.tick, in.swap, on_engine(in.engine), false, false, in.load.to(load_target::kPrescale),
                      false, in.load.word});
  }

  // It is over when the path takes no more feed ticks and none is on its way.
  void clock_arc(const Inputs& in, bool tick) {
    const bool clear = in.cut || over_;
    over_ = over_next_;
    const bool start = in.swap && in.engine == card_map::engine::kArcGenerator;
    if (in.load.valid || clear || start || tick || clock_all_ || !arc_.quiet())
      arc_.clock({clear, in.load, start, tick});
    const ArcGenerator::Outputs& arc = arc_.outputs();
    out_.shadows_free = arc.loadable;
    out_.chord_word = arc.word;
    out_.chord_load = arc.load;
    out_.chord_swap = arc.swap;
  }

  void delay(const Inputs& in, bool chord_tick) {
    ticks_ = in.cut ? 0 : ticks_ >> 1 | (in.tick ? 1U << (kDelay - 1) : 0);
    swaps_ = in.cut ? 0 : swaps_ >> 1 | (in.swap ? 1U << (kDelay - 1) : 0);
    // The axes' own: feed ticks of lines, and an arc's path ticks, a clock after the generator.
    const bool own = in.tick && engine_ != card_map::engine::kArcGenerator;
    own_ticks_ = in.cut ? 0 : own_ticks_ >> 1 | (own ? 1U << (kDelay - 1) : 0) | (chord_tick ? 1 : 0);
    chord_tick_ = chord_tick && !in.cut;
    out_.tick = (own_ticks_ & 1) != 0;
    out_.swap = (swaps_ & 1) != 0;
  }

  bool clock_all_;
  DeviationAccumulator accumulator_;
  ArcGenerator arc_;
  bool over_ = false;  // the arc is
  bool over_next_ = false;
  bool gate_payload_ready_ = true;
  PulseGenerator prescaler_;
  std::uint32_t ticks_ = 0;      // on their way, bit k leaves in k clocks; bit 0 is visible
  std::uint32_t own_ticks_ = 0;  // those that the axes get
  bool chord_tick_ = false;      // the one that shows is the arc generator's
  std::uint32_t swaps_ = 0;
  std::uint32_t waiting_ = 0;                       // path ticks
  std::uint8_t engine_ = card_map::engine::kLines;  // of the path swapped in last
  // The accumulator's steps by axis.
  unsigned axis_x_ = 0;
  unsigned axis_y_ = 0;
  std::uint8_t routed_step_ = 0;
  std::uint8_t routed_dir_ = 0;
  Outputs out_;
};

}  // namespace trammel::model
