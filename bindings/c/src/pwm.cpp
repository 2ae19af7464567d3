// PWM on outputs.
#include "trammel/driver/pwm.hpp"

#include <algorithm>

#include "handle.hpp"

namespace trammel::c {

static_assert(TRAMMEL_PWM_CHANNELS == driver::kPwmChannels);

}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;

trammel_result trammel_has_pwm(trammel_card* card, bool* has) {
  return guarded([=] { required(has, "has") = card_of(card).has_pwm(); });
}

trammel_result trammel_pwm_period(double frequency_hz, uint32_t clock_hz, uint32_t* period) {
  return guarded([=] { required(period, "period") = driver::pwm_period(frequency_hz, clock_hz); });
}

trammel_result trammel_set_pwm(trammel_card* card, const trammel_pwm_channel* channels) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    const trammel_pwm_channel* const from = &required(channels, "channels");
    driver::PwmChannels to;
    std::transform(from, from + TRAMMEL_PWM_CHANNELS, to.begin(), [](const trammel_pwm_channel& one) {
      return driver::PwmChannel{one.period, one.outputs};
    });
    of.set_pwm(to);
  });
}

trammel_result trammel_read_pwm(trammel_card* card, trammel_pwm_channel* channels) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    trammel_pwm_channel* const to = &required(channels, "channels");
    const driver::PwmChannels from = of.read_pwm();
    std::transform(from.begin(), from.end(), to, [](const driver::PwmChannel& one) {
      return trammel_pwm_channel{one.period, one.outputs};
    });
  });
}

trammel_result trammel_pwm_for_speed(uint8_t channel, uint16_t duty, double rate, uint16_t most,
                                     trammel_pwm_command* command) {
  return guarded([=] {
    const driver::PwmCommand made = driver::pwm_for_speed(channel, duty, rate, most);
    required(command, "command") = {made.channel, made.duty, made.follows, made.shift, made.gain};
  });
}
