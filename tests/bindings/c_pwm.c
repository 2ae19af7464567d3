// PWM by trammel.h.
#include "check.h"

static void a_duty_in_the_stream(void) {
  trammel_card* card = simulated_card();
  const trammel_pwm_channel channels[TRAMMEL_PWM_CHANNELS] = {{1000, 1}, {200, 0}};
  trammel_pwm_channel now[TRAMMEL_PWM_CHANNELS];
  trammel_command duty = command_of(TRAMMEL_PWM);
  trammel_command line = line_of(1000, 100, 0);
  trammel_command feed = feed_of(1000);
  trammel_command end = command_of(TRAMMEL_END);
  bool has = false;
  DONE(trammel_has_pwm(card, &has));
  CHECK(has);
  DONE(trammel_set_pwm(card, channels));
  memset(now, 0xFF, sizeof now);
  DONE(trammel_read_pwm(card, now));
  CHECK(now[0].period == 1000 && now[0].outputs == 1 && now[1].period == 200 && now[1].outputs == 0);
  DONE(trammel_open_stream(card, NULL));
  duty.as.pwm.duty = 0x4000;  // a quarter
  DONE(trammel_put(card, &feed));
  DONE(trammel_put(card, &line));
  DONE(trammel_put(card, &duty));
  DONE(trammel_put(card, &end));
  DONE(trammel_finish(card, NULL));
  trammel_close(card);
}

static void with_the_speed(void) {
  trammel_pwm_command command;
  memset(&command, 0xFF, sizeof command);
  DONE(trammel_pwm_for_speed(1, 30000, 0.0625, 40000, &command));
  CHECK(command.channel == 1 && command.follows && command.duty == 40000 && command.gain != 0);
  FAILS(trammel_pwm_for_speed(1, 30000, 1.5, 40000, &command), TRAMMEL_ARGUMENT, "");
  FAILS(trammel_pwm_for_speed(1, 30000, 0.5, 40000, NULL), TRAMMEL_ARGUMENT, "command is null");
}

static void bad_pwm(void) {
  trammel_card* card = simulated_card();
  trammel_pwm_channel channels[TRAMMEL_PWM_CHANNELS] = {{99, 1}, {200, 0}};
  trammel_command duty = command_of(TRAMMEL_PWM);
  uint32_t period = 0;
  DONE(trammel_pwm_period(1000, 1000000, &period));
  CHECK(period == 1000);
  FAILS(trammel_pwm_period(0.5, 1000000, &period), TRAMMEL_ARGUMENT, "");
  FAILS(trammel_pwm_period(1000, 1000000, NULL), TRAMMEL_ARGUMENT, "period is null");
  FAILS(trammel_set_pwm(card, channels), TRAMMEL_ARGUMENT, "");
  FAILS(trammel_set_pwm(card, NULL), TRAMMEL_ARGUMENT, "channels is null");
  FAILS(trammel_read_pwm(card, NULL), TRAMMEL_ARGUMENT, "channels is null");
  FAILS(trammel_has_pwm(card, NULL), TRAMMEL_ARGUMENT, "has is null");
  DONE(trammel_open_stream(card, NULL));
  duty.as.pwm.channel = 2;
  FAILS(trammel_put(card, &duty), TRAMMEL_ARGUMENT, "");
  trammel_close(card);
}

void test_pwm(void) {
  a_duty_in_the_stream();
  with_the_speed();
  bad_pwm();
}
