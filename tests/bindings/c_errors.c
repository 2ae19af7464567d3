// Failures of trammel.h calls that do not occur with a working card.
#include <pthread.h>

#include "check.h"

// A bus in front of a simulated card. It can fail, report wrong data or hide refusals.
typedef struct bad_bus {
  trammel_card* behind;
  size_t transfers;
  size_t fail_at;     // number of the transfer that fails, from 1; 0: none
  size_t too_many;    // reports this many accesses more than it made
  uint32_t magic;     // if not 0: value that MAGIC reads as
  bool posted;        // refusals are not reported
  const char* why;    // text of the failure
  uint64_t slept_ns;  // sum of all sleeps
} bad_bus;

static size_t transfer(void* context, trammel_access* accesses, size_t count) {
  bad_bus* bus = (bad_bus*)context;
  size_t all = 0;
  size_t i;
  if (++bus->transfers == bus->fail_at) return TRAMMEL_BUS_FAILED;
  while (all < count) {
    size_t made = 0;
    DONE(trammel_transfer(bus->behind, accesses + all, count - all, &made));
    all += made;
    if (all == count || !bus->posted) break;
    ++all;
  }
  for (i = 0; i < all; ++i) {
    if (bus->magic != 0 && accesses[i].address == 0) accesses[i].data = bus->magic;
  }
  return all + bus->too_many;
}

static void let_pass(void* context, int64_t time_ns) {
  bad_bus* bus = (bad_bus*)context;
  bus->slept_ns += (uint64_t)time_ns;
  DONE(trammel_simulated_wait(bus->behind, (uint64_t)time_ns / 1000 + 1));
}

static const char* why(void* context) { return ((bad_bus*)context)->why; }

static trammel_bus bus_of(bad_bus* is) {
  trammel_bus bus;
  memset(is, 0, sizeof *is);
  is->behind = simulated_card();
  memset(&bus, 0, sizeof bus);
  bus.context = is;
  bus.transfer = transfer;
  bus.sleep = let_pass;
  bus.failure = why;
  bus.reports_refusals = true;
  return bus;
}

static void opening(void) {
  trammel_card* card = (trammel_card*)&card;
  trammel_simulation none = {0, 1000000};
  trammel_simulation nine = {9, 1000000};
  trammel_simulation stopped = {4, 0};
  FAILS(trammel_open("carrier pigeon:", &card), TRAMMEL_ARGUMENT, "carrier pigeon:");
  CHECK(card == NULL);
  FAILS(trammel_open("sim:?axes=9", &card), TRAMMEL_ARGUMENT, "axes");
  FAILS(trammel_open("serial:/dev/trammel-is-not-there", &card), TRAMMEL_LINK, "/dev/trammel-is-not-there");
  FAILS(trammel_open("tcp://127.0.0.1:1", &card), TRAMMEL_LINK, "127.0.0.1");
  CHECK(card == NULL);
  FAILS(trammel_open(NULL, &card), TRAMMEL_ARGUMENT, "url is null");
  FAILS(trammel_open("sim:", NULL), TRAMMEL_ARGUMENT, "card is null");
  FAILS(trammel_open_simulated(&none, &card), TRAMMEL_ARGUMENT, "axes");
  FAILS(trammel_open_simulated(&nine, &card), TRAMMEL_ARGUMENT, "axes");
  FAILS(trammel_open_simulated(&stopped, &card), TRAMMEL_IDENTIFICATION, "0 Hz");
  FAILS(trammel_open_simulated(NULL, &card), TRAMMEL_ARGUMENT, "simulation is null");
  FAILS(trammel_open_bus(NULL, &card), TRAMMEL_ARGUMENT, "bus is null");
  trammel_close(NULL);
}

static void own_bus(void) {
  bad_bus is;
  trammel_bus bus = bus_of(&is);
  trammel_card* card = NULL;
  trammel_one_shot line;
  trammel_snapshot snapshot;
  memset(&line, 0, sizeof line);
  line.pulses[1] = 9;
  line.duration_ns = 1000000;
  DONE(trammel_open_bus(&bus, &card));
  DONE(trammel_run_line(card, &line, 1000000000, NULL));
  DONE(trammel_read_snapshot(is.behind, &snapshot));
  CHECK(snapshot.position[1] == 9 && is.slept_ns >= 1000000);
  FAILS(trammel_simulated_wait(card, 1), TRAMMEL_STATE, "simulated");
  is.fail_at = is.transfers + 1;
  is.why = "the cable is out";
  FAILS(trammel_read_snapshot(card, &snapshot), TRAMMEL_LINK, "the cable is out");
  is.fail_at = is.transfers + 1;
  is.why = NULL;
  FAILS(trammel_read_snapshot(card, &snapshot), TRAMMEL_LINK, "the bus failed");
  is.too_many = 1;
  FAILS(trammel_read_snapshot(card, &snapshot), TRAMMEL_LINK, "more accesses");
  is.too_many = 0;
  DONE(trammel_read_snapshot(card, &snapshot));
  trammel_close(card);
  is.magic = 0x12345678;
  FAILS(trammel_open_bus(&bus, &card), TRAMMEL_IDENTIFICATION, "12345678");
  CHECK(card == NULL);
  is.magic = 0;
  is.posted = true;
  bus.reports_refusals = false;
  bus.sleep = NULL;  // the default sleep of the thread does not advance the simulated card behind the bus
  DONE(trammel_open_bus(&bus, &card));
  DONE(trammel_start_line(card, &line, NULL));
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_REFUSED, "BUSY");
  bus.transfer = NULL;
  trammel_close(card);
  FAILS(trammel_open_bus(&bus, &card), TRAMMEL_ARGUMENT, "bus->transfer is null");
  trammel_close(is.behind);
}

static void states(void) {
  trammel_card* card = simulated_card();
  trammel_command command = feed_of(1000);
  trammel_one_shot line;
  memset(&line, 0, sizeof line);
  FAILS(trammel_put(card, &command), TRAMMEL_STATE, "trammel_open_stream()");
  FAILS(trammel_finish(card, NULL), TRAMMEL_STATE, "trammel_open_stream()");
  line.pulses[0] = 10;
  line.duration_ns = 100000000;
  DONE(trammel_start_line(card, &line, NULL));
  FAILS(trammel_open_stream(card, NULL), TRAMMEL_STATE, "");
  FAILS(trammel_wait_until_idle(card, 1000), TRAMMEL_TIMEOUT, "clocks");
  CHECK(trammel_last_error()->waited > 0);
  DONE(trammel_simulated_reset(card));
  FAILS(trammel_wait_until_idle(card, -1), TRAMMEL_ARGUMENT, "");
  trammel_close(card);
}

static void one_shot_arguments(void) {
  trammel_card* card = simulated_card();
  trammel_one_shot line;
  memset(&line, 0, sizeof line);
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_ARGUMENT, "");
  line.pulses[0] = 10;
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_ARGUMENT, "duration");
  line.duration_ns = 1000000;
  line.speed_pulses = 1;
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_ARGUMENT, "not both");
  line.duration_ns = 0;
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_ARGUMENT, "");  // duration 0
  line.speed_seconds = 1;
  line.pulses[0] = INT64_C(1) << 41;
  line.speed_pulses = 100000;
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_ARGUMENT, "parts");
  line.pulses[0] = 0;
  line.pulses[5] = 1;
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_ARGUMENT, "axis 5");
  trammel_close(card);
}

static void command_arguments(void) {
  trammel_card* card = simulated_card();
  trammel_stream_options options;
  trammel_command command = line_of(0, 1, 0);
  memset(&options, 0, sizeof options);
  options.margin_ns = -1;
  FAILS(trammel_open_stream(card, &options), TRAMMEL_ARGUMENT, "margin");
  DONE(trammel_open_stream(card, NULL));
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "ticks");
  command = line_of(UINT64_C(1) << 40, 1, 0);
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "ticks");
  command = line_of(10, 0, -11);
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "axis 1 has more pulses");
  command = feed_of(10);
  command.as.feed.floor = 0;
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "floor");
  command = feed_of(10);
  command.as.feed.slew_shift = 4;
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "slew shift");
  command = feed_of(10);
  command.as.feed.piece_class = -1;
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "class");
  command = command_of(TRAMMEL_ARC);  // no radius
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "");
  command.as.arc.further[2] = 1;
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "TRAMMEL_ARC_CHORD");
  command.kind = TRAMMEL_ARC_CHORD;
  command.as.arc.eight_directions = true;
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "eight_directions");
  command = command_of(TRAMMEL_ELLIPSE);
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "");
  command = command_of(TRAMMEL_WAIT_INPUT);
  command.as.wait_input.input = 19;
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "input");
  command = command_of(11);
  FAILS(trammel_put(card, &command), TRAMMEL_ARGUMENT, "kind 11");
  command = command_of(TRAMMEL_END);
  DONE(trammel_put(card, &command));  // the refused commands did not change the stream
  DONE(trammel_finish(card, NULL));
  trammel_close(card);
}

static void raw_accesses(void) {
  trammel_card* card = simulated_card();
  trammel_access accesses[3] = {{0x40, 0, false}, {0, 1, true}, {0x40, 7, false}};
  size_t made = 9;
  DONE(trammel_transfer(card, accesses, 3, &made));
  CHECK(made == 1 && accesses[0].data == 0 && accesses[2].data == 7);  // MAGIC is read-only
  DONE(trammel_transfer(card, NULL, 0, &made));
  CHECK(made == 0);
  accesses[0].address = 0x1000;
  FAILS(trammel_transfer(card, accesses, 1, &made), TRAMMEL_ARGUMENT, "4096");
  accesses[0].address = 2;
  FAILS(trammel_transfer(card, accesses, 1, &made), TRAMMEL_ARGUMENT, "2");
  trammel_close(card);
}

// A null card for every function that takes a card. Over a screen: a line for each function.
static void null_cards(void) {
  trammel_access access = {0, 0, false};
  trammel_command command = command_of(TRAMMEL_END);
  trammel_input_condition condition = {0, true, 0};
  trammel_one_shot line;
  trammel_axis_settings axis;
  trammel_snapshot snapshot;
  trammel_probe_result probe;
  trammel_identification is;
  trammel_unit unit;
  trammel_status status;
  trammel_position_stop stop;
  trammel_place place;
  trammel_rest rest;
  trammel_active_roles roles;
  trammel_limit_state limits;
  trammel_input_stops stops;
  trammel_capture_select select;
  trammel_capture_states captures;
  trammel_capture capture;
  trammel_capture_queue capture_queue;
  trammel_queued_capture queued[TRAMMEL_CAPTURE_QUEUE];
  trammel_soft_range range[TRAMMEL_MAX_AXES];
  trammel_output_roles outputs;
  trammel_enable_sequence sequence;
  trammel_health health;
  bool flag;
  unsigned number;
  char text[8];
  int64_t positions[TRAMMEL_MAX_AXES] = {0};
  uint32_t word;
  uint16_t half;
  size_t made;
  memset(&line, 0, sizeof line);
  memset(&axis, 0, sizeof axis);
  memset(&stops, 0, sizeof stops);
  memset(&select, 0, sizeof select);
  memset(range, 0, sizeof range);
  memset(&outputs, 0, sizeof outputs);
  memset(&sequence, 0, sizeof sequence);
  memset(&health, 0, sizeof health);
#define NO_CARD(call) FAILS(call, TRAMMEL_ARGUMENT, "card is null")
  NO_CARD(trammel_transfer(NULL, &access, 1, &made));
  NO_CARD(trammel_identify(NULL, &is));
  NO_CARD(trammel_identify_units(NULL, &unit, 1, &made));
  NO_CARD(trammel_configure_axis(NULL, 0, &axis));
  NO_CARD(trammel_read_status(NULL, &status));
  NO_CARD(trammel_read_snapshot(NULL, &snapshot));
  NO_CARD(trammel_read_stop_snapshot(NULL, &snapshot));
  NO_CARD(trammel_wait_until_idle(NULL, 1));
  NO_CARD(trammel_read_faults(NULL, &word));
  NO_CARD(trammel_clear_faults(NULL));
  NO_CARD(trammel_set_watchdog(NULL, 0));
  NO_CARD(trammel_read_inputs(NULL, &word));
  NO_CARD(trammel_read_outputs(NULL, &half));
  NO_CARD(trammel_set_input_polarity(NULL, 0));
  NO_CARD(trammel_set_output_safe(NULL, 0, 0));
  NO_CARD(trammel_read_marks(NULL, &word, NULL));
  NO_CARD(trammel_read_rest(NULL, &rest));
  NO_CARD(trammel_wait_until_stopped(NULL, 1));
  NO_CARD(trammel_read_fault_text(NULL, text, sizeof text));
  NO_CARD(trammel_count_ports(NULL, NULL, NULL));
  NO_CARD(trammel_read_raw_inputs(NULL, &word));
  NO_CARD(trammel_set_input_filter(NULL, 0, 0));
  NO_CARD(trammel_read_input_filter(NULL, 0, positions));
  NO_CARD(trammel_set_role(NULL, 0, 0, 0));
  NO_CARD(trammel_read_role(NULL, 0, 0, &word));
  NO_CARD(trammel_read_roles(NULL, &roles));
  NO_CARD(trammel_read_limit_state(NULL, &limits));
  NO_CARD(trammel_set_input_stops(NULL, &stops));
  NO_CARD(trammel_set_overtravel(NULL, 0, 0));
  NO_CARD(trammel_override_limits(NULL, 0, 0));
  NO_CARD(trammel_set_output_safe_cause(NULL, 0, 0));
  NO_CARD(trammel_count_captures(NULL, &number));
  NO_CARD(trammel_select_capture(NULL, 0, &select));
  NO_CARD(trammel_stop_capture(NULL, 0));
  NO_CARD(trammel_read_captures(NULL, &captures));
  NO_CARD(trammel_take_capture(NULL, 0, &capture, &flag));
  NO_CARD(trammel_wait_for_capture(NULL, 0, 1, &capture));
  NO_CARD(trammel_clear_captures(NULL, 1));
  NO_CARD(trammel_has_capture_queue(NULL, &flag));
  NO_CARD(trammel_read_capture_queue(NULL, &capture_queue));
  NO_CARD(trammel_take_queued_captures(NULL, queued, &number));
  NO_CARD(trammel_has_soft_limits(NULL, &flag));
  NO_CARD(trammel_set_soft_limits(NULL, range, 1));
  NO_CARD(trammel_read_soft_limits(NULL, range));
  NO_CARD(trammel_set_soft_limit_ramps(NULL, true));
  NO_CARD(trammel_set_output_roles(NULL, &outputs));
  NO_CARD(trammel_set_enable_sequence(NULL, &sequence));
  NO_CARD(trammel_enable(NULL, true));
  NO_CARD(trammel_set_health(NULL, &health));
  NO_CARD(trammel_has_emergency_stop(NULL, &flag));
  NO_CARD(trammel_read_emergency_stop(NULL, &flag));
  NO_CARD(trammel_set_emergency_stop_ramps(NULL, true));
  NO_CARD(trammel_read_place(NULL, &place));
  NO_CARD(trammel_begin_at_place(NULL, 0, false, &place));
  NO_CARD(trammel_set_place(NULL, 0, true, false));
  NO_CARD(trammel_set_machine_zero(NULL, 0, 0));
  NO_CARD(trammel_set_scales(NULL, 1));
  NO_CARD(trammel_set_keeps_place(NULL, 0));
  NO_CARD(trammel_set_hold(NULL, true));
  NO_CARD(trammel_set_ratio(NULL, TRAMMEL_CLASS_FEED, 0));
  NO_CARD(trammel_set_override(NULL, TRAMMEL_CLASS_FEED, 1, 100));
  NO_CARD(trammel_set_slew_time(NULL, 1));
  NO_CARD(trammel_abort(NULL));
  NO_CARD(trammel_take_over(NULL, NULL));
  NO_CARD(trammel_stop(NULL, 1, NULL));
  NO_CARD(trammel_start_line(NULL, &line, NULL));
  NO_CARD(trammel_run_line(NULL, &line, 1, NULL));
  NO_CARD(trammel_open_stream(NULL, NULL));
  NO_CARD(trammel_put(NULL, &command));
  NO_CARD(trammel_flush(NULL));
  NO_CARD(trammel_finish(NULL, NULL));
  NO_CARD(trammel_restart_stream(NULL));
  NO_CARD(trammel_probe(NULL, &condition, &command, 1, &probe));
  NO_CARD(trammel_open_positions(NULL, NULL));
  NO_CARD(trammel_send_positions(NULL, positions, 1, NULL));
  NO_CARD(trammel_recover_positions(NULL, &stop));
  NO_CARD(trammel_finish_positions(NULL, positions));
  NO_CARD(trammel_simulated_listen(NULL, NULL, NULL));
  NO_CARD(trammel_simulated_listen_to_outputs(NULL, NULL, NULL));
  NO_CARD(trammel_simulated_wait(NULL, 1));
  NO_CARD(trammel_simulated_set_inputs(NULL, 0));
  NO_CARD(trammel_simulated_set_input(NULL, 0, true));
  NO_CARD(trammel_simulated_set_emergency_stop(NULL, true));
  NO_CARD(trammel_simulated_reset(NULL));
  trammel_request_hold(NULL, true);
  trammel_request_ratio(NULL, TRAMMEL_CLASS_FEED, 0);
  trammel_request_abort(NULL);
  trammel_request_stop(NULL);
}

// Null pointers in other arguments.
static void null_pointers(void) {
  trammel_card* card = simulated_card();
  trammel_access access = {0, 0, false};
  trammel_command command = command_of(TRAMMEL_END);
  trammel_input_condition condition = {0, true, 0};
  trammel_probe_result probe;
  size_t made;
  FAILS(trammel_transfer(card, NULL, 1, &made), TRAMMEL_ARGUMENT, "accesses is null");
  FAILS(trammel_transfer(card, &access, 1, NULL), TRAMMEL_ARGUMENT, "made is null");
  FAILS(trammel_identify(card, NULL), TRAMMEL_ARGUMENT, "identification is null");
  FAILS(trammel_identify_units(card, NULL, 1, &made), TRAMMEL_ARGUMENT, "units is null");
  FAILS(trammel_identify_units(card, NULL, 0, NULL), TRAMMEL_ARGUMENT, "count is null");
  FAILS(trammel_configure_axis(card, 0, NULL), TRAMMEL_ARGUMENT, "settings is null");
  FAILS(trammel_read_status(card, NULL), TRAMMEL_ARGUMENT, "status is null");
  FAILS(trammel_read_snapshot(card, NULL), TRAMMEL_ARGUMENT, "snapshot is null");
  FAILS(trammel_read_stop_snapshot(card, NULL), TRAMMEL_ARGUMENT, "snapshot is null");
  FAILS(trammel_read_faults(card, NULL), TRAMMEL_ARGUMENT, "faults is null");
  FAILS(trammel_describe_faults(0, NULL, 1), TRAMMEL_ARGUMENT, "text is null");
  FAILS(trammel_read_inputs(card, NULL), TRAMMEL_ARGUMENT, "levels is null");
  FAILS(trammel_read_outputs(card, NULL), TRAMMEL_ARGUMENT, "levels is null");
  FAILS(trammel_read_place(card, NULL), TRAMMEL_ARGUMENT, "place is null");
  FAILS(trammel_start_line(card, NULL, NULL), TRAMMEL_ARGUMENT, "line is null");
  FAILS(trammel_run_line(card, NULL, 1, NULL), TRAMMEL_ARGUMENT, "line is null");
  DONE(trammel_open_positions(card, NULL));
  FAILS(trammel_send_positions(card, NULL, 1000000, NULL), TRAMMEL_ARGUMENT, "targets is null");
  FAILS(trammel_recover_positions(card, NULL), TRAMMEL_ARGUMENT, "stopped is null");
  DONE(trammel_finish_positions(card, NULL));
  DONE(trammel_open_stream(card, NULL));
  FAILS(trammel_put(card, NULL), TRAMMEL_ARGUMENT, "command is null");
  FAILS(trammel_probe(card, NULL, &command, 1, &probe), TRAMMEL_ARGUMENT, "condition is null");
  FAILS(trammel_probe(card, &condition, NULL, 1, &probe), TRAMMEL_ARGUMENT, "paths is null");
  FAILS(trammel_probe(card, &condition, &command, 1, NULL), TRAMMEL_ARGUMENT, "result is null");
#ifndef TRAMMEL_SANITIZED  // a sanitizer ends the process when memory runs out
  FAILS(trammel_probe(card, &condition, &command, (size_t)1 << 46, &probe), TRAMMEL_MEMORY, "memory");
#endif
  trammel_close(card);
}

static void* fail_elsewhere(void* result) {
  *(bool*)result = trammel_last_error()->result == TRAMMEL_OK && trammel_open("nowhere:", NULL) == TRAMMEL_ARGUMENT &&
                   trammel_last_error()->result == TRAMMEL_ARGUMENT;
  return NULL;
}

static void errors_are_a_threads_own(void) {
  trammel_card* card = NULL;
  pthread_t thread;
  bool right = false;
  FAILS(trammel_open("somewhere:", &card), TRAMMEL_ARGUMENT, "somewhere:");
  CHECK(pthread_create(&thread, NULL, fail_elsewhere, &right) == 0);
  CHECK(pthread_join(thread, NULL) == 0);
  CHECK(right);
  CHECK(strstr(trammel_last_error()->text, "somewhere:") != NULL);
}

static void long_texts_are_cut(void) {
  char url[3000];
  trammel_card* card = NULL;
  memset(url, 'x', sizeof url - 1);
  url[sizeof url - 1] = '\0';
  FAILS(trammel_open(url, &card), TRAMMEL_ARGUMENT, "xxx");
  CHECK(strlen(trammel_last_error()->text) == sizeof trammel_last_error()->text - 1);
}

static void* stop_it(void* card) {
  trammel_request_stop((trammel_card*)card);
  return NULL;
}

// A second thread requests a stop while the first one waits for a line of 2^39 clocks.
static void stopped_by_a_thread(void) {
  trammel_card* card = simulated_card();
  trammel_one_shot line;
  pthread_t thread;
  memset(&line, 0, sizeof line);
  line.pulses[0] = 1;
  line.duration_ns = INT64_C(549755813888) * 1000;
  CHECK(pthread_create(&thread, NULL, stop_it, card) == 0);
  FAILS(trammel_run_line(card, &line, 1000000000, NULL), TRAMMEL_STOPPED, "");
  CHECK(pthread_join(thread, NULL) == 0);
  trammel_close(card);
}

void test_errors(void) {
  opening();
  own_bus();
  states();
  one_shot_arguments();
  command_arguments();
  raw_accesses();
  null_cards();
  null_pointers();
  errors_are_a_threads_own();
  long_texts_are_cut();
  stopped_by_a_thread();
}
