/* What the examples in C share: a card made ready by its URL, errors in words, and a record of what leaves the pins of
   a card that is simulated in this process. C99. */
#ifndef OTHER_HOST_H
#define OTHER_HOST_H

#include <stdio.h>
#include <stdlib.h>
#include <trammel.h>

/* A failed call ends the program. The card then stops on a ramp by its watchdog, which open_card() has set. */
static inline void must(trammel_result result) {
  if (result == TRAMMEL_OK) return;
  fprintf(stderr, "%s: %s\n", trammel_result_name(result), trammel_last_error()->text);
  exit(1);
}

/* A check that fails is printed and counted: a program's exit status is whether there was one. */
static int failed_checks = 0;
#define CHECK(holds, ...)                            \
  do {                                               \
    if (!(holds)) {                                  \
      ++failed_checks;                               \
      fprintf(stderr, "check failed: " __VA_ARGS__); \
      fputc('\n', stderr);                           \
    }                                                \
  } while (0)

/* Steps and changes of outputs in order of time. */
typedef struct pulses {
  trammel_step* steps;
  size_t count;
  size_t room;
  trammel_output_change outputs[64];
  size_t changes; /* also those beyond the first 64 */
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

/* Where the pulses at the pins have brought an axis by the end of a clock. */
static inline int64_t pulses_until(const pulses* record, unsigned axis, uint64_t cycle) {
  int64_t sum = 0;
  size_t i;
  for (i = 0; i < record->count && record->steps[i].cycle <= cycle; ++i) {
    if (record->steps[i].at_pin && record->steps[i].axis == axis) sum += record->steps[i].direction;
  }
  return sum;
}

/* Opens the card and makes it ready for a program that moves the first `axes` axes: step times, slew, watchdog. Where
   the card is simulated in this process, `record` hears it, and the result is true. `from` is where the axes stand. */
static inline bool open_card(const char* url, unsigned axes, int64_t slew_time_ns, trammel_card** card, pulses* record,
                             trammel_place* from) {
  trammel_axis_settings step_times = {0};
  bool simulated;
  unsigned axis;
  step_times.step_length_ns = 2000; /* of the drive's data sheet */
  step_times.step_space_ns = 2000;
  step_times.direction_setup_ns = 2000;
  step_times.direction_hold_ns = 2000;
  must(trammel_open(url, card));
  must(trammel_take_over(*card, NULL)); /* a served card holds when a client has gone */
  for (axis = 0; axis < axes; ++axis) must(trammel_configure_axis(*card, axis, &step_times));
  must(trammel_begin_at_place(*card, (uint8_t)((1u << axes) - 1), false, from));
  must(trammel_set_slew_time(*card, slew_time_ns));
  must(trammel_set_watchdog(*card, INT64_C(5000000000)));
  simulated = trammel_simulated_listen(*card, note_step, record) == TRAMMEL_OK;
  if (simulated) must(trammel_simulated_listen_to_outputs(*card, note_outputs, record));
  return simulated;
}

#endif
