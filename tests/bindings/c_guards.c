// Captures, soft limits, drives and the emergency stop through trammel.h.
#include "check.h"

#define TOUCH 3  // input that the captures watch
#define SECOND 1000000000

static trammel_status state_now(trammel_card* card) {
  trammel_status status;
  memset(&status, 0xFF, sizeof status);
  DONE(trammel_read_status(card, &status));
  return status;
}

static uint16_t outputs_of(trammel_card* card) {
  uint16_t levels = 0xFFFF;
  DONE(trammel_read_outputs(card, &levels));
  return levels;
}

static void pass(trammel_card* card, uint64_t clocks) { DONE(trammel_simulated_wait(card, clocks)); }

// A line along axis 0 at 1000 pulses/s.
static trammel_one_shot line_by(int64_t pulses) {
  trammel_one_shot line;
  memset(&line, 0, sizeof line);
  line.pulses[0] = pulses;
  line.duration_ns = (pulses < 0 ? -pulses : pulses) * 1000000;
  return line;
}

static void go(trammel_card* card, int64_t pulses) {
  const trammel_one_shot line = line_by(pulses);
  DONE(trammel_start_line(card, &line, NULL));
}

static void touch(trammel_card* card, bool level, uint64_t clocks) {
  DONE(trammel_simulated_set_input(card, TOUCH, level));
  pass(card, clocks);
}

static trammel_capture_state unit_of(trammel_card* card, unsigned unit) {
  trammel_capture_states states;
  memset(&states, 0xFF, sizeof states);
  DONE(trammel_read_captures(card, &states));
  return states.units[unit];
}

// A card with a filter of 640 clocks at input TOUCH, and a capture unit that watches this input.
static trammel_card* card_that_captures(unsigned unit, bool both, bool continuous) {
  trammel_card* card = simulated_card();
  trammel_capture_select select = {TOUCH, true, false, false, false};
  unsigned units = 0;
  DONE(trammel_count_captures(card, &units));
  CHECK(units == TRAMMEL_MAX_CAPTURES);
  DONE(trammel_set_input_filter(card, TOUCH, 640000));
  pass(card, 3000);
  select.to_inactive = both;
  select.continuous = continuous;
  DONE(trammel_select_capture(card, unit, &select));
  return card;
}

// A capture holds time and position of the first touch, not of the end of the filter.
static void an_edge_in_motion(void) {
  trammel_card* card = card_that_captures(2, false, false);
  trammel_snapshot before;
  trammel_capture capture;
  trammel_capture_states states;
  bool taken = true;
  DONE(trammel_take_capture(card, 2, &capture, &taken));
  CHECK(!taken);
  go(card, 100);
  pass(card, 41100);
  DONE(trammel_read_snapshot(card, &before));
  touch(card, true, 20);
  touch(card, false, 30);  // a bounce
  touch(card, true, 100);
  CHECK(unit_of(card, 2).pending && !unit_of(card, 2).valid);
  pass(card, 2000);
  CHECK(unit_of(card, 2).valid && !unit_of(card, 2).pending && unit_of(card, 2).active && !unit_of(card, 1).valid);
  memset(&capture, 0xFF, sizeof capture);
  DONE(trammel_take_capture(card, 2, &capture, &taken));
  CHECK(taken && capture.active && !capture.overrun);
  CHECK(capture.at.time >= before.time && capture.at.time < before.time + 200);
  CHECK(capture.at.position[0] == before.position[0] && before.position[0] > 30 && capture.at.status.direct);
  DONE(trammel_take_capture(card, 2, &capture, &taken));
  CHECK(!taken);
  DONE(trammel_read_captures(card, &states));
  CHECK(states.snapshots == 1);
  trammel_close(card);
}

static bool always(void* context) { return *(bool*)context; }

static void waiting_for_edges(void) {
  trammel_card* card = card_that_captures(0, true, true);
  trammel_capture first;
  trammel_capture second;
  bool ended = true;
  memset(&first, 0xFF, sizeof first);
  memset(&second, 0xFF, sizeof second);
  FAILS(trammel_wait_for_capture(card, 0, 10000000, &first), TRAMMEL_TIMEOUT, "waiting for a capture");
  trammel_set_interrupt(always, &ended);
  FAILS(trammel_wait_for_capture(card, 0, INT64_C(1000) * SECOND, &first), TRAMMEL_CANCELLED, "goes on watching");
  trammel_set_interrupt(NULL, NULL);
  touch(card, true, 2000);
  touch(card, false, 2000);
  CHECK(unit_of(card, 0).overrun);
  DONE(trammel_wait_for_capture(card, 0, 10000000, &first));
  CHECK(first.active && first.overrun);
  touch(card, true, 2000);
  DONE(trammel_wait_for_capture(card, 0, 10000000, &second));
  CHECK(second.active && !second.overrun && second.at.time > first.at.time + 3900);
  DONE(trammel_stop_capture(card, 0));
  touch(card, false, 2000);
  CHECK(!unit_of(card, 0).valid);
  trammel_close(card);
}

// After more edges than the queue holds, the oldest ones remain.
static void a_queue_of_edges(void) {
  trammel_card* card = card_that_captures(0, true, true);
  trammel_capture_select select = {TOUCH, true, true, true, true};
  trammel_capture_queue queue;
  trammel_queued_capture captures[TRAMMEL_CAPTURE_QUEUE];
  unsigned count = 0;
  unsigned n;
  bool has = false;
  DONE(trammel_has_capture_queue(card, &has));
  CHECK(has);
  DONE(trammel_select_capture(card, 3, &select));
  for (n = 0; n < TRAMMEL_CAPTURE_QUEUE + 2; ++n) touch(card, n % 2 == 0, 2000);
  memset(&queue, 0xFF, sizeof queue);
  DONE(trammel_read_capture_queue(card, &queue));
  CHECK(queue.captures == TRAMMEL_CAPTURE_QUEUE && queue.lost == 2);
  CHECK(unit_of(card, 3).overrun);
  DONE(trammel_clear_captures(card, 1U << 3));
  CHECK(!unit_of(card, 3).overrun);
  DONE(trammel_take_queued_captures(card, captures, &count));
  CHECK(count == TRAMMEL_CAPTURE_QUEUE);
  for (n = 0; n < count; ++n) {
    CHECK(captures[n].unit == 3 && captures[n].active == (n % 2 == 0));
    CHECK(n == 0 || captures[n].at.time > captures[n - 1].at.time + 1900);
  }
  DONE(trammel_take_queued_captures(card, captures, &count));
  CHECK(count == 0);
  FAILS(trammel_read_capture_queue(card, NULL), TRAMMEL_ARGUMENT, "queue is null");
  FAILS(trammel_take_queued_captures(card, NULL, &count), TRAMMEL_ARGUMENT, "captures is null");
  FAILS(trammel_take_queued_captures(card, captures, NULL), TRAMMEL_ARGUMENT, "count is null");
  FAILS(trammel_has_capture_queue(card, NULL), TRAMMEL_ARGUMENT, "has is null");
  trammel_close(card);
}

static void bad_captures(void) {
  trammel_card* card = simulated_card();
  trammel_capture_select select = {16, true, false, false, false};
  trammel_capture capture;
  bool taken;
  FAILS(trammel_select_capture(card, 0, &select), TRAMMEL_ARGUMENT, "the card has 16 inputs");
  select.input = 0;
  FAILS(trammel_select_capture(card, 4, &select), TRAMMEL_ARGUMENT, "capture unit 4: the card has 4");
  FAILS(trammel_stop_capture(card, 4), TRAMMEL_ARGUMENT, "capture unit 4");
  FAILS(trammel_take_capture(card, 4, &capture, &taken), TRAMMEL_ARGUMENT, "capture unit 4");
  FAILS(trammel_wait_for_capture(card, 0, -1, &capture), TRAMMEL_ARGUMENT, "timeout");
  FAILS(trammel_select_capture(card, 0, NULL), TRAMMEL_ARGUMENT, "select is null");
  FAILS(trammel_read_captures(card, NULL), TRAMMEL_ARGUMENT, "states is null");
  FAILS(trammel_take_capture(card, 0, NULL, &taken), TRAMMEL_ARGUMENT, "capture is null");
  FAILS(trammel_take_capture(card, 0, &capture, NULL), TRAMMEL_ARGUMENT, "taken is null");
  FAILS(trammel_wait_for_capture(card, 0, 1, NULL), TRAMMEL_ARGUMENT, "capture is null");
  FAILS(trammel_count_captures(card, NULL), TRAMMEL_ARGUMENT, "units is null");
  trammel_close(card);
}

static void soft_limits(void) {
  trammel_card* card = simulated_card();
  trammel_soft_range ranges[TRAMMEL_MAX_AXES] = {{true, -50, 500}, {false, 7, 3}, {true, INT32_MAX, INT32_MIN}};
  trammel_limit_state state;
  bool has = false;
  DONE(trammel_has_soft_limits(card, &has));
  CHECK(has);
  DONE(trammel_set_slew_time(card, 10000000));
  DONE(trammel_set_soft_limits(card, ranges, 3));
  memset(ranges, 0xFF, sizeof ranges);
  DONE(trammel_read_soft_limits(card, ranges));
  CHECK(ranges[0].limited && ranges[0].minus == -50 && ranges[0].plus == 500);
  CHECK(!ranges[1].limited && ranges[2].limited && ranges[2].minus == INT32_MAX && ranges[2].plus == INT32_MIN);
  CHECK(!ranges[3].limited && !ranges[7].limited && ranges[7].plus == 0);
  go(card, 600);
  FAILS(trammel_wait_until_idle(card, SECOND), TRAMMEL_FAULT, "SOFT_LIMIT (axis 0 plus)");
  CHECK(trammel_last_error()->faults == TRAMMEL_FAULT_SOFT_LIMIT);
  DONE(trammel_read_limit_state(card, &state));
  CHECK(state.soft_axis == 0 && state.soft_plus);
  DONE(trammel_clear_faults(card));
  go(card, -600);  // motion back is allowed, up to the other limit
  FAILS(trammel_wait_until_idle(card, SECOND), TRAMMEL_FAULT, "SOFT_LIMIT (axis 0 minus)");
  DONE(trammel_clear_faults(card));
  DONE(trammel_set_soft_limits(card, NULL, 0));
  DONE(trammel_read_soft_limits(card, ranges));
  CHECK(!ranges[0].limited && !ranges[2].limited);
  go(card, -100);
  DONE(trammel_wait_until_idle(card, SECOND));
  trammel_close(card);
}

// Pulses beyond its soft limit of 100 at which an axis comes to rest, with a ramp of 0.1 s or without.
static int32_t beyond(bool ramp) {
  trammel_card* card = simulated_card();
  const trammel_soft_range range = {true, 0, 100};
  trammel_rest rest;
  memset(&rest, 0xFF, sizeof rest);
  DONE(trammel_set_slew_time(card, 100000000));
  DONE(trammel_set_soft_limits(card, &range, 1));
  DONE(trammel_set_soft_limit_ramps(card, ramp));
  go(card, 600);
  FAILS(trammel_wait_until_idle(card, SECOND), TRAMMEL_FAULT, "SOFT_LIMIT");
  DONE(trammel_wait_until_stopped(card, SECOND));
  DONE(trammel_read_rest(card, &rest));
  trammel_close(card);
  return rest.position[0] - 100;
}

static void bad_soft_limits(void) {
  trammel_card* card = simulated_card();
  const trammel_soft_range ranges[9] = {{false, 0, 0}, {true, 3, 2}};
  FAILS(trammel_set_soft_limits(card, ranges, 2), TRAMMEL_ARGUMENT, "axis 1: 3 to 2 is no range");
  FAILS(trammel_set_soft_limits(card, ranges, 5), TRAMMEL_ARGUMENT, "soft limits of 5 axes: the card has 4");
  FAILS(trammel_set_soft_limits(card, ranges, SIZE_MAX), TRAMMEL_ARGUMENT, "8 axes at most");
  FAILS(trammel_set_soft_limits(card, NULL, 1), TRAMMEL_ARGUMENT, "ranges is null");
  FAILS(trammel_read_soft_limits(card, NULL), TRAMMEL_ARGUMENT, "ranges is null");
  FAILS(trammel_has_soft_limits(card, NULL), TRAMMEL_ARGUMENT, "has is null");
  trammel_close(card);
}

// The card rounds the times up: idle_ns to multiples of 2^20 clocks, the others to multiples of 4,096 clocks, of 1 us
// each.
static trammel_enable_sequence some_sequence(void) {
  trammel_enable_sequence sequence;
  memset(&sequence, 0, sizeof sequence);
  sequence.axes = 0xF;
  sequence.brake_release_ns = 4096000;
  sequence.before_first_step_ns = 8192000;
  sequence.after_last_step_ns = 12288000;
  sequence.brake_set_ns = 16384000;
  sequence.idle_ns = 1;
  sequence.disable_causes = TRAMMEL_FAULT_LIMIT | TRAMMEL_FAULT_WATCHDOG;
  return sequence;
}

// Motion waits until drive and brake are ready.
static void a_sequence(void) {
  trammel_card* card = simulated_card();
  const trammel_output_roles roles = {1, 2, 0, 0};
  const trammel_enable_sequence sequence = some_sequence();
  DONE(trammel_set_output_roles(card, &roles));
  DONE(trammel_set_enable_sequence(card, &sequence));
  CHECK(!state_now(card).enabled && !state_now(card).enable_waits && outputs_of(card) == 0);
  go(card, 20);
  pass(card, 2000);
  CHECK(state_now(card).enable_waits && state_now(card).enabled && outputs_of(card) == 1);
  pass(card, 4096);
  CHECK(state_now(card).enable_waits && outputs_of(card) == 3);
  pass(card, 4096);
  CHECK(state_now(card).enable_waits);
  pass(card, 4096);
  CHECK(!state_now(card).enable_waits && state_now(card).enabled);
  DONE(trammel_wait_until_idle(card, SECOND));
  pass(card, 1 << 20);  // the brake is set 2^20 + 12,288 clocks after the last step; these have not passed yet
  CHECK(state_now(card).enabled && outputs_of(card) == 3);
  pass(card, 12288);
  CHECK(outputs_of(card) == 1);
  pass(card, 16384);
  CHECK(!state_now(card).enabled && outputs_of(card) == 0);
  trammel_close(card);
}

static void by_hand(void) {
  trammel_card* card = simulated_card();
  trammel_enable_sequence sequence = some_sequence();
  sequence.manual = true;
  DONE(trammel_set_enable_sequence(card, &sequence));
  go(card, 20);
  pass(card, 100000);
  CHECK(state_now(card).enable_waits && !state_now(card).enabled);
  DONE(trammel_enable(card, true));
  DONE(trammel_wait_until_idle(card, SECOND));
  CHECK(state_now(card).enabled && !state_now(card).enable_waits);
  DONE(trammel_enable(card, false));
  pass(card, 40000);
  CHECK(!state_now(card).enabled);
  trammel_close(card);
}

static void health_and_safe_levels(void) {
  trammel_card* card = simulated_card();
  const trammel_output_roles roles = {0, 0, 4, 8};
  const trammel_health health = {TRAMMEL_FAULT_EMERGENCY_STOP, false, 500000};
  uint16_t before;
  DONE(trammel_set_output_roles(card, &roles));
  DONE(trammel_set_health(card, &health));
  DONE(trammel_set_output_safe_cause(card, 1, 3));
  pass(card, 1000);
  CHECK((outputs_of(card) & 8) != 0);
  before = outputs_of(card) & 4;
  pass(card, 500);
  CHECK((outputs_of(card) & 4) != before);
  DONE(trammel_simulated_set_emergency_stop(card, true));
  pass(card, 1000);
  CHECK(outputs_of(card) == 1);  // the health outputs (masks 4 and 8) are low; output 0 has its safe level
  trammel_close(card);
}

static void bad_drives(void) {
  trammel_card* card = simulated_card();
  trammel_output_roles roles = {16, 0, 0, 0};
  trammel_enable_sequence sequence = some_sequence();
  const trammel_health health = {0, false, 65536000};
  FAILS(trammel_set_output_roles(card, &roles), TRAMMEL_ARGUMENT, "the card has 4 outputs");
  roles.enable = roles.brake = 1;
  FAILS(trammel_set_output_roles(card, &roles), TRAMMEL_ARGUMENT, "more than one");
  sequence.axes = 0x10;
  FAILS(trammel_set_enable_sequence(card, &sequence), TRAMMEL_ARGUMENT, "the card has 4 axes");
  sequence.axes = 1;
  sequence.idle_ns = INT64_C(1000000) * SECOND;
  FAILS(trammel_set_enable_sequence(card, &sequence), TRAMMEL_ARGUMENT, "idle time of the drives");
  sequence.idle_ns = 0;
  sequence.brake_set_ns = -1;
  FAILS(trammel_set_enable_sequence(card, &sequence), TRAMMEL_ARGUMENT, "brake's setting");
  FAILS(trammel_set_health(card, &health), TRAMMEL_ARGUMENT, "65535 clocks");
  FAILS(trammel_set_output_roles(card, NULL), TRAMMEL_ARGUMENT, "roles is null");
  FAILS(trammel_set_enable_sequence(card, NULL), TRAMMEL_ARGUMENT, "sequence is null");
  FAILS(trammel_set_health(card, NULL), TRAMMEL_ARGUMENT, "health is null");
  trammel_close(card);
}

static bool is_stopped(trammel_card* card) {
  bool stopped = false;
  DONE(trammel_read_emergency_stop(card, &stopped));
  return stopped;
}

// Position at which a line of 600 pulses comes to rest if the emergency stop is pressed at pulse 100.
static int32_t pressed_at_100(bool ramp) {
  trammel_card* card = simulated_card();
  trammel_rest rest;
  bool has = false;
  memset(&rest, 0xFF, sizeof rest);
  DONE(trammel_has_emergency_stop(card, &has));
  CHECK(has && !is_stopped(card));
  DONE(trammel_set_slew_time(card, 100000000));
  DONE(trammel_set_emergency_stop_ramps(card, ramp));
  go(card, 600);
  pass(card, 100000);
  DONE(trammel_simulated_set_emergency_stop(card, true));
  FAILS(trammel_wait_until_idle(card, SECOND), TRAMMEL_FAULT, "EMERGENCY_STOP");
  DONE(trammel_wait_until_stopped(card, SECOND));
  DONE(trammel_read_rest(card, &rest));
  DONE(trammel_clear_faults(card));
  CHECK(is_stopped(card));  // clearing has no effect while the button is pressed
  DONE(trammel_simulated_set_emergency_stop(card, false));
  pass(card, 100);
  CHECK(is_stopped(card));
  DONE(trammel_clear_faults(card));
  CHECK(!is_stopped(card));
  go(card, 10);
  DONE(trammel_wait_until_idle(card, SECOND));
  FAILS(trammel_read_emergency_stop(card, NULL), TRAMMEL_ARGUMENT, "stopped is null");
  FAILS(trammel_has_emergency_stop(card, NULL), TRAMMEL_ARGUMENT, "has is null");
  trammel_close(card);
  return rest.position[0];
}

void test_guards(void) {
  an_edge_in_motion();
  waiting_for_edges();
  a_queue_of_edges();
  bad_captures();
  soft_limits();
  CHECK(beyond(false) <= 2);
  CHECK(beyond(true) > 40);
  bad_soft_limits();
  a_sequence();
  by_hand();
  health_and_safe_levels();
  bad_drives();
  CHECK(pressed_at_100(false) < 103);
  CHECK(pressed_at_100(true) > 140);
}
