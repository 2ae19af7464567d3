// The stream of commands through trammel.h.
#include "check.h"

static void put_all(trammel_card* card, const trammel_command* commands, size_t count) {
  size_t i;
  for (i = 0; i < count; ++i) DONE(trammel_put(card, &commands[i]));
}

static trammel_command arc_of(int32_t kind, uint64_t ticks) {
  trammel_command command = command_of(kind);  // a quarter circle about (-100, 0), anticlockwise, to (-100, 100)
  command.as.arc.ticks = ticks;
  command.as.arc.centre_x = -100 * 256;
  command.as.arc.end_x = -100;
  command.as.arc.end_y = 100;
  command.as.arc.sweep = 1.5707963267948966;
  command.as.arc.axis_y = 1;
  return command;
}

static trammel_command ellipse_of(uint64_t ticks) {
  trammel_command command = command_of(TRAMMEL_ELLIPSE);  // half an ellipse, from (50, 0) through (0, 20) to (-50, 0)
  command.as.ellipse.ticks = ticks;
  command.as.ellipse.semi_x = 50;
  command.as.ellipse.semi_y = 20;
  command.as.ellipse.start_x = 50;
  command.as.ellipse.end_x = -100;
  command.as.ellipse.sweep = 3.141592653589793;
  command.as.ellipse.axis_y = 1;
  return command;
}

static void all_commands(void) {
  trammel_card* card = simulated_card();
  trammel_command program[12];
  trammel_command chords = arc_of(TRAMMEL_ARC_CHORD, 20000);
  trammel_command dwell = command_of(TRAMMEL_DWELL);
  trammel_command output = command_of(TRAMMEL_OUTPUT);
  trammel_command until = command_of(TRAMMEL_WAIT_INPUT);
  trammel_status status;
  trammel_snapshot snapshot;
  trammel_snapshot mark;
  uint32_t marks = 0;
  uint16_t levels = 0;
  chords.as.arc.further[2] = 77;
  dwell.as.dwell_clocks = 1000;
  output.as.output.set = 4;
  until.as.wait_input.input = 3;
  until.as.wait_input.level = false;
  program[0] = feed_of(512);
  program[1] = line_of(512, 100, -300);
  program[2] = feed_of(1000 + 20000 + 1000);
  program[3] = arc_of(TRAMMEL_ARC, 1000);
  program[4] = chords;
  program[5] = output;
  program[6] = command_of(TRAMMEL_MARK);
  program[7] = ellipse_of(1000);
  program[8] = dwell;
  program[9] = until;
  program[10] = feed_of(100);
  program[11] = line_of(100, 1, 0);
  DONE(trammel_open_stream(card, NULL));
  put_all(card, program, 12);
  DONE(trammel_flush(card));
  DONE(trammel_finish(card, &status));
  CHECK(!status.busy && !status.ended);
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] == 100 - 100 - 100 - 100 + 1);
  CHECK(snapshot.position[1] == -300 + 100 + 100);
  CHECK(snapshot.position[2] == 77);
  DONE(trammel_read_outputs(card, &levels));
  CHECK(levels == 4);
  DONE(trammel_read_marks(card, &marks, &mark));
  CHECK(marks == 1 && mark.position[2] == 77 && mark.geometry_begun == 3);
  program[0] = command_of(TRAMMEL_END);
  put_all(card, program, 1);
  DONE(trammel_finish(card, &status));
  CHECK(status.ended);
  trammel_close(card);
}

static void probing(void) {
  trammel_card* card = simulated_card();
  const trammel_input_condition low = {1, false, 0};
  const trammel_input_condition high = {1, true, 0};
  const trammel_input_condition timed = {1, true, 7};
  trammel_command paths[2];
  trammel_probe_result result;
  paths[0] = feed_of(1000);
  paths[1] = line_of(1000, 50, 0);
  DONE(trammel_open_stream(card, NULL));
  DONE(trammel_probe(card, &high, paths, 2, &result));
  CHECK(result.outcome == TRAMMEL_PROBE_MISSED && result.rest.position[0] == 50 && result.edge.time == 0);
  DONE(trammel_probe(card, &low, paths, 2, &result));
  CHECK(result.outcome == TRAMMEL_PROBE_TRIPPED_ALREADY && result.rest.position[0] == 50 && result.edge.time > 0);
  FAILS(trammel_probe(card, &timed, paths, 2, &result), TRAMMEL_ARGUMENT, "time-out");
  FAILS(trammel_probe(card, &high, paths, 0, &result), TRAMMEL_ARGUMENT, "");
  DONE(trammel_finish(card, NULL));
  trammel_close(card);
}

typedef struct watch {
  trammel_card* card;
  unsigned long looks;
  unsigned long looks_held;
  unsigned long act_at;
  void (*act)(trammel_card* card);
  trammel_progress last;
} watch;

// Progress callback. Call number act_at calls act(), or cancels the wait if act is null. The 20th call in a hold
// releases it.
static bool look(void* context, const trammel_progress* progress) {
  watch* is = (watch*)context;
  is->last = *progress;
  if (progress->status.held && ++is->looks_held == 20) trammel_request_hold(is->card, false);
  if (++is->looks != is->act_at) return true;
  if (is->act == NULL) return false;
  is->act(is->card);
  return true;
}

static void trip(trammel_card* card) { DONE(trammel_simulated_set_inputs(card, 2)); }
static void ask_hold(trammel_card* card) { trammel_request_hold(card, true); }
static void ask_stop(trammel_card* card) { trammel_request_stop(card); }
static void ask_abort(trammel_card* card) { trammel_request_abort(card); }
static void ask_half(trammel_card* card) {
  trammel_request_ratio(card, 7, 1);
  trammel_request_ratio(card, TRAMMEL_CLASS_FEED, TRAMMEL_FULL_RATIO / 2);
}

static void open_watched(watch* is, trammel_card* card, void (*act)(trammel_card*)) {
  trammel_stream_options options;
  memset(is, 0, sizeof *is);
  memset(&options, 0, sizeof options);
  is->card = card;
  is->act_at = 10;
  is->act = act;
  options.progress = look;
  options.context = is;
  DONE(trammel_open_stream(card, &options));
}

static void long_line(trammel_card* card) {
  trammel_command feed = feed_of(10000);
  trammel_command line = line_of(10000, 1000, 0);
  DONE(trammel_put(card, &feed));
  DONE(trammel_put(card, &line));
}

static void probe_on_the_way(void) {
  trammel_card* card = simulated_card();
  const trammel_input_condition high = {1, true, 0};
  trammel_command paths[2];
  trammel_probe_result result;
  watch is;
  open_watched(&is, card, trip);
  DONE(trammel_set_slew_time(card, 1000000));
  paths[0] = feed_of(10000);
  paths[1] = line_of(10000, 1000, 0);
  DONE(trammel_probe(card, &high, paths, 2, &result));
  CHECK(result.outcome == TRAMMEL_PROBE_TRIPPED);
  CHECK(result.edge.position[0] > 0 && result.rest.position[0] >= result.edge.position[0]);
  CHECK(result.rest.position[0] < 1000);
  trammel_close(card);
}

static void requests(void) {
  trammel_card* card = simulated_card();
  trammel_snapshot snapshot;
  watch is;
  open_watched(&is, card, ask_half);
  long_line(card);
  DONE(trammel_finish(card, NULL));
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] == 1000 && snapshot.ratio == TRAMMEL_FULL_RATIO / 2);
  CHECK(is.looks > 10 && is.last.commands_sent == 2);
  DONE(trammel_set_ratio(card, TRAMMEL_CLASS_FEED, TRAMMEL_FULL_RATIO));

  open_watched(&is, card, ask_stop);
  long_line(card);
  FAILS(trammel_finish(card, NULL), TRAMMEL_STOPPED, "");
  CHECK(trammel_last_error()->geometry_begun == 1);
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] > 1000 && snapshot.position[0] < 2000 && !snapshot.status.busy);

  open_watched(&is, card, ask_abort);
  long_line(card);
  FAILS(trammel_finish(card, NULL), TRAMMEL_STATE, "aborted");
  DONE(trammel_wait_until_idle(card, 1000000000));

  open_watched(&is, card, NULL);
  long_line(card);
  FAILS(trammel_finish(card, NULL), TRAMMEL_CANCELLED, "callback");
  DONE(trammel_finish(card, NULL));  // the stream is still open and the card still moves
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] > 2000);

  open_watched(&is, card, ask_hold);
  long_line(card);
  DONE(trammel_finish(card, NULL));
  CHECK(is.looks_held > 0);
  trammel_close(card);
}

static void faults(void) {
  trammel_card* card = simulated_card();
  trammel_command feed = feed_of(100);
  trammel_command line = line_of(99, 1, 0);
  trammel_command end = command_of(TRAMMEL_END);
  trammel_snapshot stopped;
  uint32_t is = 0;
  char text[16];
  DONE(trammel_open_stream(card, NULL));
  DONE(trammel_put(card, &feed));
  DONE(trammel_put(card, &line));
  DONE(trammel_put(card, &end));
  FAILS(trammel_finish(card, NULL), TRAMMEL_FAULT, "TICK_MISMATCH");
  CHECK(trammel_last_error()->faults == 0x100);
  DONE(trammel_read_faults(card, &is));
  CHECK(is == 0x100);
  DONE(trammel_read_stop_snapshot(card, &stopped));
  CHECK(stopped.faults == 0x100 && stopped.time > 0);
  DONE(trammel_describe_faults(is, text, sizeof text));
  CHECK(strcmp(text, "TICK_MISMATCH") == 0);
  DONE(trammel_describe_faults(is, text, 5));
  CHECK(strcmp(text, "TICK") == 0);
  FAILS(trammel_describe_faults(is, text, 0), TRAMMEL_ARGUMENT, "0 bytes");
  FAILS(trammel_restart_stream(card), TRAMMEL_FAULT, "TICK_MISMATCH");
  DONE(trammel_clear_faults(card));
  DONE(trammel_restart_stream(card));
  DONE(trammel_put(card, &feed));
  line = line_of(100, 1, 0);
  DONE(trammel_put(card, &line));
  DONE(trammel_finish(card, NULL));
  trammel_close(card);
}

static void watchdog(void) {
  trammel_card* card = simulated_card();
  uint32_t is = 0;
  FAILS(trammel_set_watchdog(card, -1), TRAMMEL_ARGUMENT, "negative");
  DONE(trammel_set_watchdog(card, 10000000));
  DONE(trammel_simulated_wait(card, 1000000));
  DONE(trammel_read_faults(card, &is));
  CHECK(is == 0xC000);  // WATCHDOG and LINK_LOSS
  DONE(trammel_set_watchdog(card, 0));
  DONE(trammel_clear_faults(card));
  DONE(trammel_simulated_wait(card, 1000000));
  DONE(trammel_read_faults(card, &is));
  CHECK(is == 0);
  trammel_close(card);
}

static void refusals(void) {
  trammel_card* card = simulated_card();
  trammel_command feed = feed_of(100);
  trammel_access rubbish = {0x610, 0xFFFFFFFF, true};  // a word of the stream with which no command begins
  size_t made = 1;
  DONE(trammel_open_stream(card, NULL));
  DONE(trammel_put(card, &feed));
  DONE(trammel_transfer(card, &rubbish, 1, &made));
  CHECK(made == 0);
  FAILS(trammel_flush(card), TRAMMEL_REFUSED, "STREAM");
  CHECK(trammel_last_error()->reason == 1 && trammel_last_error()->address == 0x610);
  FAILS(trammel_put(card, &feed), TRAMMEL_STATE, "restart");
  DONE(trammel_restart_stream(card));
  DONE(trammel_put(card, &feed));
  DONE(trammel_flush(card));
  trammel_close(card);
}

// Output changes that the listener has received.
typedef struct changes {
  trammel_output_change change[4];
  unsigned count;
} changes;

static void note_change(void* context, const trammel_output_change* change) {
  changes* noted = (changes*)context;
  if (noted->count < 4) noted->change[noted->count] = *change;
  ++noted->count;
}

static void put_ramp(trammel_card* card, double speed, double end_speed) {
  trammel_ramp ramp;
  trammel_command feed = command_of(TRAMMEL_FEED);
  memset(&ramp, 0, sizeof ramp);
  ramp.ticks = 1000;
  ramp.speed = speed;
  ramp.end_speed = end_speed;
  ramp.highest_speed = speed > end_speed ? speed : end_speed;
  ramp.slew_time_ns = 10000000;
  DONE(trammel_feed_for_ramp(&ramp, 1000000, &feed.as.feed));
  CHECK(feed.as.feed.ticks == 1000 && feed.as.feed.jerk == 0 && feed.as.feed.floor > 0);
  CHECK((feed.as.feed.acceleration > 0) == (end_speed > speed));
  CHECK(feed.as.feed.stop_distance == (end_speed == 0 ? 0 : 100));
  DONE(trammel_put(card, &feed));
}

static void ramps_and_outputs(void) {
  trammel_card* card = simulated_card();
  trammel_command line = line_of(1000, 100, 0);
  trammel_command output = command_of(TRAMMEL_OUTPUT);
  trammel_ramp ramp;
  trammel_snapshot snapshot;
  changes noted;
  memset(&noted, 0, sizeof noted);
  memset(&ramp, 0, sizeof ramp);
  DONE(trammel_simulated_listen_to_outputs(card, note_change, &noted));
  DONE(trammel_set_slew_time(card, 10000000));
  DONE(trammel_open_stream(card, NULL));
  put_ramp(card, 0, 20000);
  DONE(trammel_put(card, &line));
  output.as.output.set = 5;
  DONE(trammel_put(card, &output));
  put_ramp(card, 20000, 0);
  DONE(trammel_put(card, &line));
  output.as.output.set = 0;
  output.as.output.clear = 4;
  DONE(trammel_put(card, &output));
  DONE(trammel_finish(card, NULL));
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] == 200);
  CHECK(noted.count == 2);
  CHECK(noted.change[0].changed == 5 && noted.change[0].levels == 5);
  CHECK(noted.change[1].changed == 4 && noted.change[1].levels == 1);
  // 1,000 ticks from 20,000 ticks/s to 0 take 100 ms, or less by at most the tick closest to rest (2.3 ms).
  CHECK(noted.change[1].cycle - noted.change[0].cycle > 97000 &&
        noted.change[1].cycle - noted.change[0].cycle < 100100);
  DONE(trammel_simulated_listen_to_outputs(card, NULL, NULL));
  DONE(trammel_put(card, &output));
  DONE(trammel_finish(card, NULL));
  CHECK(noted.count == 2);
  FAILS(trammel_feed_for_ramp(&ramp, 1000000, &line.as.feed), TRAMMEL_ARGUMENT, "ticks, not 0");
  FAILS(trammel_feed_for_ramp(NULL, 1000000, &line.as.feed), TRAMMEL_ARGUMENT, "ramp is null");
  FAILS(trammel_feed_for_ramp(&ramp, 1000000, NULL), TRAMMEL_ARGUMENT, "command is null");
  trammel_close(card);
}

void test_stream(void) {
  ramps_and_outputs();
  all_commands();
  probing();
  probe_on_the_way();
  requests();
  faults();
  watchdog();
  refusals();
}
