// Settings of an axis: the step signals that its motor driver asks for. Plain data, thread-safe.
#pragma once

#include <chrono>
#include <cstdint>

namespace trammel::driver {

enum class StepMode : std::uint8_t { kStepDirection = 0, kUpDown = 1, kQuadrature = 2 };

// Settings of an axis. Times are those of the motor driver's data sheet; the card keeps at least these: clocks are
// rounded up, 0 .. 65535 clocks each. A step pulse and its space last at least 1 clock.
struct AxisSettings {
  std::chrono::nanoseconds step_length{0};      // the pulse
  std::chrono::nanoseconds step_space{0};       // trailing edge to the next leading edge
  std::chrono::nanoseconds direction_setup{0};  // direction stable before the leading edge
  std::chrono::nanoseconds direction_hold{0};   // and after the trailing edge
  StepMode mode = StepMode::kStepDirection;
  bool invert_first = false;   // pin STEP, UP or A
  bool invert_second = false;  // pin DIR, DOWN or B
};

}  // namespace trammel::driver
