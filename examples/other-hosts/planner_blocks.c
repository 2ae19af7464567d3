/* Another host's planner drives the card: the card makes exactly the steps of the planner's finished blocks.

       planner_blocks [URL]         URL: of the card (docs/reference/card-url.md); default: a simulated card

   A block has the fields that planners of the Grbl family fill: steps and direction of each axis, entry speed,
   acceleration, programmed rate and length. Its exit speed is the entry speed of the next block. A block is finished
   when the planner will not change these speeds any more. A block becomes one LINE and up to three FEED pieces:
   acceleration, programmed rate, deceleration. If the card is simulated in this process, axis, direction and time of
   every step are checked. */
#include <math.h>
#include <string.h>

#include "other_host.h"

#define AXES 3

typedef struct planner_block {
  uint32_t steps[AXES];
  uint32_t step_event_count; /* largest element of `steps` */
  uint8_t direction_bits;    /* bit n: axis n moves in its negative direction */
  float entry_speed_sqr;     /* (mm/min)^2 */
  float max_entry_speed_sqr; /* limit of the entry speed, computed by the planner */
  float acceleration;        /* mm/min^2 */
  float programmed_rate;     /* mm/min */
  float millimeters;
} planner_block;

#define SQUARE(rate) ((float)(rate) * (float)(rate))
#define ACCELERATION 1800000.0f /* 500 mm/s^2 */
#define FASTEST 3000.0f         /* mm/min, highest programmed_rate of all blocks */

/* 80 steps/mm in X and Y, 400 in Z. Some blocks reach their programmed rate, some do not; one is shorter than 1 mm. */
static const planner_block program[] = {
    {{800, 0, 0}, 800, 0, 0, 0, ACCELERATION, 2400, 10},
    {{480, 640, 0}, 640, 0, SQUARE(1800), SQUARE(2000), ACCELERATION, 3000, 10},
    {{0, 24, 0}, 24, 0, SQUARE(2400), SQUARE(2400), ACCELERATION, 3000, 0.3f},
    {{240, 320, 0}, 320, 1, SQUARE(2200), SQUARE(2400), ACCELERATION, 2400, 5},
    {{0, 0, 1200}, 1200, 4, 0, 0, ACCELERATION, 600, 3},
    {{1040, 984, 1200}, 1200, 2, 0, 0, ACCELERATION, 3000, 18.1446f},
};
#define BLOCKS (sizeof program / sizeof *program)
/* Durations of the blocks in seconds, calculated by hand. */
static const double seconds[BLOCKS] = {0.2925, 0.2100, 0.0078, 0.1653, 0.3200, 0.4629};

/* The speeds of a block, and the distances at which the speed profile changes. */
typedef struct profile {
  double entry, peak, exit;      /* mm/s */
  double accelerated, braked_at; /* mm from the start of the block */
  double acceleration;           /* mm/s^2 */
  double length;                 /* mm */
} profile;

static profile profile_of(const planner_block* block, float exit_speed_sqr) {
  profile is;
  const double entry_sqr = block->entry_speed_sqr / 3600.0;
  const double exit_sqr = exit_speed_sqr / 3600.0;
  double peak_sqr;
  is.length = block->millimeters;
  is.acceleration = block->acceleration / 3600.0;
  peak_sqr = (entry_sqr + exit_sqr) / 2 + is.acceleration * is.length; /* where acceleration and deceleration meet */
  is.peak = fmin(block->programmed_rate / 60.0, sqrt(peak_sqr));
  is.entry = sqrt(entry_sqr);
  is.exit = sqrt(exit_sqr);
  is.accelerated = fmax(0, (is.peak * is.peak - entry_sqr) / (2 * is.acceleration));
  is.braked_at = fmax(is.accelerated, is.length - fmax(0, is.peak * is.peak - exit_sqr) / (2 * is.acceleration));
  return is;
}

/* Scale of feed ticks. All blocks use the same number of ticks per mm, chosen for one tick per two clocks at the
   highest speed. */
typedef struct tick_scale {
  uint32_t clock_hz;
  double ticks_per_mm;
  int64_t slew_time_ns;
} tick_scale;

static void put_piece(trammel_card* card, const tick_scale* scale, uint64_t ticks, double speed, double end_speed) {
  trammel_ramp ramp = {0};
  trammel_command feed = {0};
  if (ticks == 0) return;
  ramp.ticks = ticks;
  ramp.speed = speed * scale->ticks_per_mm;
  ramp.end_speed = end_speed * scale->ticks_per_mm;
  ramp.highest_speed = FASTEST / 60 * scale->ticks_per_mm;
  ramp.slew_time_ns = scale->slew_time_ns;
  feed.kind = TRAMMEL_FEED;
  must(trammel_feed_for_ramp(&ramp, scale->clock_hz, &feed.as.feed));
  must(trammel_put(card, &feed));
}

/* Waits while the card's queues are full, which limits the planner to the card's pace. */
static void put_block(trammel_card* card, const tick_scale* scale, const planner_block* block, float exit_speed_sqr) {
  const profile is = profile_of(block, exit_speed_sqr);
  const uint64_t accelerated = (uint64_t)llround(is.accelerated * scale->ticks_per_mm);
  const uint64_t braked_at = (uint64_t)llround(is.braked_at * scale->ticks_per_mm);
  trammel_command line = {0};
  unsigned axis;
  line.kind = TRAMMEL_LINE;
  line.as.line.ticks = (uint64_t)llround(is.length * scale->ticks_per_mm);
  for (axis = 0; axis < AXES; ++axis) {
    const int64_t steps = block->steps[axis];
    line.as.line.pulses[axis] = (block->direction_bits >> axis & 1) != 0 ? -steps : steps;
  }
  put_piece(card, scale, accelerated, is.entry, is.peak);
  put_piece(card, scale, braked_at - accelerated, is.peak, is.peak);
  put_piece(card, scale, line.as.line.ticks - braked_at, is.peak, is.exit);
  must(trammel_put(card, &line));
}

/* Time in seconds from the start of the block to `distance` in mm. */
static double time_at(const profile* is, double distance) {
  const double up = fmin(distance, is->accelerated);
  const double even = fmin(distance, is->braked_at) - up;
  const double down = distance - up - even;
  const double speed = sqrt(fmax(0, is->peak * is->peak - 2 * is->acceleration * down));
  double time = even / is->peak;
  if (up > 0) time += 2 * up / (is->entry + sqrt(is->entry * is->entry + 2 * is->acceleration * up));
  if (down > 0) time += 2 * down / (is->peak + speed);
  return time;
}

static float exit_speed_sqr_of(size_t block) { return block + 1 < BLOCKS ? program[block + 1].entry_speed_sqr : 0; }

/* Checks the steps of one block, from record->steps[*next] on: their number, their directions, and the time of each
   step of the axis with the most steps. Advances *next to the next block. Returns the largest error of time, in
   seconds. */
static double check_block(const pulses* record, size_t* next, size_t block, double begin, uint32_t clock_hz) {
  const planner_block* const is = &program[block];
  const profile speeds = profile_of(is, exit_speed_sqr_of(block));
  uint32_t made[AXES] = {0};
  double worst = 0;
  uint64_t command = 0;
  for (; *next < record->count; ++*next) {
    const trammel_step* const step = &record->steps[*next];
    if (step->at_pin) continue;
    if (command == 0) command = step->command;
    if (step->command != command) break;
    ++made[step->axis];
    CHECK((step->direction < 0) == ((is->direction_bits >> step->axis & 1) != 0), "block %zu: wrong way", block);
    if (is->steps[step->axis] == is->step_event_count) {
      const double share = (made[step->axis] - 0.5) / is->step_event_count;
      const double planned = begin + time_at(&speeds, share * speeds.length);
      worst = fmax(worst, fabs((double)step->cycle / clock_hz - planned));
    }
  }
  CHECK(memcmp(made, is->steps, sizeof made) == 0, "block %zu: %u %u %u steps", block, made[0], made[1], made[2]);
  return worst;
}

/* Times count from the first step, because it tells when the card started. The last tick before a stop comes early, by
   half of its duration at the low speed there. The errors from rounding to ticks and clocks are below 0.05 ms and 50
   clocks. */
static void check_pulses(const pulses* record, const tick_scale* scale) {
  profile is = profile_of(&program[0], exit_speed_sqr_of(0));
  const double at_rest = 1 / sqrt(is.acceleration * scale->ticks_per_mm);
  size_t next = 0;
  size_t block;
  double begin, worst;
  double allowed = 0.00005 + 50.0 / scale->clock_hz;
  CHECK(record->count > 0, "no steps");
  if (record->count == 0) return;
  begin =
      (double)record->steps[0].cycle / scale->clock_hz - time_at(&is, 0.5 / program[0].step_event_count * is.length);
  for (block = 0; block < BLOCKS; ++block) {
    is = profile_of(&program[block], exit_speed_sqr_of(block));
    if (is.exit == 0) allowed += 0.55 * at_rest;
    worst = check_block(record, &next, block, begin, scale->clock_hz);
    CHECK(worst <= allowed, "block %zu: a step %.2f ms off its time", block, worst * 1e3);
    printf("block %zu: steps at most %.2f ms off their times, %.2f ms allowed\n", block, worst * 1e3, allowed * 1e3);
    CHECK(fabs(time_at(&is, is.length) - seconds[block]) < 0.0001, "block %zu is planned wrongly", block);
    begin += time_at(&is, is.length);
  }
  CHECK(next == record->count || record->steps[next].at_pin, "steps beyond the last block");
}

int main(int argc, char** argv) {
  trammel_card* card = NULL;
  trammel_identification identification;
  trammel_place from, to;
  pulses record = {0};
  tick_scale scale = {0};
  int64_t sum[AXES] = {0};
  size_t block;
  unsigned axis;
  bool simulated;
  scale.slew_time_ns = INT64_C(200000000); /* 2 * fastest / acceleration: a hold adds half of the acceleration */
  simulated = open_card(argc > 1 ? argv[1] : "sim:", AXES, scale.slew_time_ns, &card, &record, &from);
  must(trammel_identify(card, &identification));
  scale.clock_hz = identification.clock_hz;
  scale.ticks_per_mm = floor(scale.clock_hz / 2.0 / (FASTEST / 60));
  must(trammel_open_stream(card, NULL));
  for (block = 0; block < BLOCKS; ++block) {
    put_block(card, &scale, &program[block], exit_speed_sqr_of(block));
    for (axis = 0; axis < AXES; ++axis) {
      const int64_t steps = program[block].steps[axis];
      sum[axis] += (program[block].direction_bits >> axis & 1) != 0 ? -steps : steps;
    }
  }
  must(trammel_finish(card, NULL));
  must(trammel_set_watchdog(card, 0));
  must(trammel_read_place(card, &to));
  trammel_close(card);
  for (axis = 0; axis < AXES; ++axis) {
    printf("axis %u: %ld to %ld\n", axis, (long)from.pulses[axis], (long)to.pulses[axis]);
    CHECK(to.pulses[axis] - from.pulses[axis] == sum[axis], "axis %u is not where the sum of its blocks is", axis);
    CHECK(!simulated || pulses_until(&record, axis, UINT64_MAX) == sum[axis], "axis %u: pulses at the pin", axis);
  }
  if (simulated) check_pulses(&record, &scale);
  free(record.steps);
  return failed_checks == 0 ? 0 : 1;
}
