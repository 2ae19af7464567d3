// PWM on outputs.
#include "trammel/driver/pwm.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "card.hpp"
#include "commands.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

void set_pwm(PythonCard& of, const std::vector<driver::PwmChannel>& channels) {
  driver::PwmChannels all;
  if (channels.size() != all.size()) throw driver::ArgumentError("set_pwm: a card has 2 channels");
  std::copy(channels.begin(), channels.end(), all.begin());
  of.card.set_pwm(all);
}

std::vector<driver::PwmChannel> read_pwm(PythonCard& of) {
  const driver::PwmChannels all = of.card.read_pwm();
  return {all.begin(), all.end()};
}

PythonCommand pwm_for_speed(std::uint8_t channel, std::uint16_t duty, double rate, std::optional<std::uint16_t> most) {
  return {driver::pwm_for_speed(channel, duty, rate, most.value_or(duty))};
}

}  // namespace

void bind_pwm(nb::module_& m, nb::class_<PythonCard>& card) {
  nb::class_<driver::PwmChannel>(m, "PwmChannel", "What stands in the card of a channel of pulses.")
      .def(nb::init<std::uint32_t, std::uint16_t>(), "period"_a = 10'000, "outputs"_a = 0,
           "period in clocks, 100 to 100,000,000; outputs: a mask.")
      .def_ro("period", &driver::PwmChannel::period, "Clocks of the card.")
      .def_ro("outputs", &driver::PwmChannel::outputs,
              "Bit n: output n carries its pulses; 0: the channel stands still.");
  card.def_prop_ro(
          "has_pwm", [](const PythonCard& of) { return of.card.has_pwm(); }, "Whether the card has channels of pulses.")
      .def("set_pwm", waiting(set_pwm), "channels"_a,
           "Sets both channels, a list of two PwmChannel. One whose period is written ends its pulse and begins anew.")
      .def("read_pwm", waiting(read_pwm), "Both channels, as they stand in the card.");
  m.def("pwm_period", driver::pwm_period, "frequency_hz"_a, "clock_hz"_a,
        "The period of a frequency of 1 Hz to 1 MHz in clocks, for a card with this clock.");
  m.def(
      "pwm",
      [](std::uint8_t channel, std::uint16_t duty) {
        return PythonCommand{driver::PwmCommand{channel, duty, false, 0, 0}};
      },
      "channel"_a, "duty"_a, "The duty of a channel (0 or 1) from here on: 2^-16 of the period, 65535: full.");
  m.def("pwm_for_speed", pwm_for_speed, "channel"_a, "duty"_a, "rate"_a, "most"_a = nb::none(),
        "A duty that follows the speed: duty (2^-16 of the period) at rate feed ticks a clock (2^-31 < rate <= 1), in "
        "proportion at others, and most (None: duty) at most.");
}

}  // namespace trammel::python
