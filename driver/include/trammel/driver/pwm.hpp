// PWM on outputs: the settings in the card's registers. Duties come with commands (PwmCommand in commands.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace trammel::driver {

inline constexpr std::size_t kPwmChannels = 2;

struct PwmChannel {
  std::uint32_t period = 10'000;  // clocks, 100 .. 100,000,000
  std::uint16_t outputs = 0;      // bit n: output n carries its pulses; 0: the channel is off
};
using PwmChannels = std::array<PwmChannel, kPwmChannels>;

// The period of a frequency, rounded to whole clocks. Throws ArgumentError for a frequency outside 1 Hz to 1 MHz, and
// for a period that the card cannot make at this clock.
std::uint32_t pwm_period(double frequency_hz, std::uint32_t clock_hz);

}  // namespace trammel::driver
