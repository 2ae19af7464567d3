// Encodes the steps of one axis as numbers: the time of each step at its shaper, and its delay to the pin. Not
// thread-safe.
//
// `steps`: for each step zigzag(interval - previous interval) * 2 + (1 if the direction changes), as a varint. The
// first interval is relative to 0 and clock 0, the first direction to +1. At constant speed this is a byte per step,
// which deflate halves. `delays`: pairs of varints, the number of steps with one delay and the zigzag of the change to
// the next delay. Delays begin with 0, and the last one applies to the end.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "trammel/report/page_stream.hpp"

namespace trammel::report {

class StepCoder {
 public:
  StepCoder(run::TextSink& sink, unsigned axis)
      : steps_(sink, "steps-" + std::to_string(axis)), delays_(sink, "delays-" + std::to_string(axis)) {}

  void path_step(std::uint64_t cycle, int direction) {
    const auto interval = static_cast<std::int64_t>(cycle - last_);
    const std::int64_t change = interval - interval_;
    const std::uint64_t zigzag = static_cast<std::uint64_t>(change) << 1 ^ (change < 0 ? ~std::uint64_t{0} : 0);
    steps_.varint(zigzag << 1 | (direction != direction_ ? 1U : 0U));
    last_ = cycle;
    interval_ = interval;
    direction_ = direction;
    on_their_way_.push_back({cycle, true});
  }
  // Records a step that is not in the page.
  void pass() { on_their_way_.push_back({0, false}); }
  // Call for each step at the pin, which keeps the order of the steps.
  void pin_step(std::uint64_t cycle) {
    if (on_their_way_.empty()) return;
    const Step step = on_their_way_.front();
    on_their_way_.pop_front();
    if (!step.inside) return;
    const auto delay = static_cast<std::int64_t>(cycle - step.cycle);
    if (delay != delay_) {
      delays_.varint(run_);
      delays_.zigzag(delay - delay_);
      delay_ = delay;
      run_ = 0;
    }
    ++run_;
  }
  void finish() {
    steps_.finish();
    delays_.finish();
  }

 private:
  PageStream steps_;
  PageStream delays_;
  std::uint64_t last_ = 0;
  std::int64_t interval_ = 0;
  int direction_ = 1;
  struct Step {
    std::uint64_t cycle;
    bool inside;
  };
  std::deque<Step> on_their_way_;  // steps in the shaper, at most as many as it holds
  std::int64_t delay_ = 0;
  std::uint64_t run_ = 0;
};

}  // namespace trammel::report
