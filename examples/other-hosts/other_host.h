/* Shared by the examples in C: sets up a card by its URL, prints errors as text, and records the pins' activity if the
   card is simulated in this process. C99. */
#ifndef OTHER_HOST_H
#define OTHER_HOST_H

#include <stdio.h>
#include <stdlib.h>
#include <trammel.h>

/* A failed call ends the program. The card then stops on a ramp when its watchdog, set by open_card(), expires. */
static inline void must(trammel_result result) {
  if (result == TRAMMEL_OK) return;
  fprintf(stderr, "%s: %s\n", trammel_result_name(result), trammel_last_error()->text);
  exit(1);
}

/* Prints and counts a failed check. The program's exit status tells whether any check failed. */
static int failed_checks = 0;
#define CHECK(holds, ...)                            \
  do {                                               \
    if (!(holds)) {                                  \
      ++failed_checks;                               \
      fprintf(stderr, "check failed: " __VA_ARGS__); \
      fputc('\n', stderr);                           \
    }                                                \
  } while (0)

/* Steps and changes of outputs, each in order of time. */
typedef struct pulses {
  trammel_step* steps;
  size_t count;
  size_t room;
  trammel_output_change outputs[64];
  size_t changes; /* total number of changes, including those that exceed the array */
} pulses;

static inline void note_step(void* context, const trammel_step* step) {
  pulses* record = (pulses*)context;
  if (record->count == record->room) {
    record->room = 2 * record->room + 1024;
    record->steps = (trammel_step*)realloc(record->steps, record->room * sizeof *record->steps);
    if (record->steps == NULL) abort();
  }
  record->steps[record->count++] = *step;
}

static inline void note_outputs(void* context, const trammel_output_change* change) {
  pulses* record = (pulses*)context;
  if (record->changes < 64) record->outputs[record->changes] = *change;
  ++record->changes;
}

/* Position of an axis after all pulses at its pin up to and including clock `cycle`. */
static inline int64_t pulses_until(const pulses* record, unsigned axis, uint64_t cycle) {
  int64_t sum = 0;
  size_t i;
  for (i = 0; i < record->count && record->steps[i].cycle <= cycle; ++i) {
    if (record->steps[i].at_pin && record->steps[i].axis == axis) sum += record->steps[i].direction;
  }
  return sum;
}

/* Opens the card and sets step times, slew time and watchdog for a program that moves the first `axes` axes. If the
   card is simulated in this process, `record` receives its steps and outputs, and the result is true. `from` returns
   the axes' positions. */
static inline bool open_card(const char* url, unsigned axes, int64_t slew_time_ns, trammel_card** card, pulses* record,
                             trammel_place* from) {
  trammel_axis_settings step_times = {0};
  bool simulated;
  unsigned axis;
  step_times.step_length_ns = 2000; /* from the drive's data sheet */
  step_times.step_space_ns = 2000;
  step_times.direction_setup_ns = 2000;
  step_times.direction_hold_ns = 2000;
  must(trammel_open(url, card));
  must(trammel_take_over(*card, NULL)); /* a served card holds after its client has disconnected */
  for (axis = 0; axis < axes; ++axis) must(trammel_configure_axis(*card, axis, &step_times));
  must(trammel_begin_at_place(*card, (uint8_t)((1u << axes) - 1), false, from));
  must(trammel_set_slew_time(*card, slew_time_ns));
  must(trammel_set_watchdog(*card, INT64_C(5000000000)));
  simulated = trammel_simulated_listen(*card, note_step, record) == TRAMMEL_OK;
  if (simulated) must(trammel_simulated_listen_to_outputs(*card, note_outputs, record));
  return simulated;
}

#endif
