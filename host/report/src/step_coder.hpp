// The steps of one axis as numbers: when each came to its shaper, and how much later it was at the pin. Not
// thread-safe.
//
// `steps`: for each step zigzag(interval - interval before) * 2 + (1 where the direction turns), as a varint; intervals
// begin with 0 at clock 0, the direction with +1. At a constant speed that is a byte a step, and deflate leaves half of
// it. `delays`: pairs of varints, the number of steps of one delay and the zigzag of the change to the next one; delays
// begin with 0, and the last one holds to the end.
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
  // A step that is not in the page.
  void pass() { on_their_way_.push_back({0, false}); }
  // The pin makes the steps in their order.
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
  std::deque<Step> on_their_way_;  // as many as a shaper holds
  std::int64_t delay_ = 0;
  std::uint64_t run_ = 0;
};

}  // namespace trammel::report
