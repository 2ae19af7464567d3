// Settings of an axis: the step signals that its motor driver needs. Plain data, thread-safe.
#pragma once

#include <chrono>
#include <cstdint>

namespace trammel::driver {

enum class StepMode : std::uint8_t { kStepDirection = 0, kUpDown = 1, kQuadrature = 2 };

// Settings of an axis. Times are the minimum times of the motor driver's data sheet. The card keeps at least these
// times: each is rounded up to whole clocks, 0 .. 65535. A step pulse lasts at least 1 clock, and so does the space
// after it.
struct AxisSettings {
  std::chrono::nanoseconds step_length{0};      // length of the step pulse
  std::chrono::nanoseconds step_space{0};       // from the trailing edge to the next leading edge
  std::chrono::nanoseconds direction_setup{0};  // direction stable before the leading edge
  std::chrono::nanoseconds direction_hold{0};   // direction stable after the trailing edge
  StepMode mode = StepMode::kStepDirection;
  bool invert_first = false;   // pin STEP, UP or A
  bool invert_second = false;  // pin DIR, DOWN or B
};

}  // namespace trammel::driver
