// Golden model of the tick counter: counts a path's, a piece's or a dwell's ticks down to the last one.
// Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

namespace trammel::model {

class TickCounter {
 public:
  // One rising edge. `count` (1 .. 2^40 - 1) is taken with `load`, else `take` counts one tick off.
  void clock(bool load, std::uint64_t count, bool take) {
    if (load) {
      left_ = count;
    } else if (take) {
      --left_;
    }
  }

  // The next tick taken is the last one.
  bool last() const { return left_ == 1; }

  // Ticks left, the last one included.
  std::uint64_t left() const { return left_; }

  // `ticks` takes at once; fewer than left().
  void advance(std::uint64_t ticks) { left_ -= ticks; }

 private:
  std::uint64_t left_ = 0;
};

}  // namespace trammel::model
