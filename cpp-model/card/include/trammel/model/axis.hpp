// Golden model of an axis: pulse generator and the path engines' steps merged by one register, then the step shaper,
// with the axis's own settings. Not thread-safe. Units, ranges and rules: see the two parts.
//
// A tick at c that makes a step: path_step at c+4, at the shaper then.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/pulse_generator.hpp"
#include "trammel/model/step_shaper.hpp"

namespace trammel::model {

class Axis {
 public:
  struct Inputs {
    bool cut = false;
    bool tick = false;  // path domain
    bool swap = false;
    bool active = false;       // sampled with swap
    bool direct = false;       // sampled with swap: the count ends the axis, backwards mirrors forwards
    bool engine_step = false;  // from a path engine; never together with a step of the generator
    bool engine_dir = false;   // 1 = negative
    bool wait_tick = false;
    LoadWord load;  // INCREMENT and COUNT of this axis are its own
    // An arc's next chord: a halfword of its increment, never beside one on the load bus for this axis, and the swap
    // that keeps the phase.
    bool chord_load = false;
    bool chord_swap = false;
    std::uint16_t chord_word = 0;
    Setting setting;  // STEP_LENGTH, STEP_SPACE, DIR_SETUP, DIR_HOLD, MODE of this axis
  };
  struct Outputs {
    bool path_step = false;  // a step on its way to the shaper
    bool path_dir = false;   // of the last one
    bool live = false;       // direct: the count is not made
    StepShaper::Outputs shaper;
  };

  // `number`: 0 .. 7; `idle_level`: strap, {second pin, first pin}; `clock_all`: the shaper never rests.
  explicit Axis(unsigned number, unsigned idle_level = 0, bool clock_all = false)
      : number_(number), clock_all_(clock_all), shaper_(idle_level) {
    times_.mode = static_cast<std::uint8_t>((idle_level & 3) << 2);
  }

  // One rising edge.
  void clock(const Inputs& in) {
    times_.step = path_step_;
    times_.dir = path_dir_;
    times_.wait_tick = in.wait_tick;
    if (clock_all_)
      shaper_.clock_always(times_);
    else
      shaper_.clock(times_);
    const PulseGenerator::Outputs& made = generator_.outputs();
    path_step_ = made.step || in.engine_step;
    if (path_step_) path_dir_ = in.engine_step ? in.engine_dir : made.dir;
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
    generator_.clock(generator);
    if (in.setting.set) set(in.setting);
  }

  Outputs outputs() const { return {path_step_, path_dir_, generator_.outputs().live, shaper_.outputs()}; }

  // Nothing changes any more without new inputs.
  bool quiet() const { return generator_.quiet() && !path_step_ && shaper_.quiet() && times_.mode == shaper_.mode(); }

  // Ready for a jump: nothing on its way to the shaper, and there no step that waits.
  bool calm() const {
    return generator_.quiet() && !path_step_ && shaper_.calm() && times_.mode == shaper_.mode() &&
           !generator_.outputs().live && generator_.within_a_pulse();
  }

  // A step of a tick taken `clocks_ago` clocks ago that is not yet at the shaper, placed in flight.
  void place_step(std::uint64_t clocks_ago, bool backwards) {
    generator_.place_step(clocks_ago, backwards);
    path_step_ = clocks_ago == 3;
    if (clocks_ago >= 3) path_dir_ = backwards;
  }

  PulseGenerator& generator() { return generator_; }
  const PulseGenerator& generator() const { return generator_; }
  StepShaper& shaper() { return shaper_; }
  const StepShaper& shaper() const { return shaper_; }
  const StepShaper::Inputs& times() const { return times_; }

 private:
  void set(const Setting& setting) {
    namespace reg = card_map::reg;
    if (setting.address == reg::step_length(number_)) times_.step_length = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::step_space(number_)) times_.step_space = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::dir_setup(number_)) times_.dir_setup = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::dir_hold(number_)) times_.dir_hold = static_cast<std::uint16_t>(setting.data);
    if (setting.address == reg::mode(number_)) times_.mode = static_cast<std::uint8_t>(setting.data);
  }

  unsigned number_;
  bool clock_all_;
  PulseGenerator generator_;
  StepShaper shaper_;
  StepShaper::Inputs times_;
  bool path_step_ = false;
  bool path_dir_ = false;
};

}  // namespace trammel::model
