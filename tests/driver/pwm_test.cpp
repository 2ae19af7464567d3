// PWM on outputs: writes and reads of the driver, and the scale of a duty that follows the speed.
#include <gmock/gmock.h>

#include <cmath>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using test::RegisterStub;
using test::was_read;
using test::wrote;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace reg = card_map::reg;

TEST(PwmSettings, PeriodsComeBeforeTheOutputs) {
  RegisterStub bus;
  bus.add_engines(card_map::engines::kPathCommands | card_map::engines::kPwm);
  bus.values[reg::kPorts] = 0x04'04'01;
  Card card = Card::open(bus);
  bus.forget();
  card.set_pwm({PwmChannel{100, 1}, PwmChannel{100'000'000, 2}});
  EXPECT_THAT(bus.log, ElementsAre(was_read(reg::kPorts), wrote(reg::kPwmPeriod0, 100),
                                   wrote(reg::kPwmPeriod1, 100'000'000), wrote(reg::kPwmOutputs, 0x0002'0001)));
  bus.forget();
  EXPECT_THAT(argument_error([&] {
                card.set_pwm({PwmChannel{99, 1}, PwmChannel{}});
              }),
              HasSubstr("channel 0: a period"));
  EXPECT_THAT(argument_error([&] {
                card.set_pwm({PwmChannel{}, PwmChannel{100'000'001, 1}});
              }),
              HasSubstr("channel 1: a period"));
  EXPECT_THAT(argument_error([&] { card.set_pwm({PwmChannel{}, PwmChannel{100, 0x8000}}); }), HasSubstr("0x8000"));
  EXPECT_THAT(bus.log, Each(was_read(reg::kPorts)));
}

TEST(PwmSettings, ACardWithoutThemSaysSo) {
  RegisterStub bus;
  Card card = Card::open(bus);
  EXPECT_FALSE(card.has_pwm());
  EXPECT_THAT(argument_error([&] { card.set_pwm({}); }), HasSubstr("PWM: the card has none"));
  EXPECT_THAT(argument_error([&] { card.read_pwm(); }), HasSubstr("PWM: the card has none"));
}

TEST(PwmSettings, AreReadAsTheyStandInTheCard) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  card.set_pwm({PwmChannel{12'345, 5}, PwmChannel{54'321, 10}});
  const PwmChannels channels = card.read_pwm();
  EXPECT_EQ(channels[0].period, 12'345U);
  EXPECT_EQ(channels[0].outputs, 5U);
  EXPECT_EQ(channels[1].period, 54'321U);
  EXPECT_EQ(channels[1].outputs, 10U);
}

TEST(PwmSettings, AFrequencyIsAPeriodOfWholeClocks) {
  EXPECT_EQ(pwm_period(1, 100'000'000), 100'000'000U);
  EXPECT_EQ(pwm_period(1e6, 100'000'000), 100U);
  EXPECT_EQ(pwm_period(30'000, 100'000'000), 3333U);
  EXPECT_THAT(argument_error([] { pwm_period(0.9, 100'000'000); }), HasSubstr("from 1 Hz"));
  EXPECT_THAT(argument_error([] { pwm_period(1.1e6, 100'000'000); }), HasSubstr("to 1 MHz"));
  EXPECT_THAT(argument_error([] { pwm_period(1e6, 50'000'000); }), HasSubstr("50 clocks"));
  EXPECT_THAT(argument_error([] { pwm_period(1, 100'000'001); }), HasSubstr("100000001 clocks of the card"));
}

// The card's duty at a rate, in the exact arithmetic of the reference.
double duty_at(const PwmCommand& pwm, double rate) {
  const double u = std::floor(rate * 0x1p31 + 0.5);
  const double w = std::min(std::ldexp(u, pwm.shift), 0x1p31 - 1);
  return std::min<double>(pwm.duty, std::floor(w * pwm.gain / 0x1p30));
}

TEST(PwmScale, IsFullAtTheProgrammedRate) {
  for (const double rate : {1.0, 0.7, 0.1, 3e-3, 4e-5}) {
    for (const unsigned duty : {65535U, 40'000U, 6554U, 100U}) {
      const PwmCommand pwm = pwm_for_speed(1, static_cast<std::uint16_t>(duty), rate);
      EXPECT_EQ(pwm.channel, 1);
      EXPECT_TRUE(pwm.follows);
      EXPECT_NEAR(duty_at(pwm, rate), duty, 1.5 + duty * 0x1p-15) << rate << " " << duty;
      EXPECT_NEAR(duty_at(pwm, rate / 4), duty / 4.0, 1.5 + duty * 0x1p-15) << rate << " " << duty;
      EXPECT_LE(duty_at(pwm, 1), duty);
    }
  }
  EXPECT_THAT(argument_error([] { pwm_for_speed(0, 1, 1.01); }), HasSubstr("1.01"));
  EXPECT_THAT(argument_error([] { pwm_for_speed(0, 1, 0); }), HasSubstr("rate of 0"));
}

}  // namespace
}  // namespace trammel::driver
