/* Pick and place, as OpenPnP drives a machine: a head moves from point to point in several axes and switches its
   vacuum.

       pick_and_place [URL]         URL: of the card (docs/reference/card-url.md); default: a simulated card

   A move is a straight line of all axes from rest to rest. Outputs can switch at via points on it without a stop: the
   card switches them with the last tick of the preceding path, so holds and overrides do not change the position. The
   vacuum comes on 1 mm above a part, so that it has built up when the nozzle touches the part. It goes off when the
   nozzle is at rest on the board, with a puff of air until the nozzle is 0.5 mm above the board. If the card is
   simulated in this process, its pulses show whether each output switched at the right position. */
#include <math.h>
#include <string.h>

#include "other_host.h"

enum { X, Y, Z, C, AXES };
enum { VACUUM = 1 << 0, PUFF = 1 << 1 }; /* outputs 0 and 1 */

static const double pulses_per_unit[AXES] = {80, 80, 400, 3200 / 360.0}; /* mm, mm, mm, degrees */
static const double travel_height = 0;                                   /* mm; down is negative */

typedef struct place {
  double at[AXES];
} place;

typedef struct part {
  place feeder;
  place board;
} part;

static const part parts[] = {
    {{{10.0, 5.0, -12.0, 0}}, {{42.5, 31.25, -10.0, 90}}},
    {{{14.0, 5.0, -12.0, 0}}, {{47.1, 31.25, -10.0, -45}}},
    {{{10.0, 9.0, -12.5, 0}}, {{36.3, 20.5, -10.3, 180}}},
};
#define PARTS (sizeof parts / sizeof *parts)

typedef struct machine {
  trammel_card* card;
  uint32_t clock_hz;
  int64_t pulses[AXES]; /* positions after the commands so far, from the start of the program */
} machine;

static void put_piece(machine* is, uint64_t ticks, double speed, double end_speed) {
  const trammel_ramp ramp = {ticks, speed, end_speed, fmax(speed, end_speed), INT64_C(100000000)};
  trammel_command feed = {0};
  if (ticks == 0) return;
  feed.kind = TRAMMEL_FEED;
  must(trammel_feed_for_ramp(&ramp, is->clock_hz, &feed.as.feed));
  must(trammel_put(is->card, &feed));
}

/* A trapezoid from rest to rest that takes `ticks` ticks. `speed` is in ticks/s, `acceleration` in ticks/s^2. */
static void put_trapezoid(machine* is, uint64_t ticks, double speed, double acceleration) {
  const double peak = fmin(speed, sqrt(acceleration * (double)ticks));
  const uint64_t ramp = (uint64_t)fmin(floor(peak * peak / (2 * acceleration)), (double)(ticks / 2));
  put_piece(is, ramp, 0, peak);
  put_piece(is, ticks - 2 * ramp, peak, peak);
  put_piece(is, ramp, peak, 0);
}

static void put_line(machine* is, uint64_t ticks, const int64_t* target) {
  trammel_command line = {0};
  unsigned axis;
  line.kind = TRAMMEL_LINE;
  line.as.line.ticks = ticks;
  for (axis = 0; axis < AXES; ++axis) line.as.line.pulses[axis] = target[axis] - is->pulses[axis];
  must(trammel_put(is->card, &line));
  memcpy(is->pulses, target, sizeof is->pulses);
}

static void put_outputs(machine* is, uint16_t set, uint16_t clear) {
  trammel_command output = {0};
  output.kind = TRAMMEL_OUTPUT;
  output.as.output.set = set;
  output.as.output.clear = clear;
  must(trammel_put(is->card, &output));
}

static void put_dwell(machine* is, double seconds) {
  trammel_command dwell = {0};
  dwell.kind = TRAMMEL_DWELL;
  dwell.as.dwell_clocks = (uint64_t)(seconds * is->clock_hz);
  must(trammel_put(is->card, &dwell));
}

/* Moves to `to` at `speed` and `acceleration` (mm/s and mm/s^2 along the path; degrees if only C moves). `via`: the
   fraction of the way, between 0 and 1, at which the outputs switch in motion; 0: no switching. */
static void move_to(machine* is, const place* to, double speed, double acceleration, double via, uint16_t set,
                    uint16_t clear) {
  int64_t target[AXES], middle[AXES];
  double length = 0;
  double turn = 0;
  double ticks_per_unit;
  uint64_t ticks, before;
  unsigned axis;
  for (axis = 0; axis < AXES; ++axis) {
    double way;
    target[axis] = llround(to->at[axis] * pulses_per_unit[axis]);
    way = (double)(target[axis] - is->pulses[axis]) / pulses_per_unit[axis];
    middle[axis] = is->pulses[axis] + llround(via * (double)(target[axis] - is->pulses[axis]));
    if (axis == C)
      turn = fabs(way);
    else
      length += way * way;
  }
  length = sqrt(length);
  if (length == 0) length = turn;
  if (length == 0) return;
  ticks_per_unit = floor(is->clock_hz / 2.0 / speed); /* one tick per two clocks at full speed */
  ticks = (uint64_t)llround(length * ticks_per_unit);
  put_trapezoid(is, ticks, speed * ticks_per_unit, acceleration * ticks_per_unit);
  before = (uint64_t)llround(via * (double)ticks);
  if (via > 0) {
    put_line(is, before, middle);
    put_outputs(is, set, clear);
  }
  put_line(is, ticks - before, target);
}

/* The X, Y and C of `at` with Z at `height`. */
static place above(const place* at, double height) {
  place over = *at;
  over.at[Z] = height;
  return over;
}

static void place_part(machine* is, const part* one) {
  place over = above(&one->feeder, travel_height);
  const double down = travel_height - one->feeder.at[Z];
  const double up = travel_height - one->board.at[Z];
  move_to(is, &over, 200, 3000, 0, 0, 0);
  move_to(is, &one->feeder, 50, 1500, (down - 1) / down, VACUUM, 0);
  put_dwell(is, 0.02);
  move_to(is, &over, 50, 1500, 0, 0, 0);
  over = above(&one->board, travel_height);
  move_to(is, &over, 200, 3000, 0, 0, 0); /* C turns during this move */
  move_to(is, &one->board, 50, 1500, 0, 0, 0);
  put_outputs(is, PUFF, VACUUM);
  put_dwell(is, 0.01);
  move_to(is, &over, 50, 1500, 0.5 / up, 0, PUFF);
}

/* Each part causes three changes. Checks the levels of each change, the positions of all axes at it, and whether Z was
   in motion. */
static void check_outputs(const pulses* record, uint32_t clock_hz) {
  static const uint16_t levels[] = {VACUUM, PUFF, 0};
  size_t i;
  unsigned axis;
  CHECK(record->changes == 3 * PARTS, "%zu changes of outputs", record->changes);
  for (i = 0; i < record->changes && i < 3 * PARTS; ++i) {
    const trammel_output_change* const change = &record->outputs[i];
    const part* const one = &parts[i / 3];
    place expected = i % 3 == 0 ? one->feeder : one->board;
    if (i % 3 == 0) expected.at[Z] += 1;
    if (i % 3 == 2) expected.at[Z] += 0.5;
    CHECK(change->levels == levels[i % 3], "change %zu: outputs are %x", i, change->levels);
    for (axis = 0; axis < AXES; ++axis) {
      const int64_t at = pulses_until(record, axis, change->cycle);
      const int64_t wanted = llround(expected.at[axis] * pulses_per_unit[axis]);
      const int64_t later = pulses_until(record, axis, change->cycle + clock_hz / 1000);
      CHECK(at == wanted, "change %zu: axis %u at %ld, not %ld", i, axis, (long)at, (long)wanted);
      CHECK(axis != Z || (later == at) == (i % 3 == 1), "change %zu: a stop, or none", i);
    }
    printf("%.4f s: outputs %x at X %.2f Y %.2f Z %.2f\n", (double)change->cycle / clock_hz, change->levels,
           expected.at[X], expected.at[Y], expected.at[Z]);
  }
}

int main(int argc, char** argv) {
  static const place home = {{0, 0, 0, 0}};
  trammel_identification identification;
  trammel_place from, to;
  pulses record = {0};
  machine is = {0};
  bool simulated;
  size_t i;
  unsigned axis;
  simulated = open_card(argc > 1 ? argv[1] : "sim:", AXES, INT64_C(100000000), &is.card, &record, &from);
  must(trammel_identify(is.card, &identification));
  is.clock_hz = identification.clock_hz;
  must(trammel_open_stream(is.card, NULL));
  for (i = 0; i < PARTS; ++i) place_part(&is, &parts[i]);
  move_to(&is, &home, 200, 3000, 0, 0, 0);
  must(trammel_finish(is.card, NULL));
  must(trammel_set_watchdog(is.card, 0));
  must(trammel_read_place(is.card, &to));
  trammel_close(is.card);
  for (axis = 0; axis < AXES; ++axis) {
    CHECK(to.pulses[axis] - from.pulses[axis] == is.pulses[axis], "axis %u is not back", axis);
    CHECK(!simulated || pulses_until(&record, axis, UINT64_MAX) == is.pulses[axis], "axis %u: pulses at the pin", axis);
  }
  if (simulated) check_outputs(&record, is.clock_hz);
  printf("%zu parts placed\n", PARTS);
  free(record.steps);
  return failed_checks == 0 ? 0 : 1;
}
