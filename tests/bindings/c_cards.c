// Cards through trammel.h: identification, one-shot lines, settings, state, hold and stop.
#include <signal.h>

#include "check.h"

typedef struct counts {
  uint64_t at_pins[TRAMMEL_MAX_AXES];
  uint64_t on_path[TRAMMEL_MAX_AXES];
  int64_t position[TRAMMEL_MAX_AXES];
  uint64_t last_cycle;
} counts;

static void count_step(void* context, const trammel_step* step) {
  counts* all = (counts*)context;
  if (!step->at_pin) {
    ++all->on_path[step->axis];
    return;
  }
  ++all->at_pins[step->axis];
  all->position[step->axis] += step->direction;
  all->last_cycle = step->cycle;
}

static void identification(void) {
  trammel_simulation simulation = {7, 25000000};
  trammel_card* card = NULL;
  trammel_identification is;
  trammel_unit units[5];
  size_t count = 0;
  DONE(trammel_open_simulated(&simulation, &card));
  DONE(trammel_identify(card, &is));
  CHECK(is.axes == 7);
  CHECK(is.clock_hz == 25000000);
  CHECK(is.geometry_depth == 4096 && is.feed_depth == 2560);
  CHECK(is.map_major > 0 && is.commands_version > 0 && is.engines != 0);
  DONE(trammel_identify_units(card, NULL, 0, &count));
  CHECK(count > 5 && count < 32);
  DONE(trammel_identify_units(card, units, 5, &count));
  CHECK(count > 5 && units[4].tag == 5 && units[4].instances == 7);
  CHECK(units[4].address == 0x800 && units[4].stride == 32 && units[2].words == 1);
  trammel_close(card);
}

static void one_shot_lines(void) {
  trammel_card* card = simulated_card();
  trammel_one_shot line;
  trammel_line_plan plan;
  trammel_snapshot snapshot;
  trammel_status status;
  counts steps;
  memset(&steps, 0, sizeof steps);
  memset(&line, 0, sizeof line);
  DONE(trammel_simulated_listen(card, count_step, &steps));
  line.pulses[0] = 20;
  line.pulses[1] = -40;
  line.duration_ns = 2000000;
  DONE(trammel_start_line(card, &line, &plan));
  CHECK(plan.parts == 1 && plan.clocks == 2000 && !plan.slowed);
  DONE(trammel_read_status(card, &status));
  CHECK(status.busy && status.direct && !status.held && !status.faulted);
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_REFUSED, "BUSY");
  CHECK(trammel_last_error()->reason == 8);
  DONE(trammel_wait_until_idle(card, 1000000000));
  DONE(trammel_read_snapshot(card, &snapshot));
  CHECK(snapshot.position[0] == 20 && snapshot.position[1] == -40 && snapshot.position[2] == 0);
  CHECK(snapshot.time > 2000 && !snapshot.status.busy && snapshot.ratio == TRAMMEL_FULL_RATIO);
  CHECK(steps.at_pins[0] == 20 && steps.at_pins[1] == 40 && steps.at_pins[2] == 0);
  CHECK(steps.position[0] == 20 && steps.position[1] == -40);

  line.duration_ns = 0;  // 50 pulses of path (30, 40), at 1000 pulses/s
  line.speed_pulses = 1000;
  line.speed_seconds = 1;
  line.pulses[0] = 30;
  line.pulses[1] = 40;
  DONE(trammel_run_line(card, &line, 1000000000, &plan));
  CHECK(plan.clocks == 50000);
  line.max_velocity[1] = 400;
  FAILS(trammel_run_line(card, &line, 1000000000, &plan), TRAMMEL_ARGUMENT, "axis 1");
  line.slow_down = true;
  DONE(trammel_run_line(card, &line, 1000000000, &plan));
  CHECK(plan.clocks == 100000 && plan.slowed);
  DONE(trammel_simulated_listen(card, NULL, NULL));
  DONE(trammel_run_line(card, &line, 1000000000, NULL));
  CHECK(steps.at_pins[1] == 120);
  trammel_close(card);
}

static void settings(void) {
  trammel_card* card = simulated_card();
  trammel_axis_settings axis;
  trammel_one_shot line;
  memset(&axis, 0, sizeof axis);
  memset(&line, 0, sizeof line);
  axis.step_length_ns = 50000;
  axis.step_space_ns = 50000;
  DONE(trammel_configure_axis(card, 0, &axis));
  FAILS(trammel_configure_axis(card, 4, &axis), TRAMMEL_ARGUMENT, "axis");
  axis.step_space_ns = -1;
  FAILS(trammel_configure_axis(card, 0, &axis), TRAMMEL_ARGUMENT, "STEP_SPACE");
  axis.step_space_ns = 0;
  axis.mode = 3;
  FAILS(trammel_configure_axis(card, 0, &axis), TRAMMEL_ARGUMENT, "mode 3");
  line.pulses[0] = 100;  // with these settings a pulse takes at least 100 clocks
  line.duration_ns = 5000000;
  FAILS(trammel_start_line(card, &line, NULL), TRAMMEL_ARGUMENT, "axis 0");
  trammel_close(card);
}

static void pins(void) {
  trammel_card* card = simulated_card();
  uint32_t inputs = 0;
  uint16_t levels = 0;
  uint32_t marks = 1;
  DONE(trammel_simulated_set_inputs(card, 9));
  DONE(trammel_set_input_polarity(card, 1));
  DONE(trammel_simulated_wait(card, 10));
  DONE(trammel_read_inputs(card, &inputs));
  CHECK(inputs == 8);
  DONE(trammel_set_output_safe(card, 2, 2));
  DONE(trammel_abort(card));
  DONE(trammel_read_outputs(card, &levels));
  CHECK(levels == 2);
  DONE(trammel_read_marks(card, &marks, NULL));
  CHECK(marks == 0);
  trammel_close(card);
}

static void hold_and_stop(void) {
  trammel_card* card = simulated_card();
  trammel_one_shot line;
  trammel_status status;
  trammel_snapshot rest;
  trammel_snapshot later;
  memset(&line, 0, sizeof line);
  line.pulses[0] = 10000;
  line.duration_ns = 1000000000;
  DONE(trammel_set_slew_time(card, 1000000));
  DONE(trammel_start_line(card, &line, NULL));
  DONE(trammel_set_hold(card, true));
  DONE(trammel_simulated_wait(card, 2000));
  DONE(trammel_read_status(card, &status));
  CHECK(status.held && status.busy);
  DONE(trammel_set_hold(card, false));
  DONE(trammel_set_override(card, TRAMMEL_CLASS_FEED, 50, 100));
  DONE(trammel_simulated_wait(card, 100000));
  DONE(trammel_read_snapshot(card, &later));
  CHECK(later.ratio == TRAMMEL_FULL_RATIO / 2);
  CHECK(later.position[0] > 450 && later.position[0] < 550);
  DONE(trammel_stop(card, 1000000000, &rest));
  DONE(trammel_simulated_wait(card, 100000));
  DONE(trammel_read_snapshot(card, &later));
  CHECK(!later.status.busy && later.position[0] == rest.position[0]);
  FAILS(trammel_set_override(card, TRAMMEL_CLASS_FEED, 101, 100), TRAMMEL_ARGUMENT, "101");
  FAILS(trammel_set_ratio(card, 3, 0), TRAMMEL_ARGUMENT, "class 3");
  FAILS(trammel_set_ratio(card, TRAMMEL_CLASS_RAPID, TRAMMEL_FULL_RATIO + 1), TRAMMEL_ARGUMENT, "ratio");
  trammel_close(card);
}

// A call reports an earlier hold at once. trammel_take_over() ends the hold.
static void held(void) {
  trammel_card* card = simulated_card();
  trammel_one_shot line;
  trammel_access hold = {0x604, 1, true};
  size_t made;
  bool dropped = true;
  memset(&line, 0, sizeof line);
  line.pulses[0] = 10;
  line.duration_ns = 1000000;
  DONE(trammel_transfer(card, &hold, 1, &made));
  FAILS(trammel_run_line(card, &line, 1000000, NULL), TRAMMEL_HELD, "the card holds");
  FAILS(trammel_open_stream(card, NULL), TRAMMEL_HELD, "stream: the card holds");
  DONE(trammel_take_over(card, &dropped));
  CHECK(!dropped);
  DONE(trammel_start_line(card, &line, NULL));
  DONE(trammel_transfer(card, &hold, 1, &made));
  DONE(trammel_take_over(card, &dropped));
  CHECK(dropped);
  DONE(trammel_run_line(card, &line, 1000000, NULL));
  trammel_close(card);
}

static volatile sig_atomic_t g_signalled = 0;
static void on_signal(int signal) { g_signalled = signal; }
static bool signal_came(void* context) {
  unsigned* asked = (unsigned*)context;
  if (++*asked == 2) raise(SIGINT);
  return g_signalled != 0;
}

// A signal ends a line of 100 hours. The card is then empty and at rest.
static void interrupts(void) {
  trammel_card* card = simulated_card();
  trammel_one_shot line;
  trammel_status status;
  unsigned asked = 0;
  memset(&line, 0, sizeof line);
  line.pulses[0] = 10;
  line.duration_ns = INT64_C(1000000000) * 360000;
  signal(SIGINT, on_signal);
  trammel_set_interrupt(signal_came, &asked);
  FAILS(trammel_run_line(card, &line, 1000000, NULL), TRAMMEL_STOPPED, "because the call was interrupted");
  CHECK(asked == 2);
  FAILS(trammel_simulated_wait(card, UINT64_MAX), TRAMMEL_CANCELLED, "interrupted");
  trammel_set_interrupt(NULL, NULL);
  signal(SIGINT, SIG_DFL);
  DONE(trammel_read_status(card, &status));
  CHECK(!status.busy && !status.held);
  line.duration_ns = 1000000;
  DONE(trammel_run_line(card, &line, 1000000, NULL));
  trammel_close(card);
}

static void two_cards(void) {
  trammel_card* one = simulated_card();
  trammel_card* other = simulated_card();
  trammel_one_shot line;
  trammel_snapshot snapshot;
  memset(&line, 0, sizeof line);
  line.pulses[3] = 5;
  line.duration_ns = 1000000;
  DONE(trammel_run_line(one, &line, 1000000000, NULL));
  trammel_close(one);
  DONE(trammel_read_snapshot(other, &snapshot));
  CHECK(snapshot.position[3] == 0);
  trammel_close(other);
}

void test_cards(void) {
  CHECK(strcmp(trammel_version(), TRAMMEL_EXPECTED_VERSION) == 0);
  CHECK(strcmp(trammel_result_name(TRAMMEL_IDENTIFICATION), "TRAMMEL_IDENTIFICATION") == 0);
  CHECK(strcmp(trammel_result_name(TRAMMEL_HELD), "TRAMMEL_HELD") == 0);
  CHECK(strcmp(trammel_result_name(99), "unknown") == 0);
  identification();
  one_shot_lines();
  settings();
  pins();
  hold_and_stop();
  held();
  interrupts();
  two_cards();
}
