// Pulses on outputs: what stands in the card's registers. Duties come with commands (PwmCommand in commands.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace trammel::driver {

inline constexpr std::size_t kPwmChannels = 2;

struct PwmChannel {
  std::uint32_t period = 10'000;  // clocks, 100 .. 100,000,000
  std::uint16_t outputs = 0;      // bit n: output n carries its pulses; 0: the channel stands still
};
using PwmChannels = std::array<PwmChannel, kPwmChannels>;

// The period of a frequency, rounded to whole clocks. Throws ArgumentError for a frequency beyond 1 Hz to 1 MHz, and
// for one that a card with this clock cannot have.
std::uint32_t pwm_period(double frequency_hz, std::uint32_t clock_hz);

}  // namespace trammel::driver
