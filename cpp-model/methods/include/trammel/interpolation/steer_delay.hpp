// STEER's delay and start-up ramp: before each step (feedrate + drag) / 30 passes of an empty loop, where drag falls
// with every delay. Source: Goldberg & Goldberg, "XY Interpolation Algorithms", listing 1, delay(). A model of the
// program as printed, including its defects, which tests confirm:
//  - a larger feedrate gives a longer delay;
//  - feedrate + drag < 30 gives 0 passes; the loop, which counts up from 1 to that number, then runs until its int
//    wraps;
//  - only the line routine starts the ramp: a circle has none, or the rest of a line's ramp.
// Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>

namespace trammel::interpolation {

class SteerDelay {
 public:
  // `feedrate` in the program's unit: 30 * loop passes. 0 .. 2^30.
  explicit SteerDelay(std::int32_t feedrate) : feedrate_(feedrate) {}

  // The first action of the line routine.
  void arm() {
    drag_ = 100;
    oil_ = 1;
  }
  // The amount that the next delay adds to the feedrate.
  std::int32_t drag() const { return drag_; }
  // The number of passes intended for the next delay.
  std::int32_t passes() const { return (feedrate_ + drag_) / 30; }
  // Makes the next delay. Returns its passes, or nothing if it runs until its int wraps.
  std::optional<std::int32_t> delay() {
    const std::int32_t meant = passes();
    if (drag_ > 0) {
      drag_ -= oil_ * oil_;
      --oil_;
      if (drag_ < 0) drag_ = 0;
    }
    if (meant < 1) return std::nullopt;
    return meant;
  }

 private:
  std::int32_t feedrate_;
  std::int32_t drag_ = 0;  // a global variable in the program, so 0 before the first line
  std::int32_t oil_ = 0;
};

}  // namespace trammel::interpolation
