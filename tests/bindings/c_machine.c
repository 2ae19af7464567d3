// The simulated machine, homing and places in mm through trammel_machine.h.
#include <math.h>

#include "check.h"
#include "trammel_machine.h"

#define NS_OF_SECOND INT64_C(1000000000)

static const trammel_simulation simulation = {4, 1000000};

static trammel_card* card_in_world(void) {
  trammel_card* card = NULL;
  DONE(trammel_open_in_world(&simulation, NULL, &card));
  return card;
}

static trammel_world* world_behind(trammel_card* card) {
  trammel_world* world = NULL;
  DONE(trammel_world_of_card(card, &world));
  return world;
}

static trammel_machine* first_machine(void) {
  trammel_machine* machine = NULL;
  DONE(trammel_load_machine(FIRST_MACHINE, &machine));
  return machine;
}

static trammel_world_state state_of(trammel_world* world) {
  trammel_world_state state;
  memset(&state, 0xFF, sizeof state);
  DONE(trammel_read_world(world, &state));
  return state;
}

// Null if there is no contact of this name.
static const trammel_world_contact* contact_in(const trammel_world_state* state, const char* name) {
  uint32_t n;
  for (n = 0; n < state->contact_count; ++n) {
    if (strcmp(state->contacts[n].name, name) == 0) return &state->contacts[n];
  }
  return NULL;
}

static bool is_pressed(trammel_world* world, const char* name) {
  const trammel_world_state state = state_of(world);
  const trammel_world_contact* contact = contact_in(&state, name);
  CHECK(contact != NULL);
  return contact != NULL && contact->pressed;
}

static void what_it_is_like(void) {
  trammel_card* card = card_in_world();
  trammel_world* world = world_behind(card);
  trammel_world_state state = state_of(world);
  const trammel_world_contact* contact;
  CHECK(state.axis_count == 4 && state.axes[0].letter == 'X' && state.axes[3].letter == 'E' && state.axes[0].powered);
  CHECK(state.time_s >= 0 && state.time_s < 1 && !state.emergency_stop);
  contact = contact_in(&state, "x_minus");
  CHECK(contact != NULL && contact->input == 0 && !contact->is_button && !contact->pressed);
  contact = contact_in(&state, "estop");
  CHECK(contact != NULL && contact->input == -1 && contact->is_button && !contact->pressed);
  DONE(trammel_press(world, "feed_hold", NULL, NS_OF_SECOND, &state));
  contact = contact_in(&state, "feed_hold");
  CHECK(contact != NULL && contact->pressed && contact->input == 6);
  CHECK(state.time_s >= 0.02);
  DONE(trammel_release(world, "feed_hold", NULL, NS_OF_SECOND, NULL));
  CHECK(!is_pressed(world, "feed_hold"));
  trammel_close(card);
  CHECK(state_of(world).axis_count == 4);  // the world outlives the card
  trammel_close_world(world);
  trammel_close_world(NULL);
}

// Starts a line along X at 40 mm/s; X of the default world has 80 pulses/mm.
static void start_x(trammel_card* card, double mm) {
  trammel_one_shot line;
  memset(&line, 0, sizeof line);
  line.pulses[0] = (int64_t)(mm * 80);
  line.duration_ns = (int64_t)(fabs(mm) / 40 * 1e9);
  DONE(trammel_start_line(card, &line, NULL));
}

static void a_button_in_mid_line(void) {
  trammel_card* card = card_in_world();
  trammel_world* world = world_behind(card);
  trammel_world_state state;
  double at;
  DONE(trammel_set_slew_time(card, 100000000));
  start_x(card, 60);
  FAILS(trammel_press(world, "estop", "X > 400", NS_OF_SECOND / 10, &state), TRAMMEL_TIMEOUT,
        "press estop when X > 400");
  CHECK(!is_pressed(world, "estop"));
  DONE(trammel_press(world, "estop", "X>20", 10 * NS_OF_SECOND, &state));
  at = state.axes[0].carriage_mm;
  CHECK(at > 20 && at < 21.5 && state.emergency_stop);
  FAILS(trammel_wait_until_idle(card, NS_OF_SECOND), TRAMMEL_FAULT, "EMERGENCY_STOP");
  DONE(trammel_wait_until_stopped(card, NS_OF_SECOND));
  DONE(trammel_simulated_wait(card, 1000000));
  state = state_of(world);
  CHECK(!state.axes[0].powered && fabs(state.axes[0].carriage_mm - state.axes[0].commanded_mm) < 1);
  DONE(trammel_release(world, "estop", NULL, NS_OF_SECOND, &state));
  CHECK(state.axes[0].powered && !state.emergency_stop);
  DONE(trammel_clear_faults(card));
  trammel_close_world(world);
  trammel_close(card);
}

static void bad_worlds(void) {
  trammel_card* card = (trammel_card*)&simulation;
  trammel_world* world = NULL;
  trammel_world_state state;
  FAILS(trammel_open_in_world(&simulation, "/nowhere.toml", &card), TRAMMEL_ARGUMENT, "/nowhere.toml");
  CHECK(card == NULL);
  FAILS(trammel_open_in_world(NULL, NULL, &card), TRAMMEL_ARGUMENT, "simulation is null");
  card = simulated_card();
  FAILS(trammel_world_of_card(card, &world), TRAMMEL_STATE, "no machine is simulated behind this card");
  trammel_close(card);
  FAILS(trammel_open_world("sim:", &world), TRAMMEL_ARGUMENT, "trammel serve --world");
  CHECK(world == NULL);
  FAILS(trammel_open_world(NULL, &world), TRAMMEL_ARGUMENT, "url is null");
  card = card_in_world();
  world = world_behind(card);
  FAILS(trammel_press(world, "x_minus", NULL, NS_OF_SECOND, NULL), TRAMMEL_ARGUMENT, "no such button: ");
  FAILS(trammel_press(world, "estop", "Q > 3", NS_OF_SECOND, NULL), TRAMMEL_ARGUMENT, "the world has no such axis");
  FAILS(trammel_press(world, "estop", "steps > 3", NS_OF_SECOND, NULL), TRAMMEL_ARGUMENT, "at served cards alone");
  FAILS(trammel_press(world, "estop", NULL, 0, NULL), TRAMMEL_ARGUMENT, "longest_ns");
  FAILS(trammel_press(world, NULL, NULL, NS_OF_SECOND, NULL), TRAMMEL_ARGUMENT, "button is null");
  FAILS(trammel_press(NULL, "estop", NULL, NS_OF_SECOND, NULL), TRAMMEL_ARGUMENT, "world is null");
  FAILS(trammel_read_world(world, NULL), TRAMMEL_ARGUMENT, "state is null");
  FAILS(trammel_read_world(NULL, &state), TRAMMEL_ARGUMENT, "world is null");
  CHECK(!is_pressed(world, "estop"));
  trammel_close_world(world);
  trammel_close(card);
}

static void count_lines(void* context, const char* text) {
  CHECK(strstr(text, "searches its switch at") != NULL || strlen(text) > 0);
  ++*(unsigned*)context;
}

static void homing(void) {
  trammel_card* card = card_in_world();
  trammel_world* world = world_behind(card);
  trammel_machine* machine = first_machine();
  trammel_homed_axis homed[TRAMMEL_MAX_AXES];
  trammel_home_options options = {count_lines, NULL};
  trammel_world_state state;
  trammel_place place;
  double at[TRAMMEL_MAX_AXES];
  unsigned lines = 0;
  uint32_t count = 0;
  uint32_t n;
  options.context = &lines;
  memset(homed, 0xFF, sizeof homed);
  DONE(trammel_home(card, machine, NULL, &options, homed, &count));
  CHECK(count == 3);
  CHECK(homed[0].letter == 'X');
  CHECK(lines >= 3);
  for (n = 0; n < count; ++n) CHECK(fabs(homed[n].edge - homed[n].search_edge) < 0.014 && homed[n].squared_by == 0);
  DONE(trammel_read_place(card, &place));
  CHECK(place.homed == 7);
  memset(at, 0xFF, sizeof at);
  DONE(trammel_read_coordinates(card, machine, at));
  for (n = 0; n < TRAMMEL_MAX_AXES; ++n) CHECK(fabs(at[n]) < 1e-9);
  state = state_of(world);
  CHECK(fabs(state.axes[0].carriage_mm + 98) < 0.1 && state.axes[0].lost == 0);
  trammel_free_machine(machine);
  trammel_close_world(world);
  trammel_close(card);
}

static void homing_that_fails(void) {
  trammel_card* card = card_in_world();
  trammel_machine* machine = first_machine();
  trammel_machine* plain = NULL;
  trammel_place place;
  uint32_t count = 7;
  DONE(trammel_change_machine(machine, "homing.x.search_distance=20"));
  FAILS(trammel_home(card, machine, "X", NULL, NULL, &count), TRAMMEL_HOMING,
        "X: its home switch at input 0 did not become active within 20 mm at 40 mm/s");
  CHECK(count == 7 && strcmp(trammel_result_name(TRAMMEL_HOMING), "TRAMMEL_HOMING") == 0);
  DONE(trammel_read_place(card, &place));
  CHECK(place.homed == 0);
  FAILS(trammel_home(card, machine, "XQ", NULL, NULL, NULL), TRAMMEL_ARGUMENT, "the machine has no axis Q");
  DONE(trammel_load_machine(NULL, &plain));
  FAILS(trammel_home(card, plain, "", NULL, NULL, NULL), TRAMMEL_ARGUMENT,
        "no axis of the machine file has a [homing]");
  FAILS(trammel_home(card, NULL, "", NULL, NULL, NULL), TRAMMEL_ARGUMENT, "machine is null");
  FAILS(trammel_home(NULL, machine, "", NULL, NULL, NULL), TRAMMEL_ARGUMENT, "card is null");
  DONE(trammel_set_hold(card, true));  // the time base is still slewing to 0
  FAILS(trammel_home(card, machine, "Y", NULL, NULL, NULL), TRAMMEL_HELD, "the card holds");
  trammel_free_machine(plain);
  trammel_free_machine(machine);
  trammel_close(card);
}

static void machines_and_places(void) {
  trammel_card* card = card_in_world();
  trammel_machine* machine = first_machine();
  trammel_machine* none = NULL;
  char letters[TRAMMEL_MAX_AXES + 1];
  const double way[TRAMMEL_MAX_AXES] = {1, -2.5, 0.00625};
  const double far_way[TRAMMEL_MAX_AXES] = {1e9};
  int64_t pulses[TRAMMEL_MAX_AXES];
  double at[TRAMMEL_MAX_AXES];
  FAILS(trammel_load_machine("/nowhere.toml", &none), TRAMMEL_ARGUMENT, "/nowhere.toml");
  CHECK(none == NULL);
  FAILS(trammel_change_machine(machine, "axis.x.steps_per_mm=0"), TRAMMEL_ARGUMENT, "steps_per_mm");
  FAILS(trammel_change_machine(machine, NULL), TRAMMEL_ARGUMENT, "entry is null");
  memset(letters, 'q', sizeof letters);
  DONE(trammel_machine_letters(machine, letters));
  CHECK(strcmp(letters, "XYZ") == 0);
  memset(pulses, 0xFF, sizeof pulses);
  DONE(trammel_pulses_of(machine, way, pulses));
  CHECK(pulses[0] == 80 && pulses[1] == -200 && pulses[2] == 1 && pulses[3] == 0 && pulses[7] == 0);
  FAILS(trammel_pulses_of(machine, far_way, pulses), TRAMMEL_ARGUMENT, "mm");
  FAILS(trammel_pulses_of(machine, way, NULL), TRAMMEL_ARGUMENT, "pulses is null");
  DONE(trammel_configure(card, machine));
  DONE(trammel_set_scales(card, 12345));
  DONE(trammel_set_place(card, 1, true, false));
  FAILS(trammel_read_coordinates(card, machine, at), TRAMMEL_STATE, "other scales");
  FAILS(trammel_home(card, machine, "X", NULL, NULL, NULL), TRAMMEL_STATE, "other scales");
  FAILS(trammel_read_coordinates(card, machine, NULL), TRAMMEL_ARGUMENT, "coordinates is null");
  trammel_free_machine(machine);
  trammel_free_machine(NULL);
  trammel_close(card);
}

void test_machine(void) {
  what_it_is_like();
  a_button_in_mid_line();
  bad_worlds();
  homing();
  homing_that_fails();
  machines_and_places();
}
