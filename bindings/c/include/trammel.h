// Trammel's driver for C (C99), and for every language that can call C: a card opened, told to move, watched, stopped.
//
// Units: positions and ways in pulses; times in nanoseconds of card time (names end in _ns) or in clocks of the card;
// feed in ticks, as the card's commands have it (docs/reference/commands.md of the project).
//
// Errors: a function that can fail gives back a trammel_result, TRAMMEL_OK when it did all that it says. What it writes
// through a pointer counts only then. Nothing is thrown, nothing ends the program. Every pointer is looked at:
// a null where none is allowed is a TRAMMEL_ARGUMENT. trammel_last_error() says what went wrong, in words too.
//
// Enumerations come in as int32_t, so that a number that is none of them is an error and nothing worse.
//
// Thread-safety: one thread at a time uses a card, in its callbacks as well; several cards may be used by several
// threads at once. The trammel_request_... functions may be called from any thread, and from a signal handler, while
// another one is in a call that waits; not while or after the card is closed.
#ifndef TRAMMEL_H
#define TRAMMEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define TRAMMEL_API __attribute__((visibility("default")))
#else
#define TRAMMEL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define TRAMMEL_MAX_AXES 8
#define TRAMMEL_MAX_CAPTURES 4       // units of a card
#define TRAMMEL_CAPTURE_QUEUE 16     // captures that the card's queue holds
#define TRAMMEL_FULL_RATIO 0x10000u  // of the time base: every clock is enabled

// ---- Results ----

typedef enum trammel_result {
  TRAMMEL_OK = 0,
  TRAMMEL_ARGUMENT = 1,        // a value out of range, or a null pointer; nothing was done
  TRAMMEL_STATE = 2,           // not in the state that the card or its stream is in; the text says what to do first
  TRAMMEL_STOPPED = 3,         // a call that waited ended by trammel_request_stop(): at rest on the path, and empty
  TRAMMEL_TIMEOUT = 4,         // not there within the time allowed; nothing was aborted
  TRAMMEL_REFUSED = 5,         // the card refused an access or a command
  TRAMMEL_FAULT = 6,           // the card has stopped with a latched fault
  TRAMMEL_LINK = 7,            // the link failed: what was under way may have been made or not
  TRAMMEL_IDENTIFICATION = 8,  // what answers is no card that this driver knows
  TRAMMEL_CANCELLED = 9,       // a progress callback gave back false, or an interrupt ended the wait for a silent link
  TRAMMEL_MEMORY = 10,         // out of memory
  TRAMMEL_INTERNAL = 11,       // a defect of this library
  TRAMMEL_HELD = 12,           // the card stands in a hold that was there before the call: nothing would move
  TRAMMEL_HOMING = 13          // an axis was not homed; the text names axis, input and distance (trammel_machine.h)
} trammel_result;

// The last failure in this thread.
typedef struct trammel_error {
  trammel_result result;
  uint8_t reason;           // TRAMMEL_REFUSED: the card's reason, 0 where it did not say
  uint8_t command_number;   // TRAMMEL_REFUSED: of a stream command, mod 256
  uint32_t address;         // TRAMMEL_REFUSED: byte address of the access
  uint32_t faults;          // TRAMMEL_FAULT: the card's FAULT register
  uint32_t geometry_begun;  // TRAMMEL_STOPPED: paths and barriers begun since the stream was opened
  uint64_t waited;          // TRAMMEL_TIMEOUT: clocks
  char text[1024];          // one line, UTF-8, cut where it is longer
} trammel_error;

// Never null; result is TRAMMEL_OK while nothing has failed in this thread. Stands until the thread's next failure.
TRAMMEL_API const trammel_error* trammel_last_error(void);
// "TRAMMEL_ARGUMENT" and so on; "unknown" for another number.
TRAMMEL_API const char* trammel_result_name(int32_t result);
// "0.1.0".
TRAMMEL_API const char* trammel_version(void);

// ---- Interrupts ----

// From now on a call of this thread that waits asks `asked(context)` every 50 ms or so, trammel_open() too. Once it
// gives back true, a call that waits for motion stops the card on the path and ends with TRAMMEL_STOPPED; one that
// waits for a link that is silent, or for trammel_stop(), ends with TRAMMEL_CANCELLED. For a flag that a signal's
// handler sets, or a deadline. It must not use the card. Null: nothing ends a call, as at first.
TRAMMEL_API void trammel_set_interrupt(bool (*asked)(void* context), void* context);

// ---- Cards ----

// A connection to a card, with the stream of commands that a card has.
typedef struct trammel_card trammel_card;

// The golden model of the card, with all that can be built into one.
typedef struct trammel_simulation {
  unsigned axes;      // 1 .. 8
  uint32_t clock_hz;  // what the card says of itself
} trammel_simulation;

// One access to a register: a byte address below 0x1000, a multiple of 4.
typedef struct trammel_access {
  uint32_t address;
  uint32_t data;  // to write, or what was read
  bool write;
} trammel_access;

#define TRAMMEL_BUS_FAILED SIZE_MAX

// A way to a card of the caller's own. docs/reference/bus.md has the contract.
typedef struct trammel_bus {
  void* context;  // handed to each function
  // Makes accesses in order; gives back how many: fewer than `count` where the card refused the next one, or
  // TRAMMEL_BUS_FAILED when the link fails.
  size_t (*transfer)(void* context, trammel_access* accesses, size_t count);
  // Returns after at least so long. Null: the thread sleeps.
  void (*sleep)(void* context, int64_t time_ns);
  // Why the last transfer failed, for the error's text. May be null.
  const char* (*failure)(void* context);
  // Whether a refusal shows in transfer. Where it does not, the driver asks the card.
  bool reports_refusals;
} trammel_bus;

// Opens the card that a URL names (docs/reference/card-url.md of the project): "sim:?axes=4&clock=1000000" is a
// simulated one, others are "tcp://host:port?token=...", "serial:/dev/ttyUSB0", "spi:/dev/spidev0.0", "mmap:/dev/uio0".
// Reads who the card is; writes nothing but what begins the connection. TRAMMEL_LINK when nothing answers. On success
// *card is to be closed; else it is null.
TRAMMEL_API trammel_result trammel_open(const char* url, trammel_card** card);
TRAMMEL_API trammel_result trammel_open_simulated(const trammel_simulation* simulation, trammel_card** card);
// `bus` is copied; its context must outlive the card.
TRAMMEL_API trammel_result trammel_open_bus(const trammel_bus* bus, trammel_card** card);
// Leaves the card as it is: what it has, it makes. Null: nothing.
TRAMMEL_API void trammel_close(trammel_card* card);

typedef struct trammel_identification {
  uint16_t map_major;
  uint16_t map_minor;
  uint32_t commands_version;
  unsigned axes;            // 1 .. 8
  uint32_t clock_hz;        // Hz
  uint32_t engines;         // what is built in: bits as docs/reference/registers.md has them (Units and engines)
  uint32_t geometry_depth;  // of the queues, halfwords
  uint32_t feed_depth;
} trammel_identification;

// A unit that is built into the card, as its descriptor says (docs/reference/registers.md of the project, Units and
// engines).
typedef struct trammel_unit {
  uint8_t tag;
  uint8_t major;  // version
  uint8_t minor;
  uint8_t instances;
  uint8_t features;  // bits
  uint16_t address;  // byte address of the first instance's first register; 0 where it has none
  uint8_t words;     // that an instance uses
  uint8_t stride;    // words from one instance to the next; 0: all share the same registers
} trammel_unit;

// Raw accesses through the card's bus, unchecked: `made` is how many, fewer than `count` where the card refused the
// next one. What is written so, the driver does not know of.
TRAMMEL_API trammel_result trammel_transfer(trammel_card* card, trammel_access* accesses, size_t count, size_t* made);

// As read when the card was opened.
TRAMMEL_API trammel_result trammel_identify(const trammel_card* card, trammel_identification* identification);
// The same: the first `room` units into `units`, which may be null where `room` is 0; *count is how many there are.
TRAMMEL_API trammel_result trammel_identify_units(const trammel_card* card, trammel_unit* units, size_t room,
                                                  size_t* count);

typedef enum trammel_step_mode {
  TRAMMEL_STEP_DIRECTION = 0,
  TRAMMEL_UP_DOWN = 1,
  TRAMMEL_QUADRATURE = 2
} trammel_step_mode;

// Times of the motor driver's data sheet: the card keeps at least these, 0 .. 65535 clocks each.
typedef struct trammel_axis_settings {
  int64_t step_length_ns;      // the pulse
  int64_t step_space_ns;       // trailing edge to the next leading edge
  int64_t direction_setup_ns;  // direction stable before the leading edge
  int64_t direction_hold_ns;   // and after the trailing edge
  int32_t mode;                // a trammel_step_mode
  bool invert_first;           // pin STEP, UP or A
  bool invert_second;          // pin DIR, DOWN or B
} trammel_axis_settings;

// Only while the axis stands.
TRAMMEL_API trammel_result trammel_configure_axis(trammel_card* card, unsigned axis,
                                                  const trammel_axis_settings* settings);

// ---- State ----

// The STATUS register.
typedef struct trammel_status {
  bool busy;          // something runs or is queued
  bool direct;        // a one-shot line runs
  bool path_active;   // a path is under way
  bool feed_active;   // a feed piece is under way
  bool held;          // the time base's ratio is 0
  bool ended;         // END was reached
  bool faulted;       // FAULT is not 0
  bool refused;       // REFUSAL is not 0
  bool snapshot;      // a snapshot is under way
  bool incomplete;    // the stream stands inside a command
  bool stopping;      // on its way to a stop: on a ramp, or the last pulses are made
  bool geometry_low;  // fewer halfwords queued than the queue's watermark
  bool feed_low;
  bool probed;        // a probe has tripped
  bool probe_missed;  // probing paths ended without an edge
  bool waiting;       // for an input
  bool underrun;      // the time base is held because the queues run dry
  bool stale;         // position streaming goes on without a new period
  bool button_hold;   // the feed hold button holds, until cycle start
  bool enabled;       // the drives are (trammel_set_enable_sequence())
  bool enable_waits;  // motion waits for them
  // At a ratio of 0 or stopped by a fault, for 31 clocks: each tick taken has made its steps, each step its pulse.
  bool settled;
} trammel_status;

// State of one clock.
typedef struct trammel_snapshot {
  uint64_t time;  // clocks since reset
  trammel_status status;
  uint32_t faults;
  uint32_t rate;            // 2^-32 feed ticks an enabled clock
  uint32_t ratio;           // 2^-16, of the time base
  uint32_t geometry_begun;  // commands begun from the geometry queue since the last cut
  uint32_t feed_begun;
  int32_t position[TRAMMEL_MAX_AXES];  // pulses, wrapping; 0 for axes that the card lacks
} trammel_snapshot;

TRAMMEL_API trammel_result trammel_read_status(trammel_card* card, trammel_status* status);
TRAMMEL_API trammel_result trammel_read_snapshot(trammel_card* card, trammel_snapshot* snapshot);
// What the first cause of the present or last fault latched; zeros if there was none.
TRAMMEL_API trammel_result trammel_read_stop_snapshot(trammel_card* card, trammel_snapshot* snapshot);
// `timeout_ns`: card time in which it was not held, stretched where the ratio is below 1. TRAMMEL_FAULT once it is
// faulted, TRAMMEL_HELD where it stands in a hold that this handle has not set, TRAMMEL_STATE if it was reset.
TRAMMEL_API trammel_result trammel_wait_until_idle(trammel_card* card, int64_t timeout_ns);

// Where the last stop has left the card, latched before it dropped anything: a fault's when every pulse has come out,
// an abort's in its own clock.
typedef struct trammel_rest {
  uint64_t time;  // clocks since reset; 0: no stop since then
  trammel_status status;
  uint32_t faults;
  uint32_t geometry_begun;  // commands begun from the geometry queue since the cut before
  uint32_t feed_begun;
  // Ticks that the command begun last has not taken of its N, 40 bits (a one-shot line: enabled clocks of its length);
  // 0 where no path was under way, and where it is not exact.
  uint64_t ticks_left;
  int32_t position[TRAMMEL_MAX_AXES];  // pulses, wrapping; 0 for axes that the card lacks
  bool exact;                          // they are those of all ticks taken; not so after an abort in motion
} trammel_rest;

// TRAMMEL_STATE while the card is on its way to a stop, TRAMMEL_ARGUMENT where its map is older than 3.4.
TRAMMEL_API trammel_result trammel_read_rest(trammel_card* card, trammel_rest* rest);
// Until a stop under way (status.stopping) has ended; TRAMMEL_TIMEOUT `margin_ns` (card time) after the longest ramp.
TRAMMEL_API trammel_result trammel_wait_until_stopped(trammel_card* card, int64_t margin_ns);

// Bits of FAULT, of cards with the parts that bring them: of masks of faults here. Bits 0 to 7 are step faults of the
// axes 0 to 7: a step came too early for too long.
typedef enum trammel_fault {
  TRAMMEL_FAULT_STEPS = 0xFF,              // of any axis
  TRAMMEL_FAULT_TICK_MISMATCH = 1 << 8,    // ticks of feed and geometry did not match at a barrier
  TRAMMEL_FAULT_PATH_INCOMPLETE = 1 << 9,  // a path did not end at its end point
  TRAMMEL_FAULT_MISSING_PERIOD = 1 << 10,  // position streaming got no new period in time
  TRAMMEL_FAULT_LIMIT = 1 << 11,           // a step into a limit switch
  TRAMMEL_FAULT_EMERGENCY_STOP = 1 << 12,  // stays as long as the pin is active
  TRAMMEL_FAULT_DRIVE_FAULT = 1 << 13,     // stays as long as the drive reports it
  TRAMMEL_FAULT_WATCHDOG = 1 << 14,        // the program was silent for too long
  TRAMMEL_FAULT_LINK_LOSS = 1 << 15,       // none of the program's accesses came
  TRAMMEL_FAULT_SOFT_LIMIT = 1 << 16,      // a step beyond a soft limit
  TRAMMEL_FAULT_PROBE = 1 << 17,           // the probe became active outside probing
  TRAMMEL_FAULT_TOOL_SETTER = 1 << 18      // the tool setter's switch became active in a move
} trammel_fault;

// FAULT, 0 if there is none.
TRAMMEL_API trammel_result trammel_read_faults(trammel_card* card, uint32_t* faults);
// Nothing moves by it; the stream begins anew (trammel_restart_stream()). On a fault's ramp it waits for the end first,
// as trammel_wait_until_stopped() with a second; where that fails the faults stay. So do the fault of a drive that
// still reports it, and that of an emergency stop whose button is pressed: TRAMMEL_OK all the same.
TRAMMEL_API trammel_result trammel_clear_faults(trammel_card* card);
// The card stops by itself, FAULT saying why, when this program is silent for `time_ns`; 0: never. Calls that wait, and
// streams, keep it from stopping; set 0 when the motion is over. Longer than 4/3 of the time in which the link may
// recover; up to 65,535 * 65,536 clocks.
TRAMMEL_API trammel_result trammel_set_watchdog(trammel_card* card, int64_t time_ns);
// The names of the bits, for messages: at most `size` bytes with the final 0.
TRAMMEL_API trammel_result trammel_describe_faults(uint32_t faults, char* text, size_t size);
// Likewise of the faults that stand, with the axes and sides of limits: "LIMIT (axis 0 plus)"; "none".
TRAMMEL_API trammel_result trammel_read_fault_text(trammel_card* card, char* text, size_t size);

// Of a card with path commands, bit n: input n after its polarity, output n.
TRAMMEL_API trammel_result trammel_read_inputs(trammel_card* card, uint32_t* levels);
TRAMMEL_API trammel_result trammel_read_outputs(trammel_card* card, uint16_t* levels);
TRAMMEL_API trammel_result trammel_set_input_polarity(trammel_card* card, uint32_t inverted);
// Levels that the outputs in `change` take at an abort and at a fault.
TRAMMEL_API trammel_result trammel_set_output_safe(trammel_card* card, uint16_t levels, uint16_t change);
// The same in the clock in which a fault is latched, at an emergency stop without a clock, and at an abort: a laser.
// They go before the others, and stay until the stop is over and the fault is cleared. TRAMMEL_ARGUMENT where the
// card's map is older than 3.5.
TRAMMEL_API trammel_result trammel_set_output_safe_cause(trammel_card* card, uint16_t levels, uint16_t change);
// MARKs passed since reset, and what the last one latched. Either pointer may be null.
TRAMMEL_API trammel_result trammel_read_marks(trammel_card* card, uint32_t* marks, trammel_snapshot* last);

// ---- Machine inputs: filters, roles, stops ----
//
// Of cards with the engine machine_inputs; TRAMMEL_ARGUMENT on others, and for inputs and axes that the card lacks.
// Masks of inputs: bit n is input n. Masks of axes: bit n is axis n.
//
// Write polarity and filters before roles: an input at a wrong polarity is active, and a drive's fault stops at once.

// What an input is for. An input may have several roles, a role several inputs.
typedef enum trammel_role {
  // Of these each axis has one.
  TRAMMEL_ROLE_LIMIT_MINUS = 0,
  TRAMMEL_ROLE_LIMIT_PLUS = 1,
  TRAMMEL_ROLE_HOME = 2,
  TRAMMEL_ROLE_INDEX = 3,
  TRAMMEL_ROLE_DRIVE_FAULT = 4,
  TRAMMEL_ROLE_IN_POSITION = 5,
  // And of these the card has one: `axis` is 0.
  TRAMMEL_ROLE_PROBE = 48,
  TRAMMEL_ROLE_TOOL_SETTER = 49,
  TRAMMEL_ROLE_FEED_HOLD = 50,
  TRAMMEL_ROLE_CYCLE_START = 51,
  TRAMMEL_ROLE_SPINDLE_AT_SPEED = 52
} trammel_role;

// Roles that are active now.
typedef struct trammel_active_roles {
  uint8_t limit_minus;  // masks of axes
  uint8_t limit_plus;
  uint8_t drive_fault;
  bool feed_hold;  // the button is pressed; whether it holds: trammel_status.button_hold
  bool cycle_start;
  bool tool_setter;
  bool probe;
} trammel_active_roles;

// Which limits and drives brought the fault that stands: masks of axes.
typedef struct trammel_limit_state {
  uint8_t minus;
  uint8_t plus;
  uint8_t drive_fault;
  // With TRAMMEL_FAULT_SOFT_LIMIT: the number of the axis that brought it, and whether at its positive end.
  uint8_t soft_axis;
  bool soft_plus;
} trammel_limit_state;

// How inputs stop the card. A struct of zeros: limits and drives stop at once, the probe and the tool setter do not.
typedef struct trammel_input_stops {
  uint8_t any_step;  // while a limit of any of these axes is active, every step of them is one into it (CoreXY)
  uint8_t shared;    // one switch serves both ends of these axes
  bool probe;        // the probe outside probing stops the card
  bool tool_setter;  // the tool setter does
  // On a ramp; else at once.
  bool limit_ramps;
  bool drive_fault_ramps;
  bool probe_ramps;
  bool tool_setter_ramps;
} trammel_input_stops;

// How many the card has, of any card with path commands; either pointer may be null.
TRAMMEL_API trammel_result trammel_count_ports(trammel_card* card, unsigned* inputs, unsigned* outputs);
// Levels before the filters; trammel_read_inputs() has those behind them.
TRAMMEL_API trammel_result trammel_read_raw_inputs(trammel_card* card, uint32_t* levels);
// A level that lasts at most `time_ns` does not pass; one that lasts 64 clocks more than that, rounded up to 64 clocks,
// does. 0: no filter; at most 65,535 * 64 clocks. It is read back as rounded.
TRAMMEL_API trammel_result trammel_set_input_filter(trammel_card* card, unsigned input, int64_t time_ns);
TRAMMEL_API trammel_result trammel_read_input_filter(trammel_card* card, unsigned input, int64_t* time_ns);
// Which inputs have the role (a trammel_role): it is active while one of them is. 0: none has it.
TRAMMEL_API trammel_result trammel_set_role(trammel_card* card, int32_t role, unsigned axis, uint32_t inputs);
TRAMMEL_API trammel_result trammel_read_role(trammel_card* card, int32_t role, unsigned axis, uint32_t* inputs);
// "limit minus of axis 0", "feed hold": at most `size` bytes with the final 0.
TRAMMEL_API trammel_result trammel_role_name(int32_t role, unsigned axis, char* text, size_t size);
TRAMMEL_API trammel_result trammel_read_roles(trammel_card* card, trammel_active_roles* roles);
TRAMMEL_API trammel_result trammel_read_limit_state(trammel_card* card, trammel_limit_state* state);
TRAMMEL_API trammel_result trammel_set_input_stops(trammel_card* card, const trammel_input_stops* stops);
// Steps into an active limit that the axis may make on a ramp; one more stops at once. 0 .. 65535.
TRAMMEL_API trammel_result trammel_set_overtravel(trammel_card* card, unsigned axis, uint32_t steps);
// Limits that are active now and stop nothing until they are released: masks of axes.
TRAMMEL_API trammel_result trammel_override_limits(trammel_card* card, uint8_t minus, uint8_t plus);

// ---- Captures of inputs' edges ----
//
// Time and positions of an edge, as they were at the pin: however long the input's filter is, which only confirms the
// edge or withdraws it. Of cards with the unit captures; TRAMMEL_ARGUMENT for units and inputs that the card lacks.

// What a unit watches for. With neither edge it watches for none.
typedef struct trammel_capture_select {
  unsigned input;
  bool to_active;    // edges to the active level, after polarity
  bool to_inactive;  //
  bool continuous;   // the unit goes on after each capture; else it takes one
  bool queue;        // captures go into the card's queue at once; none stands with the unit
} trammel_capture_select;

typedef struct trammel_capture_state {
  bool pending;  // an edge has come, and is not confirmed, withdrawn or written yet
  bool valid;    // a capture stands
  bool overrun;  // a confirmed edge was lost, since a capture stood when it came
  bool active;   // the level that the captured edge led to
} trammel_capture_state;

typedef struct trammel_capture_states {
  trammel_capture_state units[TRAMMEL_MAX_CAPTURES];  // zeros for units that the card lacks
  uint16_t snapshots;                                 // taken for captures, withdrawn ones too; counts modulo 2^16
} trammel_capture_states;

typedef struct trammel_capture {
  trammel_snapshot at;  // of the edge
  bool active;          // the level that it led to
  bool overrun;         // further edges were lost behind it
} trammel_capture;

typedef struct trammel_capture_queue {
  unsigned captures;  // in it, 0 to TRAMMEL_CAPTURE_QUEUE
  uint16_t lost;      // since reset, because it was full; counts modulo 2^16
} trammel_capture_queue;

typedef struct trammel_queued_capture {
  trammel_snapshot at;  // of the edge
  unsigned unit;
  bool active;  // the level that the edge led to
} trammel_queued_capture;

// 0 on a card without captures.
TRAMMEL_API trammel_result trammel_count_captures(const trammel_card* card, unsigned* units);
// The unit begins anew, and drops what it had. An edge counts after its input has been quiet, at the level before it,
// for a whole filter length; bounces behind the first touch belong to it.
TRAMMEL_API trammel_result trammel_select_capture(trammel_card* card, unsigned unit,
                                                  const trammel_capture_select* select);
TRAMMEL_API trammel_result trammel_stop_capture(trammel_card* card, unsigned unit);
TRAMMEL_API trammel_result trammel_read_captures(trammel_card* card, trammel_capture_states* states);
// The capture that stands, which is cleared with it. `taken`: whether there was one; else `capture` stays as it was.
TRAMMEL_API trammel_result trammel_take_capture(trammel_card* card, unsigned unit, trammel_capture* capture,
                                                bool* taken);
// The same, as soon as there is one. TRAMMEL_TIMEOUT after `timeout_ns` of card time, TRAMMEL_CANCELLED by
// trammel_set_interrupt(): the unit goes on watching either way. The trammel_request_... functions do not end it.
TRAMMEL_API trammel_result trammel_wait_for_capture(trammel_card* card, unsigned unit, int64_t timeout_ns,
                                                    trammel_capture* capture);
// The overruns that trammel_read_captures() shows begin anew, of the units of the mask, with what stands with them.
TRAMMEL_API trammel_result trammel_clear_captures(trammel_card* card, unsigned units);

// The queue of captures, of units that were selected with `queue`, in the order in which their filters passed. What
// does not fit is lost and counted; trammel_read_captures() shows the overrun of the unit. TRAMMEL_ARGUMENT on a card
// without a queue, but for the first of these functions.
TRAMMEL_API trammel_result trammel_has_capture_queue(const trammel_card* card, bool* has);
TRAMMEL_API trammel_result trammel_read_capture_queue(trammel_card* card, trammel_capture_queue* queue);
// Those that were in it at the call, the oldest first, which leave it. `captures` has room for TRAMMEL_CAPTURE_QUEUE of
// them, `count` says how many there were. One program at a time.
TRAMMEL_API trammel_result trammel_take_queued_captures(trammel_card* card, trammel_queued_capture* captures,
                                                        unsigned* count);

// ---- Soft limits in the card ----
//
// Positions, ends included, that an axis may go to: in pulses as the card counts them (trammel_snapshot.position),
// modulo 2^32. The last guard, behind a program that does not order such a move. A pulse further out stops the card
// (TRAMMEL_FAULT_SOFT_LIMIT); pulses back are free. A stop on a ramp ends beyond the end by the ramp's way.
//
// Of cards with the engine soft_limits; TRAMMEL_ARGUMENT on others.

typedef struct trammel_soft_range {
  bool limited;  // false: this axis has none, whatever the ends are
  int32_t minus;
  int32_t plus;
} trammel_soft_range;

TRAMMEL_API trammel_result trammel_has_soft_limits(const trammel_card* card, bool* has);
// By axis: the first `count` of `ranges`; the axes behind them have none then. A `count` of 0, where `ranges` may be
// null, switches all off. While the axes stand; anew when a position gets another meaning. TRAMMEL_ARGUMENT for more
// ranges than the card has axes, and for a plus below its minus.
TRAMMEL_API trammel_result trammel_set_soft_limits(trammel_card* card, const trammel_soft_range* ranges, size_t count);
// `ranges`: TRAMMEL_MAX_AXES of them; none is limited for axes that the card lacks.
TRAMMEL_API trammel_result trammel_read_soft_limits(trammel_card* card, trammel_soft_range* ranges);
// On a ramp, as after a reset, or at once.
TRAMMEL_API trammel_result trammel_set_soft_limit_ramps(trammel_card* card, bool ramp);

// ---- Drives: enable, brake, charge pump ----
//
// Of cards with the engine enables; TRAMMEL_ARGUMENT on others, for outputs and axes that the card lacks, and for times
// that it does not take. Nothing is enabled by a reset, a new program or trammel_clear_faults(). The state is in
// trammel_status: `enabled`, `enable_waits`.

// Outputs that follow the drives or the card, bit n: output n. Each stands at its idle level (the strap output_idle_i)
// and at the other while it is active; commands and safe levels do not change it. An output has one role.
typedef struct trammel_output_roles {
  uint16_t enable;       // active while the drives are enabled
  uint16_t brake;        // active while the brake is released
  uint16_t charge_pump;  // a square wave while the card is healthy
  uint16_t healthy;      // active while the card is healthy
} trammel_output_roles;

// One sequence for the drives of all axes that it names. Times are rounded up to 4,096 clocks of the card, the idle
// time to 2^20; each may be as long as 65,535 of these.
typedef struct trammel_enable_sequence {
  uint8_t axes;                  // that it serves; 0: none, motion waits for nothing
  bool manual;                   // motion waits for trammel_enable(); else it enables the drives
  int64_t brake_release_ns;      // from the enable to the release of the brake
  int64_t before_first_step_ns;  // from there on
  int64_t after_last_step_ns;    // until the brake is set, when the drives are to be disabled
  int64_t brake_set_ns;          // from there to the disable
  int64_t idle_ns;               // without motion, until they are disabled; 0: never
  // Faults (bits of trammel_fault) that disable them at rest; the emergency stop does at once.
  uint32_t disable_causes;
} trammel_enable_sequence;

// When the card is healthy.
typedef struct trammel_health {
  uint32_t causes;              // with none of these faults (bits of trammel_fault)
  bool needs_watchdog;          // and while the watchdog runs
  int64_t pump_half_period_ns;  // of the charge pump's wave, rounded up to clocks, up to 65,535; 0: no wave
} trammel_health;

TRAMMEL_API trammel_result trammel_set_output_roles(trammel_card* card, const trammel_output_roles* roles);
// A new mask of axes counts once the card rests.
TRAMMEL_API trammel_result trammel_set_enable_sequence(trammel_card* card, const trammel_enable_sequence* sequence);
// The program's order: the drives are enabled now, and stay so until it is taken back. Motion needs none unless
// trammel_enable_sequence.manual says so.
TRAMMEL_API trammel_result trammel_enable(trammel_card* card, bool on);
TRAMMEL_API trammel_result trammel_set_health(trammel_card* card, const trammel_health* health);

// ---- Emergency stop ----
//
// **Not a safety function**: the button must take the drives' energy away by itself (docs/user/outputs.md of the
// project). The pin tells the card, which stops and drops its path. Of cards with the engine emergency_stop;
// TRAMMEL_ARGUMENT on others.

TRAMMEL_API trammel_result trammel_has_emergency_stop(const trammel_card* card, bool* has);
// Whether one stands: the button was pressed, however briefly. trammel_clear_faults() clears it once the button is
// released; until then it stands, so read it anew behind that.
TRAMMEL_API trammel_result trammel_read_emergency_stop(trammel_card* card, bool* stopped);
// How it stops the axes, at once after a reset; outputs that are safe at the cause change at once either way. A card
// with an enable sequence disables its drives then, and stops at once either way.
TRAMMEL_API trammel_result trammel_set_emergency_stop_ramps(trammel_card* card, bool ramp);

// ---- The machine's place ----
//
// What the card keeps for whoever uses it next: machine zero, and for each axis whether its place is valid and whether
// it was homed. It outlives this program, a stop on the path and a lost link. A reset of the card clears all of it. An
// axis loses its place by a fault of its drive, and by a stop at once while it moves: an abort before the card is at
// rest, or a fault without a ramp. Masks: bit n is axis n. None of it keeps a card from moving: a program that is about
// to move it calls trammel_begin_at_place() first.
//
// Cards with the map 3.3 or newer; TRAMMEL_ARGUMENT on others, and for axes that the card lacks.

#define TRAMMEL_NO_SCALES 0u         // nobody has set a place since the card's reset
#define TRAMMEL_SCALES_IN_PULSES 1u  // a machine zero, set by a program that counts in pulses

typedef struct trammel_place {
  bool first;       // trammel_begin_at_place() has set machine zero here: nobody had since the card's reset
  uint8_t valid;    // these stand where `pulses` says
  uint8_t homed;    // and their machine zero was found at a reference; a homed axis is valid
  uint8_t keeps;    // these keep their place through a stop at once
  uint32_t scales;  // hash of the scales that coordinates count in, or one of the two values above
  int32_t machine_zero[TRAMMEL_MAX_AXES];  // position of the axis at machine zero, pulses, wrapping
  int32_t pulses[TRAMMEL_MAX_AXES];        // from machine zero to where the axis stands; 0 with TRAMMEL_NO_SCALES
} trammel_place;

TRAMMEL_API trammel_result trammel_read_place(trammel_card* card, trammel_place* place);
// Before a program in pulses moves the axes in `axes`: where nobody has set a place since the card's reset, machine
// zero is set where the card stands, and all axes are valid; else all stays as it is. TRAMMEL_STATE, and nothing is
// written, where the card is busy, and where one of `axes` has lost its place. With `trust` such an axis is valid
// again: for who knows that no step was lost. `place` (may be null): as the card has it then.
TRAMMEL_API trammel_result trammel_begin_at_place(trammel_card* card, uint8_t axes, bool trust, trammel_place* place);
// The parts of it. To set machine zero of an axis that stands: trammel_begin_at_place() without that axis in `axes`, so
// that there is a place; trammel_set_place() with `valid` false, so that a program that ends in between leaves a lost
// place; trammel_set_machine_zero(); trammel_set_place() with `valid` true. trammel_set_place() is for axes that stand
// alone: it would hide a loss that the host has not seen. TRAMMEL_ARGUMENT for `homed` without `valid`.
TRAMMEL_API trammel_result trammel_set_place(trammel_card* card, uint8_t axes, bool valid, bool homed);
TRAMMEL_API trammel_result trammel_set_machine_zero(trammel_card* card, unsigned axis, int32_t pulses);
// The `trammel` command refuses a place in scales that are not its machine file's; it takes one in pulses over.
TRAMMEL_API trammel_result trammel_set_scales(trammel_card* card, uint32_t hash);
// All axes that keep their place through a stop at once, since their mechanism cannot lose steps by it.
TRAMMEL_API trammel_result trammel_set_keeps_place(trammel_card* card, uint8_t axes);

// ---- Hold, override, stop, abort ----

// Which ratio of the time base a piece of feed runs at: `piece_class` of the functions here.
typedef enum trammel_piece_class {
  TRAMMEL_CLASS_FEED = 0,
  TRAMMEL_CLASS_RAPID = 1,
  TRAMMEL_CLASS_FIXED = 2  // a hold waits for the end of these
} trammel_piece_class;

// Slews to rest on the path, or goes on. Nothing is lost.
TRAMMEL_API trammel_result trammel_set_hold(trammel_card* card, bool hold);
// Share of enabled clocks, 0 .. TRAMMEL_FULL_RATIO. A card without classes has that of feed alone.
TRAMMEL_API trammel_result trammel_set_ratio(trammel_card* card, int32_t piece_class, uint32_t ratio);
// The ratio `percent` / `max_percent`; the latter is the largest override that programs are planned for.
TRAMMEL_API trammel_result trammel_set_override(trammel_card* card, int32_t piece_class, double percent,
                                                double max_percent);
// Time that the ratio takes from 0 to full; up to 2^30 clocks.
TRAMMEL_API trammel_result trammel_set_slew_time(trammel_card* card, int64_t full_scale_ns);
// Drops what is queued and stops at once; positions stay, faults stay latched. The stream begins anew.
TRAMMEL_API trammel_result trammel_abort(trammel_card* card);
// A hold, and at rest an abort: no pulse comes after it. `snapshot` (may be null) has the position.
TRAMMEL_API trammel_result trammel_stop(trammel_card* card, int64_t margin_ns, trammel_snapshot* snapshot);

// Takes over a card that another host has left: ends a hold that stands, and drops what is left of a path on which the
// card holds; `dropped` (may be null) says whether there was any. TRAMMEL_STATE, and nothing changes, where the card
// moves and does not hold.
TRAMMEL_API trammel_result trammel_take_over(trammel_card* card, bool* dropped);

// What a call that waits, now or next, shall do at its next look at the card. An abort ends it with TRAMMEL_STATE, a
// stop with TRAMMEL_STOPPED. A card that is null, and a ratio or class that there is not, are left out.
TRAMMEL_API void trammel_request_hold(trammel_card* card, bool hold);
TRAMMEL_API void trammel_request_ratio(trammel_card* card, int32_t piece_class, uint32_t ratio);
TRAMMEL_API void trammel_request_abort(trammel_card* card);
TRAMMEL_API void trammel_request_stop(trammel_card* card);

// ---- One-shot lines: one burst, and the card makes the line by itself ----

typedef struct trammel_one_shot {
  int64_t pulses[TRAMMEL_MAX_AXES];  // start to end
  // Either a duration, or a speed along the path: one of the two is 0.
  int64_t duration_ns;
  uint64_t speed_pulses;   // in `speed_seconds`
  uint32_t speed_seconds;  // at least 1 where there is a speed
  // Pulses/s, 0: what the card's step times allow. A line that is too fast is a TRAMMEL_ARGUMENT, unless slow_down.
  uint64_t max_velocity[TRAMMEL_MAX_AXES];
  bool slow_down;
} trammel_one_shot;

typedef struct trammel_line_plan {
  size_t parts;     // lines that the card runs one after the other: 1 up to 2^32 pulses and 2^40 clocks
  uint64_t clocks;  // of all parts
  bool slowed;
} trammel_line_plan;

// Starts a line of one part and returns at once. `plan` may be null.
TRAMMEL_API trammel_result trammel_start_line(trammel_card* card, const trammel_one_shot* line,
                                              trammel_line_plan* plan);
// Runs all parts and returns when the last has ended, at most `margin_ns` later than planned. TRAMMEL_HELD, and
// nothing was started, on a card that holds or whose ratio is 0; a hold that comes later is waited out.
TRAMMEL_API trammel_result trammel_run_line(trammel_card* card, const trammel_one_shot* line, int64_t margin_ns,
                                            trammel_line_plan* plan);

// ---- PWM: pulses on outputs ----
//
// The card's registers say which outputs carry the pulses of a channel, and their period; a command of the stream
// (TRAMMEL_PWM) sets the duty at its place on the path. docs/reference/behaviour.md of the project, PWM.

#define TRAMMEL_PWM_CHANNELS 2

typedef struct trammel_pwm_channel {
  uint32_t period;   // clocks of the card, 100 .. 100,000,000; 10,000 after a reset
  uint16_t outputs;  // bit n: output n carries its pulses; 0: the channel stands still
} trammel_pwm_channel;

TRAMMEL_API trammel_result trammel_has_pwm(trammel_card* card, bool* has);
// The period of a frequency, rounded to whole clocks. TRAMMEL_ARGUMENT beyond 1 Hz to 1 MHz, and where a card with this
// clock cannot have it.
TRAMMEL_API trammel_result trammel_pwm_period(double frequency_hz, uint32_t clock_hz, uint32_t* period);
// Both channels, TRAMMEL_PWM_CHANNELS. One whose period is written ends its pulse and begins anew. TRAMMEL_ARGUMENT
// where the card has no PWM or lacks an output, and for a period out of range.
TRAMMEL_API trammel_result trammel_set_pwm(trammel_card* card, const trammel_pwm_channel* channels);
TRAMMEL_API trammel_result trammel_read_pwm(trammel_card* card, trammel_pwm_channel* channels);

// ---- The stream of commands ----
//
// Paths and the feed pieces of their time go into two queues of the card: a piece is put before the path that uses it,
// and the ticks of the pieces up to a barrier (dwell, end, waiting for an input) are those of its paths.

typedef enum trammel_command_kind {
  TRAMMEL_LINE = 0,
  TRAMMEL_ARC = 1,
  TRAMMEL_ELLIPSE = 2,
  TRAMMEL_ARC_CHORD = 3,
  TRAMMEL_FEED = 4,
  TRAMMEL_DWELL = 5,
  TRAMMEL_END = 6,
  TRAMMEL_OUTPUT = 7,
  TRAMMEL_MARK = 8,
  TRAMMEL_WAIT_INPUT = 9,
  TRAMMEL_PWM = 10  // on cards with PWM
} trammel_command_kind;

// A straight line; an axis that stands has 0. |pulses| <= ticks.
typedef struct trammel_line_command {
  uint64_t ticks;  // 1 .. 2^40 - 1
  int64_t pulses[TRAMMEL_MAX_AXES];
} trammel_line_command;

// An arc of a circle in the plane of two axes, the first to the right, the second up.
typedef struct trammel_arc_command {
  uint64_t ticks;         // at least the arc's steps
  int64_t centre_x;       // start to centre, 1/256 pulses
  int64_t centre_y;       //
  int32_t end_x;          // start to end, pulses
  int32_t end_y;          //
  bool clockwise;         //
  double sweep;           // angle without the extra turns, radians, >= 0; a full turn is 2 pi
  uint32_t turns;         // full turns beyond it
  uint8_t axis_x;         //
  uint8_t axis_y;         //
  bool eight_directions;  // steps along both axes at once too; on cards with accumulator_8. Not for arcs in chords
  int64_t further[TRAMMEL_MAX_AXES];  // arcs in chords alone: lines of further axes over the same time, pulses
} trammel_arc_command;

// An arc of an ellipse with axes along the plane's, about a centre on a whole pulse.
typedef struct trammel_ellipse_command {
  uint64_t ticks;
  int64_t semi_x;  // pulses, 2 .. 2^20; with eight_directions from 1 on
  int64_t semi_y;
  int64_t start_x;  // centre to start, pulses
  int64_t start_y;
  int32_t end_x;  // start to end, pulses
  int32_t end_y;
  bool clockwise;
  double sweep;  // angle that the ray from the centre sweeps, radians
  uint32_t turns;
  uint8_t axis_x;
  uint8_t axis_y;
  bool eight_directions;
} trammel_ellipse_command;

// A piece of the feed profile.
typedef struct trammel_feed_command {
  uint64_t ticks;
  uint64_t rate;           // 2^-64 ticks an enabled clock, at the beginning
  int64_t acceleration;    // the same unit an update of 32 enabled clocks
  int64_t jerk;            // the same unit an update, each update
  uint32_t floor;          // 2^-32 ticks an enabled clock, not 0
  uint32_t stop_distance;  // ticks needed to stop on the path; 0: the piece ends at rest
  int32_t piece_class;     // a trammel_piece_class
  bool silent;             // its ticks move the path on, but no axis; cards with map 3.2 or later
  uint32_t slew_shift;     // 0 .. 3: SLEW is doubled so often while it is in force; classes, map 3.4 or later
} trammel_feed_command;

// Outputs switched with the last tick of the path before, at once where none runs; bit n: output n.
typedef struct trammel_output_command {
  uint16_t set;
  uint16_t clear;
} trammel_output_command;

// Until an input has a level.
typedef struct trammel_input_condition {
  uint8_t input;     // 0 .. 31; one that the card lacks stays at 0
  bool level;        //
  uint64_t timeout;  // clocks, 0: none. Not for probes
} trammel_input_condition;

// The duty of a PWM channel from the last tick of the path before on, at once where none runs.
typedef struct trammel_pwm_command {
  uint8_t channel;  // 0 or 1
  uint16_t duty;    // 2^-16 of the period, 65535: full; where it follows, the largest one
  bool follows;     // the speed on the path, as trammel_pwm_for_speed() makes it; shift and gain are 0 where it is not
  uint8_t shift;    // 0 .. 31
  uint16_t gain;
} trammel_pwm_command;

typedef struct trammel_command {
  int32_t kind;  // a trammel_command_kind
  union {
    trammel_line_command line;
    trammel_arc_command arc;  // TRAMMEL_ARC and TRAMMEL_ARC_CHORD
    trammel_ellipse_command ellipse;
    trammel_feed_command feed;
    uint64_t dwell_clocks;
    trammel_output_command output;
    trammel_input_condition wait_input;
    trammel_pwm_command pwm;
  } as;
} trammel_command;

typedef struct trammel_progress {
  uint64_t commands_sent;  // since the stream was opened or restarted
  uint32_t geometry_begun;
  uint32_t feed_begun;
  trammel_status status;
} trammel_progress;

typedef struct trammel_stream_options {
  int64_t margin_ns;  // card time beyond what was planned before a card counts as hung; 0: a second
  // Called while a call of the stream waits; false ends that call with TRAMMEL_CANCELLED. May be null.
  bool (*progress)(void* context, const trammel_progress* progress);
  void* context;
} trammel_stream_options;

// A duty that follows the speed: `duty` at `rate` feed ticks a clock (2^-31 < rate <= 1), in proportion at others, and
// `most` at most. TRAMMEL_ARGUMENT for another rate.
TRAMMEL_API trammel_result trammel_pwm_for_speed(uint8_t channel, uint16_t duty, double rate, uint16_t most,
                                                 trammel_pwm_command* command);

// Opens the card's stream, which must stand idle; one that was open ends. `options` may be null. TRAMMEL_HELD where the
// card stands in a hold that this handle has not set.
TRAMMEL_API trammel_result trammel_open_stream(trammel_card* card, const trammel_stream_options* options);
// Takes a command, whole or not at all; written now or later. After TRAMMEL_REFUSED, TRAMMEL_LINK or TRAMMEL_STATE the
// stream is closed until trammel_restart_stream().
TRAMMEL_API trammel_result trammel_put(trammel_card* card, const trammel_command* command);
// Writes what trammel_put() has kept back.
TRAMMEL_API trammel_result trammel_flush(trammel_card* card);
// Flushes and waits until all is done. `status` may be null.
TRAMMEL_API trammel_result trammel_finish(trammel_card* card, trammel_status* status);
// Drops what the card has queued and begins anew.
TRAMMEL_API trammel_result trammel_restart_stream(trammel_card* card);

typedef enum trammel_probe_outcome {
  TRAMMEL_PROBE_MISSED = 0,          // the paths ended without the edge
  TRAMMEL_PROBE_TRIPPED = 1,         // it came on the way
  TRAMMEL_PROBE_TRIPPED_ALREADY = 2  // the input had the level before: nothing moved
} trammel_probe_outcome;

typedef struct trammel_probe_result {
  trammel_probe_outcome outcome;
  trammel_snapshot edge;  // zeros when missed
  trammel_snapshot rest;  // where the card stands now
} trammel_probe_result;

// Moves along `paths` (with their feed pieces) until the input has the level, then ramps to rest along them; waits for
// all of it. The stream goes on from there.
TRAMMEL_API trammel_result trammel_probe(trammel_card* card, const trammel_input_condition* condition,
                                         const trammel_command* paths, size_t count, trammel_probe_result* result);

// ---- Position streaming ----
//
// For a host with a servo cycle of its own: once a period it says where the axes shall be at the period's end, and the
// card goes there in a straight line (docs/user/position-streaming.md of the project). Cards with the engine
// `streaming`, at the full ratio. Positions are 2^-24 pulses from where the axes stood at the opening, by axis.

#define TRAMMEL_POSITION_PULSE (INT64_C(1) << 24)

typedef struct trammel_position_options {
  unsigned stale_periods;  // that the card may go on for along the last line where the next is late, 0 .. 255
  unsigned ahead;          // periods sent before the card begins with the first, at least 1
  // Pulses/s, 0: what the card and its step times allow.
  double max_speed[TRAMMEL_MAX_AXES];
  int64_t margin_ns;  // card time beyond what is queued before a card counts as hung; 0: a second
} trammel_position_options;

typedef struct trammel_position_sent {
  uint64_t ahead;         // periods queued that have not begun
  uint64_t stale_ticks;   // ticks (2 clocks each) that the card had gone on for when this one came; 0: it was in time
  uint64_t ticks_behind;  // still to be taken off coming periods, for those that were late
} trammel_position_sent;

typedef struct trammel_position_stop {
  uint32_t faults;                      // FAULT
  uint64_t stale_ticks;                 // that it went on for after the last period
  int64_t positions[TRAMMEL_MAX_AXES];  // where the axes stand, whole pulses
} trammel_position_stop;

// Opens position streaming where the axes stand; the card must be idle, and a stream that was open ends. `options` may
// be null: 1 stale period, 2 ahead.
TRAMMEL_API trammel_result trammel_open_positions(trammel_card* card, const trammel_position_options* options);
// One period: the axes are at the TRAMMEL_MAX_AXES `targets` when `duration_ns` has passed since the end of the period
// before. `sent` may be null. After TRAMMEL_ARGUMENT (too fast, too short, too far) nothing was sent, and another may
// be sent in its place; TRAMMEL_FAULT: a period was missing, or whatever else the card has stopped for.
TRAMMEL_API trammel_result trammel_send_positions(trammel_card* card, const int64_t* targets, int64_t duration_ns,
                                                  trammel_position_sent* sent);
// After TRAMMEL_FAULT: waits until the card stands, clears the fault, and goes on from there: the next targets begin at
// `stopped->positions`.
TRAMMEL_API trammel_result trammel_recover_positions(trammel_card* card, trammel_position_stop* stopped);
// Ends it after the last period, which should end at rest, and waits until the card is idle. `positions` (may be null):
// TRAMMEL_MAX_AXES places where the axes are.
TRAMMEL_API trammel_result trammel_finish_positions(trammel_card* card, int64_t* positions);

// ---- Simulated cards alone: TRAMMEL_STATE for others ----

typedef struct trammel_step {
  uint64_t cycle;    // clock since reset
  uint64_t command;  // of a path's step: its command's number, not wrapped; else 0
  uint64_t tick;     // of a path's step: from 1; else 0
  uint8_t axis;      //
  int8_t direction;  // +1 or -1
  bool at_pin;       // a leading edge at a STEP pin; else a step of the path, before the step times
} trammel_step;

// Called for each step while the card is used. Must not use the card. Null: no more.
TRAMMEL_API trammel_result trammel_simulated_listen(trammel_card* card,
                                                    void (*listener)(void* context, const trammel_step* step),
                                                    void* context);
// Lets clocks pass.
TRAMMEL_API trammel_result trammel_simulated_wait(trammel_card* card, uint64_t clocks);
// Levels at the input pins from now on; bit n: input n. The simulated card has 16.
TRAMMEL_API trammel_result trammel_simulated_set_inputs(trammel_card* card, uint32_t levels);
// Of one input; the others stay. One that has got no level is unwired and stands at its inactive one.
TRAMMEL_API trammel_result trammel_simulated_set_input(trammel_card* card, unsigned input, bool level);
// As by the emergency stop's button.
TRAMMEL_API trammel_result trammel_simulated_set_emergency_stop(trammel_card* card, bool pressed);
// As by the card's reset input.
TRAMMEL_API trammel_result trammel_simulated_reset(trammel_card* card);

#ifdef __cplusplus
}
#endif

#endif
