// Golden models of the card's small blocks: arc router, hold timer, busy timer. Not thread-safe; no errors are
// reported.
#pragma once

#include <cstdint>

#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::model {

// The accumulator's steps on their way to the two axes of the plane, one clock late.
class ArcRouter {
 public:
  void clock(bool load_plane, std::uint16_t word, const DeviationAccumulator::Outputs& in) {
    const std::uint32_t x = 1U << axis_x_;
    const std::uint32_t y = 1U << axis_y_;
    step_ = (in.step_x ? x : 0) | (in.step_y ? y : 0);
    dir_ = (in.dir_y ? ~x : 0) | (in.dir_x ? x : 0);
    if (load_plane) {
      axis_x_ = word >> 4 & 7;
      axis_y_ = word >> 8 & 7;
    }
  }
  void reset() { step_ = 0; }
  std::uint32_t step() const { return step_; }  // by axis
  std::uint32_t dir() const { return dir_; }    // by axis; means something with a step

 private:
  unsigned axis_x_ = 0;
  unsigned axis_y_ = 0;
  std::uint32_t step_ = 0;
  std::uint32_t dir_ = 0;
};

// One clock in `limit` (clocks, at least 1).
class HoldTimer {
 public:
  // `limit`: HOLD_LIMIT behind reset, clocks.
  explicit HoldTimer(std::uint32_t limit) : limit_(limit) {}

  // A limit counts from the next clock on.
  void clock(std::uint32_t limit) {
    tick_ = count_ + 1 >= limit_;
    count_ = tick_ ? 0 : count_ + 1;
    limit_ = limit;
  }
  // The same as clock() n times.
  void advance(std::uint32_t limit, std::uint64_t n) {
    if (n == 0) return;
    clock(limit);
    if (n == 1) return;
    // A limit lowered below the count is caught up by the clock in which it counts first.
    clock(limit);
    const std::uint64_t sum = count_ + (n - 2);
    if (n > 2) {
      count_ = static_cast<std::uint32_t>(sum % limit);
      tick_ = count_ == 0;
    }
  }
  bool tick() const { return tick_; }

 private:
  std::uint32_t limit_;
  std::uint32_t count_ = 0;
  bool tick_ = false;
};

// Busy until nothing has run for 8 clocks.
class BusyTimer {
 public:
  void clock(bool running) {
    busy_ = running || left_ != 0;
    if (running)
      left_ = 7;
    else if (left_ != 0)
      --left_;
  }
  bool busy() const { return busy_; }
  // True when clocks with the same input change nothing.
  bool quiet(bool running) const { return running ? busy_ && left_ == 7 : !busy_ && left_ == 0; }

 private:
  std::uint32_t left_ = 0;
  bool busy_ = false;
};

}  // namespace trammel::model
