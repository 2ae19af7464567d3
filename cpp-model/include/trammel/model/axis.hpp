// Golden model of an axis: pulse generator and external steps merged by one register, then the step shaper.
// Not thread-safe. Units, ranges and rules: see the two parts.
#pragma once

#include <cstdint>

#include "trammel/model/pulse_generator.hpp"
#include "trammel/model/step_shaper.hpp"

namespace trammel::model {

class Axis {
 public:
  struct Inputs {
    PulseGenerator::Inputs generator;
    bool ext_step = false;      // from the deviation accumulator; never together with a step of the generator
    bool ext_dir = false;       // 1 = negative
    StepShaper::Inputs shaper;  // its step and dir are the axis's own, and not looked at
  };
  struct Outputs {
    bool path_step = false;  // a step on its way to the shaper
    bool path_dir = false;   // of the last one
    bool live = false;
    StepShaper::Outputs shaper;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    StepShaper::Inputs shaped = in.shaper;
    shaped.step = path_step_;
    shaped.dir = path_dir_;
    shaper_.clock(shaped);
    const PulseGenerator::Outputs& made = generator_.outputs();
    path_step_ = made.step || in.ext_step;
    if (path_step_) path_dir_ = in.ext_step ? in.ext_dir : made.dir;
    generator_.clock(in.generator);
  }

  Outputs outputs() const { return {path_step_, path_dir_, generator_.outputs().live, shaper_.outputs()}; }

  // Nothing changes any more without new inputs.
  bool quiet() const { return generator_.quiet() && !path_step_ && shaper_.quiet(); }

  // Clocks without tick, swap, load, clear, ext_step and clear_fault for which no output changes.
  std::uint64_t idle_clocks() const { return generator_.quiet() && !path_step_ ? shaper_.idle_clocks() : 0; }

  // n such clocks at once, n <= idle_clocks().
  void advance(std::uint64_t n) { shaper_.advance(n); }

  PulseGenerator& generator() { return generator_; }
  const PulseGenerator& generator() const { return generator_; }
  const StepShaper& shaper() const { return shaper_; }

 private:
  PulseGenerator generator_;
  StepShaper shaper_;
  bool path_step_ = false;
  bool path_dir_ = false;
};

}  // namespace trammel::model
