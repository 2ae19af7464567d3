// Position streaming through trammel.h: periods in time, late and missing; periods that are refused before anything is
// sent.
#include "check.h"

#define MILLISECOND 1000000  // ns
#define PERIOD 1000          // a millisecond in clocks of the simulated card
#define PERIODS 50
#define SPEED 20  // pulses per period

static void streaming(trammel_card* card, const trammel_position_options* options) {
  DONE(trammel_set_slew_time(card, 10 * MILLISECOND));
  DONE(trammel_open_positions(card, options));
}

// Sends a period at whose end axis 0 is at `x` pulses and axis 1 at `x` - 1/4 pulses.
static trammel_result send_to(trammel_card* card, int64_t x, trammel_position_sent* sent) {
  int64_t targets[TRAMMEL_MAX_AXES] = {0};
  targets[0] = x * TRAMMEL_POSITION_PULSE;
  targets[1] = targets[0] - TRAMMEL_POSITION_PULSE / 4;
  return trammel_send_positions(card, targets, MILLISECOND, sent);
}

// Waits until the card's time is at least `clock`. The read takes some clocks itself.
static void wait_until(trammel_card* card, uint64_t clock) {
  trammel_snapshot snapshot;
  DONE(trammel_read_snapshot(card, &snapshot));
  if (snapshot.time < clock) DONE(trammel_simulated_wait(card, clock - snapshot.time));
}

// Sends each period when it is due; period number `late_one` is sent `late` clocks later. Returns the sum of the stale
// ticks.
static uint64_t send_periods(trammel_card* card, int periods, int late_one, uint64_t late) {
  trammel_position_sent sent;
  uint64_t stale = 0;
  int i;
  for (i = 1; i <= periods; ++i) {
    wait_until(card, PERIOD * (uint64_t)(i + 5) + (i == late_one ? late : 0));
    DONE(send_to(card, SPEED * i, &sent));
    CHECK(sent.ahead <= 2);
    CHECK((sent.stale_ticks != 0) == (i == late_one));
    CHECK(sent.stale_ticks == 0 || sent.ticks_behind == sent.stale_ticks);
    stale += sent.stale_ticks;
  }
  CHECK(sent.ticks_behind == 0);
  return stale;
}

static void periods_in_time(void) {
  trammel_card* card = simulated_card();
  trammel_snapshot snapshot;
  int64_t positions[TRAMMEL_MAX_AXES];
  streaming(card, NULL);
  CHECK(send_periods(card, PERIODS, 0, 0) == 0);
  DONE(send_to(card, SPEED * PERIODS, NULL));
  DONE(trammel_finish_positions(card, positions));
  CHECK(positions[0] == SPEED * PERIODS * TRAMMEL_POSITION_PULSE && positions[1] == positions[0]);
  CHECK(positions[2] == 0);
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] == SPEED * PERIODS && snapshot.position[1] == SPEED * PERIODS && !snapshot.status.busy);
  FAILS(send_to(card, 0, NULL), TRAMMEL_STATE, "closed");
  trammel_close(card);
}

// Half a period late: the card continues along the line, reports the stale ticks, and soon catches up.
static void a_late_period(void) {
  trammel_card* card = simulated_card();
  uint64_t stale;
  streaming(card, NULL);
  stale = send_periods(card, PERIODS, 21, PERIOD + PERIOD / 2);
  CHECK(stale > PERIOD / 8 && stale <= PERIOD / 4);  // 500 clocks are 250 ticks; the first transfer took some of them
  DONE(send_to(card, SPEED * PERIODS, NULL));
  DONE(trammel_finish_positions(card, NULL));
  trammel_close(card);
}

// No further period arrives: the card stops on the line, and continues from there after trammel_recover_positions().
static void a_missing_period(void) {
  trammel_card* card = simulated_card();
  trammel_position_stop stop;
  trammel_snapshot snapshot;
  uint32_t faults;
  memset(&stop, 0, sizeof stop);
  streaming(card, NULL);
  send_periods(card, 10, 0, 0);
  DONE(trammel_simulated_wait(card, 50000));
  FAILS(send_to(card, SPEED * 11, NULL), TRAMMEL_FAULT, "MISSING_PERIOD");
  faults = trammel_last_error()->faults;
  FAILS(send_to(card, SPEED * 11, NULL), TRAMMEL_STATE, "recover");
  DONE(trammel_recover_positions(card, &stop));
  CHECK(stop.faults == faults);
  CHECK(stop.stale_ticks >= 500);
  CHECK(stop.positions[0] > SPEED * 10 * TRAMMEL_POSITION_PULSE);
  CHECK(stop.positions[0] < SPEED * 30 * TRAMMEL_POSITION_PULSE);
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] * TRAMMEL_POSITION_PULSE == stop.positions[0] && !snapshot.status.busy);
  CHECK(snapshot.faults == 0);
  DONE(send_to(card, stop.positions[0] / TRAMMEL_POSITION_PULSE + 5, NULL));
  DONE(trammel_finish_positions(card, NULL));
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] * TRAMMEL_POSITION_PULSE == stop.positions[0] + 5 * TRAMMEL_POSITION_PULSE);
  trammel_close(card);
}

static void what_is_refused(void) {
  trammel_card* card = simulated_card();
  trammel_position_options options;
  trammel_command end = command_of(TRAMMEL_END);
  int64_t targets[TRAMMEL_MAX_AXES] = {0};
  memset(&options, 0, sizeof options);
  FAILS(send_to(card, 0, NULL), TRAMMEL_STATE, "trammel_open_positions()");
  FAILS(trammel_open_positions(card, &options), TRAMMEL_ARGUMENT, "ahead");
  options.ahead = 1;
  options.stale_periods = 256;
  FAILS(trammel_open_positions(card, &options), TRAMMEL_ARGUMENT, "256");
  options.stale_periods = 1;
  options.max_speed[0] = 1000;
  DONE(trammel_open_stream(card, NULL));
  streaming(card, &options);
  FAILS(send_to(card, 3, NULL), TRAMMEL_ARGUMENT, "axis 0");  // 3 pulses in 1 ms exceed max_speed
  FAILS(trammel_send_positions(card, targets, 10, NULL), TRAMMEL_ARGUMENT, "clocks");
  FAILS(trammel_send_positions(card, targets, -1, NULL), TRAMMEL_ARGUMENT, "ns");
  targets[7] = 1;
  FAILS(trammel_send_positions(card, targets, MILLISECOND, NULL), TRAMMEL_ARGUMENT, "axis 7");
  DONE(send_to(card, 1, NULL));
  FAILS(trammel_put(card, &end), TRAMMEL_STATE, "trammel_open_stream()");
  DONE(trammel_finish_positions(card, NULL));
  DONE(trammel_open_stream(card, NULL));
  FAILS(trammel_finish_positions(card, NULL), TRAMMEL_STATE, "trammel_open_positions()");
  DONE(trammel_put(card, &end));
  DONE(trammel_finish(card, NULL));
  trammel_close(card);
}

void test_positions(void) {
  periods_in_time();
  a_late_period();
  a_missing_period();
  what_is_refused();
}
