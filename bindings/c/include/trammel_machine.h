// Machines for trammel.h: a simulated machine behind a card's pins; homing and positions in mm from a machine file.
// Part of the same library; the conventions for errors and enumerations are the same.
//
// Units: mm, or degrees for A, B and C, in machine coordinates; mm/s; pulses where a comment says so.
//
// Thread-safety: only the thread that uses the card may use the trammel_world of a card in this process. The
// trammel_world of a served card may be used by one thread at a time, which need not be the thread that uses the card.
// A trammel_machine may be used by one thread at a time.
#ifndef TRAMMEL_MACHINE_H
#define TRAMMEL_MACHINE_H

#include "trammel.h"

#ifdef __cplusplus
extern "C" {
#endif

// ---- A simulated machine: carriages, switches, buttons (docs/user/world.md of the project) ----

#define TRAMMEL_MAX_CONTACTS 33  // contacts of a machine, at most: 32 inputs and the emergency stop's pin

// The machine behind a card.
typedef struct trammel_world trammel_world;

typedef struct trammel_world_axis {
  char letter;
  double carriage_mm;   // position of the carriage, from its position at the start
  double commanded_mm;  // position commanded by the card
  int64_t carriage;     // position of the carriage in pulses
  int64_t commanded;    // commanded position in pulses
  int64_t lost;         // pulses between the motor's position and its commanded position
  bool powered;         // false while the power is cut, and after the drive's alarm
} trammel_world_axis;

typedef struct trammel_world_contact {
  char name[64];   // UTF-8, truncated
  int32_t input;   // the card's input; -1: the emergency stop's pin
  bool is_button;  // true: a button; false: a switch, which a carriage presses
  bool pressed;
} trammel_world_contact;

typedef struct trammel_world_state {
  double time_s;  // card time since its start
  uint32_t axis_count;
  uint32_t contact_count;
  trammel_world_axis axes[TRAMMEL_MAX_AXES];
  trammel_world_contact
      contacts[TRAMMEL_MAX_CONTACTS];  // switches, then buttons; a drive's alarm is the button x_alarm
  uint32_t inputs;                     // levels at the card's pins, bit n: input n
  bool emergency_stop;                 // the emergency stop's pin is active
} trammel_world_state;

// Opens a simulated card, as trammel_open_simulated(), with a machine behind its pins. `world_file`: a path; null or
// "default": the built-in world, which fits examples/first-machine.toml of the project and has 4 axes.
// TRAMMEL_ARGUMENT, with file and line, for a file that cannot be read or has an invalid entry.
TRAMMEL_API trammel_result trammel_open_in_world(const trammel_simulation* simulation, const char* world_file,
                                                 trammel_card** card);
// The machine behind such a card; TRAMMEL_STATE for other cards. Close it with trammel_close_world(), before or after
// the card. It stays usable after its card is closed.
TRAMMEL_API trammel_result trammel_world_of_card(trammel_card* card, trammel_world** world);
// The machine behind a card of `trammel serve --world`; the card itself is not used. `url`: that of the card. Without
// its token, presses return TRAMMEL_ARGUMENT. TRAMMEL_LINK if the server cannot be reached or has no machine,
// TRAMMEL_ARGUMENT if the URL is not that of a server.
TRAMMEL_API trammel_result trammel_open_world(const char* url, trammel_world** world);
TRAMMEL_API void trammel_close_world(trammel_world* world);  // does nothing for null

TRAMMEL_API trammel_result trammel_read_world(trammel_world* world, trammel_world_state* state);
// Presses or releases a button, and returns the state 20 ms of card time later (`state` may be null).
//
// `when`: null for at once, else a condition that the call waits for. "X > 40" or "Z < -1.5" compares carriage_mm; for
// a card in this process it is checked 1,000 times per second of card time, and the card runs meanwhile. "steps > 2000"
// counts steps of the path, for served cards only. `longest_ns`, 1 or more: longest wait for the condition. For a card
// in this process it is card time and ends with TRAMMEL_TIMEOUT. For a served card it is real time and ends with
// TRAMMEL_LINK; the trammel_world is then unusable. In both cases the press is dropped. TRAMMEL_ARGUMENT, with the
// existing names, for an unknown button. trammel_set_interrupt() ends the wait with TRAMMEL_CANCELLED.
TRAMMEL_API trammel_result trammel_press(trammel_world* world, const char* button, const char* when, int64_t longest_ns,
                                         trammel_world_state* state);
TRAMMEL_API trammel_result trammel_release(trammel_world* world, const char* button, const char* when,
                                           int64_t longest_ns, trammel_world_state* state);

// ---- A machine file: scales, inputs, homing (docs/user/files.md and homing.md of the project) ----

typedef struct trammel_machine trammel_machine;

// Loads a machine file. `file`: a path; null or "default": the built-in machine. TRAMMEL_ARGUMENT, with file and line,
// for a file that cannot be read or is invalid. Free it with trammel_free_machine().
TRAMMEL_API trammel_result trammel_load_machine(const char* file, trammel_machine** machine);
// Changes an entry, as --set of the command does: "homing.x.search_distance=20". TRAMMEL_ARGUMENT, and no change, for
// an entry that the file must not have.
TRAMMEL_API trammel_result trammel_change_machine(trammel_machine* machine, const char* entry);
TRAMMEL_API void trammel_free_machine(trammel_machine* machine);  // does nothing for null
// Letters of the machine's axes, such as "XYZE", in the order of `coordinates` and `way` below.
TRAMMEL_API trammel_result trammel_machine_letters(const trammel_machine* machine, char letters[TRAMMEL_MAX_AXES + 1]);

// Writes the settings that `trammel run` writes before it moves: step times, slew, inputs, outputs, axes that keep
// their place. The card must be at rest. TRAMMEL_ARGUMENT for settings that the card does not support.
TRAMMEL_API trammel_result trammel_configure(trammel_card* card, const trammel_machine* machine);

typedef struct trammel_homed_axis {
  char letter;
  double search_edge;  // position of the switch's edge in the search, in the coordinates before homing
  double edge;         // position of the edge that defines the axis's place, in the same coordinates
  double squared_by;   // distance by which a gantry's second motor was moved, mm
} trammel_homed_axis;

typedef struct trammel_home_options {
  // Reports each step of homing as a line of text, in the thread of the call. May be null. Must not use the card.
  void (*say)(void* context, const char* text);
  void* context;
} trammel_home_options;

// Configures the card and homes the axes with these letters, such as "XY"; null or "": all axes that have a [homing].
// On success these axes count as homed and are at their final positions; `homed` (may be null: room for
// TRAMMEL_MAX_AXES) receives them, and `count` (may be null) their number. `options` may be null. An open stream is
// closed.
//
// TRAMMEL_HOMING, with axis, input and distance, if a switch is not found: then of the axes to home only those with
// lower sequence numbers count as homed, and the card is at rest. TRAMMEL_ARGUMENT for a machine file that does not fit
// the card, TRAMMEL_STATE for a place in other scales, TRAMMEL_HELD for a card that holds, TRAMMEL_FAULT for a stop,
// TRAMMEL_STOPPED by trammel_request_stop() and by an interrupt.
TRAMMEL_API trammel_result trammel_home(trammel_card* card, const trammel_machine* machine, const char* axes,
                                        const trammel_home_options* options, trammel_homed_axis* homed,
                                        uint32_t* count);

// Positions of the card's axes in machine coordinates, by axis of the machine: room for TRAMMEL_MAX_AXES. Zeros for
// further entries, and if no place was set since the card's reset. trammel_read_place() says which axes are valid and
// homed. TRAMMEL_STATE for a place in other scales than the machine's.
TRAMMEL_API trammel_result trammel_read_coordinates(trammel_card* card, const trammel_machine* machine,
                                                    double* coordinates);
// Converts a displacement in mm, by axis of the machine (TRAMMEL_MAX_AXES), to pulses of the card's axes (as many),
// each rounded. Up to 10^6 mm per axis.
TRAMMEL_API trammel_result trammel_pulses_of(const trammel_machine* machine, const double* way, int64_t* pulses);

#ifdef __cplusplus
}
#endif

#endif
