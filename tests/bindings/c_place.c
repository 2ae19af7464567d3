// The machine's place through trammel.h: the place that the card keeps, the beginning of a program at this place, its
// loss, and setting it again.
#include "check.h"

#define ALL_AXES 0xF

static trammel_place place_of(trammel_card* card) {
  trammel_place place;
  memset(&place, 0xFF, sizeof place);
  DONE(trammel_read_place(card, &place));
  return place;
}

static void move(trammel_card* card, int64_t x, int64_t y) {
  trammel_one_shot line;
  memset(&line, 0, sizeof line);
  line.pulses[0] = x;
  line.pulses[1] = y;
  line.duration_ns = 10000000;
  DONE(trammel_run_line(card, &line, 1000000000, NULL));
}

// Axis 0 moves and is cut in motion.
static void cut_off(trammel_card* card) {
  trammel_one_shot line;
  memset(&line, 0, sizeof line);
  line.pulses[0] = 1000;
  line.duration_ns = 1000000000;
  DONE(trammel_start_line(card, &line, NULL));
  DONE(trammel_simulated_wait(card, 100000));
  FAILS(trammel_begin_at_place(card, 1, false, NULL), TRAMMEL_STATE, "the card moves");
  DONE(trammel_abort(card));
  DONE(trammel_simulated_wait(card, 1000));
}

// The first program sets machine zero at the present position. The next program continues from the place.
static void begins_at_the_place(void) {
  trammel_card* card = simulated_card();
  trammel_place place = place_of(card);
  CHECK(!place.first && place.scales == TRAMMEL_NO_SCALES && place.valid == 0 && place.pulses[0] == 0);
  move(card, 7, 0);
  CHECK(place_of(card).pulses[0] == 0 && place_of(card).machine_zero[0] == 0);
  DONE(trammel_begin_at_place(card, 3, false, &place));
  CHECK(place.first && place.scales == TRAMMEL_SCALES_IN_PULSES && place.valid == ALL_AXES && place.homed == 0);
  CHECK(place.machine_zero[0] == 7 && place.pulses[0] == 0 && place.keeps == 0);
  move(card, 20, -40);
  DONE(trammel_begin_at_place(card, 3, false, &place));
  CHECK(!place.first && place.pulses[0] == 20 && place.pulses[1] == -40 && place.machine_zero[0] == 7);
  DONE(trammel_simulated_reset(card));
  place = place_of(card);
  CHECK(place.scales == TRAMMEL_NO_SCALES && place.valid == 0 && place.machine_zero[0] == 0);
  trammel_close(card);
}

static void a_lost_place(void) {
  trammel_card* card = simulated_card();
  trammel_place place;
  DONE(trammel_begin_at_place(card, 1, false, NULL));
  cut_off(card);
  place = place_of(card);
  CHECK(place.valid == (ALL_AXES & ~1) && place.pulses[0] > 50);
  FAILS(trammel_begin_at_place(card, 3, false, NULL), TRAMMEL_STATE, "of axis 0 was lost");
  CHECK(place_of(card).valid == (ALL_AXES & ~1));
  DONE(trammel_begin_at_place(card, 2, false, NULL));  // only axis 1, whose place is valid
  DONE(trammel_begin_at_place(card, 3, true, &place));
  CHECK(place.valid == ALL_AXES && !place.first);
  DONE(trammel_set_keeps_place(card, 1));
  cut_off(card);
  place = place_of(card);
  CHECK(place.valid == ALL_AXES && place.keeps == 1);
  trammel_close(card);
}

// The calls that a homing makes, and a program with its own scales.
static void set_by_hand(void) {
  trammel_card* card = simulated_card();
  trammel_place place;
  move(card, 100, 0);
  DONE(trammel_begin_at_place(card, 1, false, NULL));
  DONE(trammel_set_place(card, 1, false, false));
  CHECK(place_of(card).valid == (ALL_AXES & ~1));
  DONE(trammel_set_machine_zero(card, 0, 100 - 25));  // the place is then 25
  DONE(trammel_set_place(card, 1, true, true));
  DONE(trammel_set_scales(card, 0xC0FFEE));
  place = place_of(card);
  CHECK(place.valid == ALL_AXES && place.homed == 1 && place.pulses[0] == 25 && place.scales == 0xC0FFEE);
  DONE(trammel_begin_at_place(card, 1, false, &place));
  CHECK(!place.first && place.scales == 0xC0FFEE && place.homed == 1);
  // The difference of counter and machine zero wraps to 32 bits.
  DONE(trammel_set_machine_zero(card, 0, INT32_MIN));
  CHECK(place_of(card).pulses[0] == INT32_MIN + 100);
  trammel_close(card);
}

static void bad_arguments(void) {
  trammel_card* card = simulated_card();
  FAILS(trammel_begin_at_place(card, 0x10, false, NULL), TRAMMEL_ARGUMENT, "the card has 4 axes");
  FAILS(trammel_set_place(card, 0x10, true, false), TRAMMEL_ARGUMENT, "the card has 4 axes");
  FAILS(trammel_set_place(card, 1, false, true), TRAMMEL_ARGUMENT, "has a valid place");
  FAILS(trammel_set_machine_zero(card, 4, 0), TRAMMEL_ARGUMENT, "the card has 4 axes");
  FAILS(trammel_set_keeps_place(card, 0x80), TRAMMEL_ARGUMENT, "the card has 4 axes");
  CHECK(place_of(card).scales == TRAMMEL_NO_SCALES && place_of(card).keeps == 0);
  trammel_close(card);
}

void test_place(void) {
  begins_at_the_place();
  a_lost_place();
  set_by_hand();
  bad_arguments();
}
