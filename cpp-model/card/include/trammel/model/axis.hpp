// Golden model of an axis. A register merges the steps of the pulse generator with those of the path engines and
// feeds the step shaper; the axis keeps its own settings. Not thread-safe. Units, ranges and rules: see
// PulseGenerator and StepShaper.
//
// A tick in clock c that makes a step shows as path_step in c+4; the shaper receives the step in that clock.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/clock_each.hpp"
#include "trammel/model/pulse_generator.hpp"
#include "trammel/model/step_shaper.hpp"

namespace trammel::model {

class Axis {
 public:
  struct Inputs {
    bool cut = false;
    bool tick = false;  // path domain
    bool swap = false;
    bool active = false;       // sampled with swap: the axis takes part in the path
    bool direct = false;       // sampled with swap: the count ends the move, and backward mirrors forward
    bool silent = false;       // steps are dropped
    bool engine_step = false;  // from a path engine; never in the clock of a step of the pulse generator
    bool engine_dir = false;   // 1 = negative
    bool wait_tick = false;
    LoadWord load;  // load bus; the axis takes its own INCREMENT and COUNT
    // The next chord of an arc. chord_load shifts in a halfword of its increment, never in a clock in which the load
    // bus addresses this axis. chord_swap takes the increment and keeps the phase.
    bool chord_load = false;
    bool chord_swap = false;
    std::uint16_t chord_word = 0;
    Setting setting;  // STEP_LENGTH, STEP_SPACE, DIR_SETUP, DIR_HOLD, MODE of this axis
  };
  struct Outputs {
    bool path_step = false;  // a step on its way to the shaper
    bool path_dir = false;   // direction of the last step, 1 = negative
    bool live = false;       // direct mode: the axis has not made all pulses of its count
    StepShaper::Outputs shaper;
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    PulseGenerator generator;
    StepShaper shaper;
    StepShaper::Inputs times;  // only the settings of the axis; the other fields keep their defaults
    bool path_step = false;
    bool path_dir = false;
  };

  // `number`: 0 .. 7; `idle_level`: strap, {second pin, first pin}.
  explicit Axis(unsigned number, unsigned idle_level = 0) : number_(number) {
    state_.shaper = StepShaper(idle_level);
    state_.times.mode = static_cast<std::uint8_t>((idle_level & 3) << 2);
  }

  // One rising edge.
  void clock(const Inputs& in) { clock_parts(in, ClockEach()); }
  template <class ClockPart>
  void clock_parts(const Inputs& in, const ClockPart& clock_part) {
    StepShaper::Inputs shaper = state_.times;
    shaper.step = state_.path_step;
    shaper.dir = state_.path_dir;
    shaper.wait_tick = in.wait_tick;
    clock_part(state_.shaper, shaper);
    const PulseGenerator::Outputs& made = state_.generator.outputs();
    state_.path_step = (made.step || in.engine_step) && !in.silent;
    if (state_.path_step) state_.path_dir = in.engine_step ? in.engine_dir : made.dir;
    PulseGenerator::Inputs generator;
    generator.clear = in.cut;
    generator.tick = in.tick;
    generator.swap = in.swap;
    generator.active = in.active;
    generator.counted = generator.mirror = in.direct;
    generator.chord = in.chord_swap;
    generator.load_increment = in.load.to(load_target::increment(number_)) || in.chord_load;
    generator.load_count = in.load.to(load_target::count(number_));
    generator.word = in.chord_load ? in.chord_word : in.load.word;
    clock_part(state_.generator, generator);
    if (in.setting.set) set(in.setting);
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  Outputs outputs() const {
    return {state_.path_step, state_.path_dir, state_.generator.outputs().live, state_.shaper.outputs()};
  }

 private:
  void set(const Setting& setting) {
    namespace reg = card_map::reg;
    if (setting.address == reg::step_length(number_))
      state_.times.step_length = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::step_space(number_)) state_.times.step_space = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::dir_setup(number_)) state_.times.dir_setup = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::dir_hold(number_)) state_.times.dir_hold = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::mode(number_)) state_.times.mode = static_cast<std::uint8_t>(setting.data);
  }

  unsigned number_;

  State state_;
};

}  // namespace trammel::model
