// PWM on outputs: register accesses, and the scale of a duty that follows the speed.
#include <fmt/format.h>

#include <cmath>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/pwm.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

namespace {

constexpr std::uint32_t kLeastPeriod = 100;
constexpr std::uint32_t kMostPeriod = 100'000'000;

void require_pwm(const Card& card) {
  if (card.has_pwm()) return;
  throw ArgumentError(fmt::format("PWM: the card has none (engines 0x{:X})", card.identification().engines));
}

}  // namespace

std::uint32_t pwm_period(double frequency_hz, std::uint32_t clock_hz) {
  constexpr double kLowest = 1;
  constexpr double kHighest = 1e6;
  if (!(frequency_hz >= kLowest && frequency_hz <= kHighest))
    throw ArgumentError(fmt::format("PWM: {} Hz: from 1 Hz to 1 MHz", frequency_hz));
  const double period = std::round(clock_hz / frequency_hz);
  if (period < kLeastPeriod || period > kMostPeriod) {
    throw ArgumentError(
        fmt::format("PWM: {} Hz are {:.0f} clocks of the card: from 100 to 100000000", frequency_hz, period));
  }
  return static_cast<std::uint32_t>(period);
}

PwmCommand pwm_for_speed(std::uint8_t channel, std::uint16_t duty, double rate) {
  return pwm_for_speed(channel, duty, rate, duty);
}

PwmCommand pwm_for_speed(std::uint8_t channel, std::uint16_t duty, double rate, std::uint16_t most) {
  constexpr unsigned kMostShift = 31;
  constexpr double kGains = 65536;
  if (!(rate > std::ldexp(1.0, -static_cast<int>(kMostShift)) && rate <= 1))
    throw ArgumentError(fmt::format("PWM: a rate of {} feed ticks per clock", rate));
  PwmCommand pwm{channel, most, true, 0, 0};
  double gain = std::round(duty / (2 * rate));
  while (gain >= kGains && pwm.shift < kMostShift) {
    ++pwm.shift;
    gain = std::round(duty / (2 * std::ldexp(rate, pwm.shift)));
  }
  pwm.gain = static_cast<std::uint16_t>(gain);
  return pwm;
}

bool Card::has_pwm() const { return card_map::has_engine(identification().engines, card_map::engine::kPwm); }

void Card::set_pwm(const PwmChannels& channels) {
  require_pwm(*this);
  const unsigned present = outputs_present();
  std::uint32_t outputs = 0;
  for (std::size_t n = 0; n < channels.size(); ++n) {
    const PwmChannel& c = channels[n];
    if (c.period < kLeastPeriod || c.period > kMostPeriod)
      throw ArgumentError(fmt::format("PWM channel {}: a period of {} clocks", n, c.period));
    if (c.outputs >> present != 0) {
      throw ArgumentError(
          fmt::format("PWM channel {}: outputs 0x{:X}: the card has {} outputs", n, c.outputs, present));
    }
    outputs |= std::uint32_t{c.outputs} << (n * field::kPwmOutputsChannel1Shift);
  }
  parts_->registers.write(reg::kPwmPeriod0, channels[0].period, "PWM");
  parts_->registers.write(reg::kPwmPeriod1, channels[1].period, "PWM");
  parts_->registers.write(reg::kPwmOutputs, outputs, "PWM");
}

PwmChannels Card::read_pwm() {
  require_pwm(*this);
  const std::uint32_t outputs = parts_->registers.read(reg::kPwmOutputs);
  PwmChannels channels;
  channels[0] = {parts_->registers.read(reg::kPwmPeriod0), static_cast<std::uint16_t>(outputs)};
  channels[1] = {parts_->registers.read(reg::kPwmPeriod1),
                 static_cast<std::uint16_t>(outputs >> field::kPwmOutputsChannel1Shift)};
  return channels;
}

}  // namespace trammel::driver
