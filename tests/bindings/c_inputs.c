// Machine inputs through trammel.h: filters, roles, the stops that they cause, and the position after a stop (REST).
#include "check.h"

#define X_PLUS 3  // inputs of the switch and the buttons of these tests
#define HOLD 5
#define START 6

static trammel_status status_of(trammel_card* card) {
  trammel_status status;
  memset(&status, 0xFF, sizeof status);
  DONE(trammel_read_status(card, &status));
  return status;
}

static trammel_active_roles roles_of(trammel_card* card) {
  trammel_active_roles roles;
  memset(&roles, 0xFF, sizeof roles);
  DONE(trammel_read_roles(card, &roles));
  return roles;
}

static trammel_rest rest_of(trammel_card* card) {
  trammel_rest rest;
  memset(&rest, 0xFF, sizeof rest);
  DONE(trammel_read_rest(card, &rest));
  return rest;
}

// Sets a level and waits until roles without a filter have seen it.
static void set(trammel_card* card, unsigned input, bool level) {
  DONE(trammel_simulated_set_input(card, input, level));
  DONE(trammel_simulated_wait(card, 200));
}

// Starts a line along axis 0 at 1000 pulses/s.
static void start_line(trammel_card* card, int64_t pulses) {
  trammel_one_shot line;
  memset(&line, 0, sizeof line);
  line.pulses[0] = pulses;
  line.duration_ns = (pulses < 0 ? -pulses : pulses) * 1000000;
  DONE(trammel_start_line(card, &line, NULL));
}

static void levels_and_filters(void) {
  trammel_card* card = simulated_card();
  unsigned inputs = 0;
  unsigned outputs = 0;
  uint32_t raw = 0;
  uint32_t levels = 0;
  int64_t time_ns = 0;
  DONE(trammel_count_ports(card, &inputs, &outputs));
  CHECK(inputs == 16 && outputs == 4);
  DONE(trammel_count_ports(card, NULL, NULL));
  DONE(trammel_set_input_filter(card, 15, 100000));
  DONE(trammel_read_input_filter(card, 15, &time_ns));
  CHECK(time_ns == 128000);
  DONE(trammel_simulated_set_inputs(card, 0x8001));
  DONE(trammel_simulated_wait(card, 100));
  DONE(trammel_read_raw_inputs(card, &raw));
  DONE(trammel_read_inputs(card, &levels));
  CHECK(raw == 0x8001 && levels == 1);
  DONE(trammel_simulated_wait(card, 200));
  DONE(trammel_read_inputs(card, &levels));
  CHECK(levels == 0x8001);
  trammel_close(card);
}

static void roles_and_buttons(void) {
  trammel_card* card = simulated_card();
  uint32_t inputs = 0;
  char text[32];
  DONE(trammel_set_role(card, TRAMMEL_ROLE_LIMIT_MINUS, 1, 0x14));
  DONE(trammel_set_role(card, TRAMMEL_ROLE_FEED_HOLD, 0, 1u << HOLD));
  DONE(trammel_set_role(card, TRAMMEL_ROLE_CYCLE_START, 0, 1u << START));
  DONE(trammel_read_role(card, TRAMMEL_ROLE_LIMIT_MINUS, 1, &inputs));
  CHECK(inputs == 0x14);
  DONE(trammel_read_role(card, TRAMMEL_ROLE_LIMIT_MINUS, 0, &inputs));
  CHECK(inputs == 0);
  set(card, 4, true);
  CHECK(roles_of(card).limit_minus == 2 && roles_of(card).limit_plus == 0 && !roles_of(card).feed_hold);
  CHECK(!status_of(card).button_hold && !status_of(card).settled);
  set(card, HOLD, true);
  CHECK(roles_of(card).feed_hold && status_of(card).button_hold && status_of(card).settled);
  set(card, HOLD, false);
  CHECK(!roles_of(card).feed_hold && status_of(card).button_hold);
  set(card, START, true);
  CHECK(roles_of(card).cycle_start && !status_of(card).button_hold);
  DONE(trammel_role_name(TRAMMEL_ROLE_LIMIT_MINUS, 1, text, sizeof text));
  CHECK(strcmp(text, "limit minus of axis 1") == 0);
  DONE(trammel_role_name(TRAMMEL_ROLE_SPINDLE_AT_SPEED, 0, text, 8));
  CHECK(strcmp(text, "spindle") == 0);
  trammel_close(card);
}

// Axis 0 runs into its limit switch and stops on a ramp of 0.1 s, which takes 50 pulses.
static trammel_card* card_on_a_limits_ramp(uint32_t overtravel) {
  trammel_card* card = simulated_card();
  trammel_input_stops stops;
  memset(&stops, 0, sizeof stops);
  stops.limit_ramps = true;
  DONE(trammel_set_slew_time(card, 100000000));
  DONE(trammel_set_role(card, TRAMMEL_ROLE_LIMIT_PLUS, 0, 1u << X_PLUS));
  DONE(trammel_set_input_stops(card, &stops));
  DONE(trammel_set_overtravel(card, 0, overtravel));
  CHECK(rest_of(card).time == 0);
  start_line(card, 500);
  DONE(trammel_simulated_wait(card, 200000));
  set(card, X_PLUS, true);
  DONE(trammel_simulated_wait(card, 20000));
  return card;
}

static void a_limit(void) {
  trammel_card* card = card_on_a_limits_ramp(60);
  trammel_rest rest;
  trammel_snapshot now;
  trammel_limit_state state;
  char text[64];
  CHECK(status_of(card).stopping && status_of(card).faulted);
  FAILS(trammel_read_rest(card, &rest), TRAMMEL_STATE, "on its way to a stop");
  DONE(trammel_wait_until_stopped(card, 1000000000));
  rest = rest_of(card);
  DONE(trammel_read_snapshot(card, &now));
  CHECK(rest.time != 0 && rest.exact && rest.status.direct && rest.position[0] == now.position[0]);
  CHECK(rest.position[0] > 230 && rest.position[0] < 260);
  // The ticks of a direct line are clocks: 1000 for each remaining pulse.
  CHECK(rest.ticks_left / 1000 == (uint64_t)(500 - rest.position[0]));
  DONE(trammel_read_limit_state(card, &state));
  CHECK(state.plus == 1 && state.minus == 0 && state.drive_fault == 0);
  DONE(trammel_read_fault_text(card, text, sizeof text));
  CHECK(strcmp(text, "LIMIT (axis 0 plus)") == 0 && rest.faults == now.faults && rest.faults != 0);
  DONE(trammel_clear_faults(card));
  DONE(trammel_read_fault_text(card, text, sizeof text));
  CHECK(strcmp(text, "none") == 0);
  // Motion away from the switch is allowed. Motion further into it needs an override.
  start_line(card, -20);
  DONE(trammel_wait_until_idle(card, 1000000000));
  start_line(card, 10);
  FAILS(trammel_wait_until_idle(card, 1000000000), TRAMMEL_FAULT, "LIMIT (axis 0 plus)");
  DONE(trammel_clear_faults(card));
  DONE(trammel_override_limits(card, 0, 1));
  start_line(card, 10);
  DONE(trammel_wait_until_idle(card, 1000000000));
  trammel_close(card);
}

static void overtravel_ends_at_once(void) {
  trammel_card* card = card_on_a_limits_ramp(5);
  trammel_rest rest;
  DONE(trammel_wait_until_stopped(card, 0));
  rest = rest_of(card);
  CHECK(rest.exact && rest.position[0] > 200 && rest.position[0] < 210);
  trammel_close(card);
}

// A program that clears the fault on the ramp and continues finds a card that accepts its commands.
static void clearing_on_the_ramp(void) {
  trammel_card* card = card_on_a_limits_ramp(60);
  CHECK(status_of(card).stopping);
  DONE(trammel_clear_faults(card));
  CHECK(!status_of(card).stopping && !status_of(card).faulted && rest_of(card).exact);
  start_line(card, -20);
  DONE(trammel_wait_until_idle(card, 1000000000));
  trammel_close(card);
}

static void an_abort_in_motion(void) {
  trammel_card* card = simulated_card();
  trammel_rest rest;
  start_line(card, 500);
  DONE(trammel_simulated_wait(card, 100000));
  DONE(trammel_abort(card));
  rest = rest_of(card);
  CHECK(rest.time != 0 && !rest.exact && rest.ticks_left == 0 && rest.faults == 0);
  trammel_close(card);
}

static void under_run(void) {
  trammel_card* card = simulated_card();
  trammel_command feed = feed_of(1000);
  trammel_command line = line_of(1000, 10, 0);
  feed.as.feed.stop_distance = 500;  // not 0: the card expects more commands, which never come
  DONE(trammel_open_stream(card, NULL));
  DONE(trammel_put(card, &feed));
  DONE(trammel_put(card, &line));
  DONE(trammel_flush(card));
  DONE(trammel_simulated_wait(card, 100000));
  CHECK(status_of(card).underrun && !status_of(card).stale);
  trammel_close(card);
}

static void bad_input_arguments(void) {
  trammel_card* card = simulated_card();
  trammel_input_stops stops;
  uint32_t inputs = 0;
  int64_t time_ns = 0;
  char text[8];
  memset(&stops, 0, sizeof stops);
  FAILS(trammel_set_role(card, 6, 0, 1), TRAMMEL_ARGUMENT, "none of trammel_role");
  FAILS(trammel_set_role(card, -1, 0, 1), TRAMMEL_ARGUMENT, "none of trammel_role");
  FAILS(trammel_read_role(card, 53, 0, &inputs), TRAMMEL_ARGUMENT, "none of trammel_role");
  FAILS(trammel_set_role(card, TRAMMEL_ROLE_HOME, 4, 1), TRAMMEL_ARGUMENT, "home of axis 4: the card has 4 axes");
  FAILS(trammel_set_role(card, TRAMMEL_ROLE_LIMIT_MINUS, 8, 1), TRAMMEL_ARGUMENT, "axis 8");
  FAILS(trammel_set_role(card, TRAMMEL_ROLE_PROBE, 1, 1), TRAMMEL_ARGUMENT, "is the card's");
  FAILS(trammel_set_role(card, TRAMMEL_ROLE_PROBE, 0, 0x10000), TRAMMEL_ARGUMENT, "the card has 16 inputs");
  FAILS(trammel_role_name(7, 0, text, sizeof text), TRAMMEL_ARGUMENT, "none of trammel_role");
  FAILS(trammel_role_name(0, 0, NULL, 1), TRAMMEL_ARGUMENT, "text is null");
  FAILS(trammel_set_input_filter(card, 16, 0), TRAMMEL_ARGUMENT, "the card has 16 inputs");
  FAILS(trammel_set_input_filter(card, 0, -1), TRAMMEL_ARGUMENT, "input filter");
  FAILS(trammel_read_input_filter(card, 16, &time_ns), TRAMMEL_ARGUMENT, "the card has 16 inputs");
  FAILS(trammel_set_overtravel(card, 4, 1), TRAMMEL_ARGUMENT, "the card has 4 axes");
  FAILS(trammel_set_overtravel(card, 0, 65536), TRAMMEL_ARGUMENT, "0 .. 65535");
  FAILS(trammel_override_limits(card, 0x10, 0), TRAMMEL_ARGUMENT, "the card has 4 axes");
  stops.shared = 0x80;
  FAILS(trammel_set_input_stops(card, &stops), TRAMMEL_ARGUMENT, "the card has 4 axes");
  FAILS(trammel_simulated_set_input(card, 16, true), TRAMMEL_ARGUMENT, "the card has 16 inputs");
  FAILS(trammel_read_rest(card, NULL), TRAMMEL_ARGUMENT, "rest is null");
  FAILS(trammel_read_roles(card, NULL), TRAMMEL_ARGUMENT, "roles is null");
  FAILS(trammel_read_limit_state(card, NULL), TRAMMEL_ARGUMENT, "state is null");
  FAILS(trammel_set_input_stops(card, NULL), TRAMMEL_ARGUMENT, "stops is null");
  FAILS(trammel_read_raw_inputs(card, NULL), TRAMMEL_ARGUMENT, "levels is null");
  FAILS(trammel_read_input_filter(card, 0, NULL), TRAMMEL_ARGUMENT, "time_ns is null");
  FAILS(trammel_read_role(card, 0, 0, NULL), TRAMMEL_ARGUMENT, "inputs is null");
  FAILS(trammel_read_fault_text(card, NULL, 1), TRAMMEL_ARGUMENT, "text is null");
  FAILS(trammel_read_fault_text(card, text, 0), TRAMMEL_ARGUMENT, "0 bytes");
  trammel_close(card);
}

void test_inputs(void) {
  levels_and_filters();
  roles_and_buttons();
  a_limit();
  overtravel_ends_at_once();
  clearing_on_the_ramp();
  an_abort_in_motion();
  under_run();
  bad_input_arguments();
}
