// STEER's delay and start-up ramp: before each step (feedrate + drag) / 30 passes of an empty loop, where drag falls
// with every delay. Source: Goldberg & Goldberg, "XY Interpolation Algorithms", listing 1, delay().
// A model of the program as printed, with its defects, which tests pin down:
//  - a larger feedrate gives a longer delay;
//  - feedrate + drag < 30 gives 0 passes, and the loop, which counts up from 1 to that number, then runs until its int
//    wraps;
//  - the line routine alone arms the ramp: a circle has none, or what a line has left of it.
// Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>

namespace trammel::interpolation {

class SteerDelay {
 public:
  // `feedrate` in the program's unit: loop passes * 30. 0 .. 2^30.
  explicit SteerDelay(std::int32_t feedrate) : feedrate_(feedrate) {}

  // What the line routine does first.
  void arm() {
    drag_ = 100;
    oil_ = 1;
  }
  // What the next delay adds to the feedrate.
  std::int32_t drag() const { return drag_; }
  // Passes that the next delay is meant to take.
  std::int32_t passes() const { return (feedrate_ + drag_) / 30; }
  // The next delay: the passes it takes, or nothing when it runs until its int wraps.
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
  std::int32_t drag_ = 0;  // the program's are global, so 0 before the first line
  std::int32_t oil_ = 0;
};

}  // namespace trammel::interpolation
