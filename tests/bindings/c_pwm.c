// PWM through trammel.h.
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
  duty.as.pwm.duty = 0x4000;  // duty of 1/4
  DONE(trammel_put(card, &feed));
  DONE(trammel_put(card, &line));
  DONE(trammel_put(card, &duty));
  DONE(trammel_put(card, &end));
  DONE(trammel_finish(card, NULL));
  trammel_close(card);
}

// A bus that records the words of the stream.
typedef struct noting_bus {
  trammel_card* behind;
  uint32_t words[64];
  size_t count;
} noting_bus;

static size_t note_and_transfer(void* context, trammel_access* accesses, size_t count) {
  const uint32_t stream = 0x610;
  noting_bus* bus = (noting_bus*)context;
  size_t made = 0;
  size_t i;
  DONE(trammel_transfer(bus->behind, accesses, count, &made));
  for (i = 0; i < made; ++i) {
    if (accesses[i].write && accesses[i].address == stream && bus->count < 64)
      bus->words[bus->count++] = accesses[i].data;
  }
  return made;
}

// The last three halfwords of the command are select, duty and gain, as in docs/reference/commands.md.
static void a_duty_in_words(void) {
  noting_bus is;
  trammel_bus bus;
  trammel_card* card = NULL;
  trammel_command duty = command_of(TRAMMEL_PWM);
  memset(&is, 0, sizeof is);
  memset(&bus, 0, sizeof bus);
  is.behind = simulated_card();
  bus.context = &is;
  bus.transfer = note_and_transfer;
  bus.reports_refusals = true;
  DONE(trammel_open_bus(&bus, &card));
  DONE(trammel_open_stream(card, NULL));
  duty.as.pwm.channel = 1;
  duty.as.pwm.duty = 0x1234;
  duty.as.pwm.follows = true;
  duty.as.pwm.shift = 21;
  duty.as.pwm.gain = 0xABCD;
  DONE(trammel_put(card, &duty));
  DONE(trammel_flush(card));
  CHECK(is.count == 4);
  CHECK(is.words[2] >> 16 == (1U | 1U << 4 | 21U << 8));
  CHECK(is.words[3] == (0x1234 | 0xABCDU << 16));
  trammel_close(card);
  trammel_close(is.behind);
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
  a_duty_in_words();
  with_the_speed();
  bad_pwm();
}
