// Machines for trammel.h: a simulated machine behind a card's pins, and homing and places in mm by a machine file.
// In the same library; errors and enumerations as there.
//
// Units: mm, or degrees for A, B and C, in machine coordinates; mm/s; pulses where a comment says so.
//
// Thread-safety: a trammel_world of a card in this process is for the thread that uses the card; one of a served card
// is for one thread at a time, beside those that use the card. A trammel_machine is for one thread at a time.
#ifndef TRAMMEL_MACHINE_H
#define TRAMMEL_MACHINE_H

#include "trammel.h"

#ifdef __cplusplus
extern "C" {
#endif

// ---- A simulated machine: carriages, switches, buttons (docs/user/world.md of the project) ----

#define TRAMMEL_MAX_CONTACTS 33  // of a machine: 32 inputs and the emergency stop's pin

// The machine behind a card.
typedef struct trammel_world trammel_world;

typedef struct trammel_world_axis {
  char letter;
  double carriage_mm;   // where the carriage stands, from where it stood at the beginning
  double commanded_mm;  // what the card has made
  int64_t carriage;     // the same in pulses
  int64_t commanded;    //
  int64_t lost;         // pulses by which the motor is held beside its commanded place
  bool powered;         // not so while the power is cut, and after the drive's alarm
} trammel_world_axis;

typedef struct trammel_world_contact {
  char name[64];   // UTF-8, cut where it is longer
  int32_t input;   // of the card; -1: the emergency stop's pin
  bool is_button;  // else a switch, which a carriage presses
  bool pressed;
} trammel_world_contact;

typedef struct trammel_world_state {
  double time_s;  // of the card, since its start
  uint32_t axis_count;
  uint32_t contact_count;
  trammel_world_axis axes[TRAMMEL_MAX_AXES];
  trammel_world_contact
      contacts[TRAMMEL_MAX_CONTACTS];  // switches, then buttons; a drive's alarm is the button x_alarm
  uint32_t inputs;                     // levels at the card's pins, bit n: input n
  bool emergency_stop;                 // whether its pin says stop
} trammel_world_state;

// A simulated card, as trammel_open_simulated() makes it, with a machine behind its pins. `world_file`: a path; null or
// "default": the built-in one, which fits examples/first-machine.toml of the project and has 4 axes. TRAMMEL_ARGUMENT,
// with file and line, for a file that cannot be read or has a wrong entry.
TRAMMEL_API trammel_result trammel_open_in_world(const trammel_simulation* simulation, const char* world_file,
                                                 trammel_card** card);
// The machine behind such a card; TRAMMEL_STATE for others. To be closed, before or after the card: a machine whose
// card is closed goes on.
TRAMMEL_API trammel_result trammel_world_of_card(trammel_card* card, trammel_world** world);
// The machine behind a card of `trammel serve --world`; nothing of the card is used. `url` is the card's: without its
// token nothing can be pressed (TRAMMEL_ARGUMENT). TRAMMEL_LINK where the server cannot be reached or has no machine,
// TRAMMEL_ARGUMENT where the URL is none of a server.
TRAMMEL_API trammel_result trammel_open_world(const char* url, trammel_world** world);
TRAMMEL_API void trammel_close_world(trammel_world* world);  // null: nothing

TRAMMEL_API trammel_result trammel_read_world(trammel_world* world, trammel_world_state* state);
// Presses or releases a button, and gives the state 20 ms of the card's time later (`state` may be null).
// `when`: null for at once, else a condition that is waited for: "X > 40", "Z < -1.5" (carriage_mm; 1,000 looks a
// second of a card in this process, whose time passes meanwhile); "steps > 2000" of the path, at served cards alone.
// `longest_ns`: 1 or more; how long it may take to come, in card time (TRAMMEL_TIMEOUT) for a card in this process, in
// real time for a served one (TRAMMEL_LINK, and the trammel_world is of no use any more). The press is forgotten then.
// TRAMMEL_ARGUMENT, with the names that there are, for one that no button has. trammel_set_interrupt() ends the wait
// with TRAMMEL_CANCELLED.
TRAMMEL_API trammel_result trammel_press(trammel_world* world, const char* button, const char* when, int64_t longest_ns,
                                         trammel_world_state* state);
TRAMMEL_API trammel_result trammel_release(trammel_world* world, const char* button, const char* when,
                                           int64_t longest_ns, trammel_world_state* state);

// ---- A machine file: scales, inputs, homing (docs/user/files.md and homing.md of the project) ----

typedef struct trammel_machine trammel_machine;

// `file`: a path; null or "default": the built-in machine. TRAMMEL_ARGUMENT, with file and line, for what cannot be
// read or is wrong. To be freed.
TRAMMEL_API trammel_result trammel_load_machine(const char* file, trammel_machine** machine);
// Changes an entry, as --set of the command does: "homing.x.search_distance=20". TRAMMEL_ARGUMENT, and nothing has
// changed, for what the file may not have.
TRAMMEL_API trammel_result trammel_change_machine(trammel_machine* machine, const char* entry);
TRAMMEL_API void trammel_free_machine(trammel_machine* machine);  // null: nothing
// Letters of its axes, as "XYZE": the order of `coordinates` and `way` below.
TRAMMEL_API trammel_result trammel_machine_letters(const trammel_machine* machine, char letters[TRAMMEL_MAX_AXES + 1]);

// What `trammel run` writes to a card before it moves: step times, slew, inputs, outputs, which axes keep their place.
// The card must stand. TRAMMEL_ARGUMENT for what the card lacks.
TRAMMEL_API trammel_result trammel_configure(trammel_card* card, const trammel_machine* machine);

typedef struct trammel_homed_axis {
  char letter;
  double search_edge;  // where the switch's edge came in the search, in coordinates as they were before
  double edge;         // and the one that counts
  double squared_by;   // mm that a gantry's second motor was moved by
} trammel_homed_axis;

typedef struct trammel_home_options {
  // What is done now, a line each, in the thread of the call. May be null. Must not use the card.
  void (*say)(void* context, const char* text);
  void* context;
} trammel_home_options;

// Configures the card and homes the axes of these letters, "XY"; null or "": all that have a [homing]. On success they
// count as homed, stand at their final positions, and `homed` (may be null: room for TRAMMEL_MAX_AXES) has them, in
// `count` (may be null). `options` may be null. A stream that was open ends.
// TRAMMEL_HOMING, with axis, input and distance, where a switch is not found: of the axes that were to be homed those
// of lower sequence numbers count as homed, no others, and the card stands. TRAMMEL_ARGUMENT for a machine file that
// does not fit the card, TRAMMEL_STATE for a place in other scales, TRAMMEL_HELD for a card that holds, TRAMMEL_FAULT
// for a stop, TRAMMEL_STOPPED by trammel_request_stop() and an interrupt.
TRAMMEL_API trammel_result trammel_home(trammel_card* card, const trammel_machine* machine, const char* axes,
                                        const trammel_home_options* options, trammel_homed_axis* homed,
                                        uint32_t* count);

// Where the card's axes stand, in machine coordinates, by axis of the machine: room for TRAMMEL_MAX_AXES, zeros beyond
// and where no place was set since the card's reset. What of it is valid and homed is in trammel_read_place().
// TRAMMEL_STATE for a place in other scales than the machine's.
TRAMMEL_API trammel_result trammel_read_coordinates(trammel_card* card, const trammel_machine* machine,
                                                    double* coordinates);
// A way in mm, by axis of the machine (TRAMMEL_MAX_AXES), as pulses of the card's axes (as many), each rounded. Up to
// 10^6 mm an axis.
TRAMMEL_API trammel_result trammel_pulses_of(const trammel_machine* machine, const double* way, int64_t* pulses);

#ifdef __cplusplus
}
#endif

#endif
