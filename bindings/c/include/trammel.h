// Trammel's driver for C (C99), and for every language that can call C: opens a card, moves it, monitors it, stops it.
//
// Units: positions and distances in pulses; times in nanoseconds of card time (names end in _ns) or in clocks of the
// card; feed in ticks, as in the card's commands (docs/reference/commands.md of the project).
//
// Errors: a function that can fail returns a trammel_result. Its outputs through pointers are valid only with
// TRAMMEL_OK. Nothing is thrown, and no function ends the program. A null pointer where none is allowed returns
// TRAMMEL_ARGUMENT. trammel_last_error() describes the failure, also in words.
//
// Enumerations are passed as int32_t, so an undefined number is an error and not undefined behaviour.
//
// Thread-safety: one thread at a time uses a card, also in its callbacks; several threads may use several cards at
// once. Any thread, and any signal handler, may call the trammel_request_... functions while another thread is in a
// call that waits, but not while the card is being closed or afterwards.
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
#define TRAMMEL_MAX_CAPTURES 4       // capture units of a card, at most
#define TRAMMEL_CAPTURE_QUEUE 16     // capacity of the card's queue of captures
#define TRAMMEL_FULL_RATIO 0x10000u  // ratio of the time base: every clock is enabled

// ---- Results ----

typedef enum trammel_result {
  TRAMMEL_OK = 0,
  TRAMMEL_ARGUMENT = 1,        // a value out of range, or a null pointer; nothing was done
  TRAMMEL_STATE = 2,           // not valid in the present state of card or stream; the text says what to do
  TRAMMEL_STOPPED = 3,         // trammel_request_stop() ended the call; at rest on the path, queues empty
  TRAMMEL_TIMEOUT = 4,         // the expected state did not come in the time allowed; nothing was aborted
  TRAMMEL_REFUSED = 5,         // the card refused an access or a command
  TRAMMEL_FAULT = 6,           // the card has stopped with a latched fault
  TRAMMEL_LINK = 7,            // the link failed; pending accesses may or may not have been made
  TRAMMEL_IDENTIFICATION = 8,  // the device is not a card that this driver knows
  TRAMMEL_CANCELLED = 9,       // a progress callback returned false, or an interrupt ended a wait for the link
  TRAMMEL_MEMORY = 10,         // out of memory
  TRAMMEL_INTERNAL = 11,       // a defect of this library
  TRAMMEL_HELD = 12,           // the card was already in a hold before the call: nothing would move
  TRAMMEL_HOMING = 13          // an axis was not homed; the text names axis, input and distance (trammel_machine.h)
} trammel_result;

// The last failure in this thread.
typedef struct trammel_error {
  trammel_result result;
  uint8_t reason;           // TRAMMEL_REFUSED: the card's reason, 0 if it gave none
  uint8_t command_number;   // TRAMMEL_REFUSED: number of the stream command, mod 256
  uint32_t address;         // TRAMMEL_REFUSED: byte address of the access
  uint32_t faults;          // TRAMMEL_FAULT: the card's FAULT register
  uint32_t geometry_begun;  // TRAMMEL_STOPPED: paths and barriers begun since the stream was opened
  uint64_t waited;          // TRAMMEL_TIMEOUT: clocks
  char text[1024];          // one line, UTF-8, truncated
} trammel_error;

// Never null. `result` is TRAMMEL_OK as long as nothing has failed in this thread. Valid until the thread's next
// failure.
TRAMMEL_API const trammel_error* trammel_last_error(void);
// "TRAMMEL_ARGUMENT" and so on; "unknown" for another number.
TRAMMEL_API const char* trammel_result_name(int32_t result);
// "0.1.0".
TRAMMEL_API const char* trammel_version(void);

// ---- Interrupts ----

// Sets a check that ends waiting calls of this thread, trammel_open() included: such a call asks `asked(context)` about
// every 50 ms. Once it returns true, a call that waits for motion stops the card on the path and returns
// TRAMMEL_STOPPED; a call that waits for a silent link, or for trammel_stop(), returns TRAMMEL_CANCELLED. Use it for a
// flag that a signal handler sets, or a deadline. `asked` must not use the card. Null (the default): no check.
TRAMMEL_API void trammel_set_interrupt(bool (*asked)(void* context), void* context);

// ---- Cards ----

// A connection to a card, including the card's one stream of commands.
typedef struct trammel_card trammel_card;

// A simulated card: the golden model with all engines built in.
typedef struct trammel_simulation {
  unsigned axes;      // 1 .. 8
  uint32_t clock_hz;  // the clock frequency that the card reports
} trammel_simulation;

// One access to a register: a byte address below 0x1000, a multiple of 4.
typedef struct trammel_access {
  uint32_t address;
  uint32_t data;  // value to write, or value read
  bool write;
} trammel_access;

#define TRAMMEL_BUS_FAILED SIZE_MAX

// A bus implemented by the caller. docs/reference/bus.md describes the contract.
typedef struct trammel_bus {
  void* context;  // passed to each function
  // Makes the accesses in order and returns the number made: fewer than `count` if the card refused the next one, or
  // TRAMMEL_BUS_FAILED when the link fails.
  size_t (*transfer)(void* context, trammel_access* accesses, size_t count);
  // Returns after at least `time_ns`. Null: the thread sleeps.
  void (*sleep)(void* context, int64_t time_ns);
  // The reason why the last transfer failed, for the error's text. May be null.
  const char* (*failure)(void* context);
  // Whether transfer() reports refusals. If not, the driver reads them from the card.
  bool reports_refusals;
} trammel_bus;

// Opens the card named by a URL (docs/reference/card-url.md of the project): "sim:?axes=4&clock=1000000" is a simulated
// card; others are "tcp://host:port?token=...", "serial:/dev/ttyUSB0", "spi:/dev/spidev0.0", "mmap:/dev/uio0". Reads
// the card's identification; writes only what starts the connection. TRAMMEL_LINK when nothing answers. On success,
// close *card with trammel_close(); otherwise it is null.
TRAMMEL_API trammel_result trammel_open(const char* url, trammel_card** card);
TRAMMEL_API trammel_result trammel_open_simulated(const trammel_simulation* simulation, trammel_card** card);
// `bus` is copied; its context must outlive the card.
TRAMMEL_API trammel_result trammel_open_bus(const trammel_bus* bus, trammel_card** card);
// Leaves the card as it is: queued commands run to their end. Does nothing for null.
TRAMMEL_API void trammel_close(trammel_card* card);

typedef struct trammel_identification {
  uint16_t map_major;
  uint16_t map_minor;
  uint32_t commands_version;
  unsigned axes;            // 1 .. 8
  uint32_t clock_hz;        // Hz
  uint32_t engines;         // bits of the engines (docs/reference/registers.md, Units and engines)
  uint32_t geometry_depth;  // depth of the geometry queue, halfwords
  uint32_t feed_depth;      // depth of the feed queue, halfwords
} trammel_identification;

// A unit in the card, as its descriptor reports it (docs/reference/registers.md of the project, Units and engines).
typedef struct trammel_unit {
  uint8_t tag;
  uint8_t major;  // major version
  uint8_t minor;
  uint8_t instances;
  uint8_t features;  // bits of its optional features
  uint16_t address;  // byte address of the first instance's first register; 0: no registers
  uint8_t words;     // words used by an instance
  uint8_t stride;    // words from one instance to the next; 0: all share the same registers
} trammel_unit;

// Raw accesses through the card's bus, unchecked. `made` is the number made, fewer than `count` if the card refused the
// next one. The driver does not know of values written here.
TRAMMEL_API trammel_result trammel_transfer(trammel_card* card, trammel_access* accesses, size_t count, size_t* made);

// As read when the card was opened.
TRAMMEL_API trammel_result trammel_identify(const trammel_card* card, trammel_identification* identification);
// The units, as read when the card was opened. Writes the first `room` of them to `units`, which may be null if `room`
// is 0; *count is their total number.
TRAMMEL_API trammel_result trammel_identify_units(const trammel_card* card, trammel_unit* units, size_t room,
                                                  size_t* count);

typedef enum trammel_step_mode {
  TRAMMEL_STEP_DIRECTION = 0,
  TRAMMEL_UP_DOWN = 1,
  TRAMMEL_QUADRATURE = 2
} trammel_step_mode;

// Minimum times of the motor driver's data sheet. The card keeps at least these times, 0 .. 65535 clocks each.
typedef struct trammel_axis_settings {
  int64_t step_length_ns;      // length of the step pulse
  int64_t step_space_ns;       // from the trailing edge to the next leading edge
  int64_t direction_setup_ns;  // direction stable before the leading edge
  int64_t direction_hold_ns;   // direction stable after the trailing edge
  int32_t mode;                // a trammel_step_mode
  bool invert_first;           // pin STEP, UP or A
  bool invert_second;          // pin DIR, DOWN or B
} trammel_axis_settings;

// Call it only while the axis is at rest.
TRAMMEL_API trammel_result trammel_configure_axis(trammel_card* card, unsigned axis,
                                                  const trammel_axis_settings* settings);

// ---- State ----

// The STATUS register.
typedef struct trammel_status {
  bool busy;          // something is under way or queued
  bool direct;        // a one-shot line (direct move) is under way
  bool path_active;   // a path or a one-shot line is under way
  bool feed_active;   // a feed piece is under way
  bool held;          // the time base's ratio is 0
  bool ended;         // END was executed, and nothing has begun since
  bool faulted;       // FAULT is not 0
  bool refused;       // REFUSAL is not 0
  bool snapshot;      // a snapshot is under way
  bool incomplete;    // the stream has written part of a command
  bool stopping;      // the card is stopping: it is on a ramp, or completes the last pulses
  bool geometry_low;  // fewer halfwords queued than the queue's watermark
  bool feed_low;      // the same for the feed queue
  bool probed;        // a probe has tripped
  bool probe_missed;  // probing paths ended without an edge
  bool waiting;       // the card waits for an input
  bool underrun;      // the under-run hold is active, or a piece that begins from rest waits for commands
  bool stale;         // position streaming continues without a new period
  bool button_hold;   // the feed hold input holds the card until cycle start
  bool enabled;       // the drives are enabled (trammel_set_enable_sequence())
  bool enable_waits;  // motion waits for the enable of the drives
  // For 31 clocks, at a ratio of 0 or stopped by a fault: every tick taken has made its steps, every step its pulse.
  bool settled;
} trammel_status;

// The state in one clock.
typedef struct trammel_snapshot {
  uint64_t time;  // clocks since reset
  trammel_status status;
  uint32_t faults;
  uint32_t rate;            // 2^-32 feed ticks per enabled clock
  uint32_t ratio;           // ratio of the time base, 2^-16
  uint32_t geometry_begun;  // commands begun from the geometry queue since the last cut
  uint32_t feed_begun;
  int32_t position[TRAMMEL_MAX_AXES];  // pulses, wrapping; 0 for axes that the card lacks
} trammel_snapshot;

TRAMMEL_API trammel_result trammel_read_status(trammel_card* card, trammel_status* status);
TRAMMEL_API trammel_result trammel_read_snapshot(trammel_card* card, trammel_snapshot* snapshot);
// The state latched at the first cause of the present or last fault; zeros if there was none.
TRAMMEL_API trammel_result trammel_read_stop_snapshot(trammel_card* card, trammel_snapshot* snapshot);
// Waits until the card is idle. `timeout_ns`: card time outside holds, extended in proportion if the ratio is below 1.
// TRAMMEL_FAULT when the card has a fault, TRAMMEL_HELD if it is in a hold that this handle has not set, TRAMMEL_STATE
// if it was reset.
TRAMMEL_API trammel_result trammel_wait_until_idle(trammel_card* card, int64_t timeout_ns);

// The state in which the last stop left the card, latched before the stop dropped anything: for a fault, after the last
// pulse; for an abort, in the clock of the abort.
typedef struct trammel_rest {
  uint64_t time;  // clocks since reset; 0: no stop since the reset
  trammel_status status;
  uint32_t faults;
  uint32_t geometry_begun;  // commands begun from the geometry queue since the previous cut
  uint32_t feed_begun;
  // Ticks of N that the last begun command has not taken yet, 40 bits (one-shot line: enabled clocks of its length). 0
  // if no path was under way, and if `exact` is false.
  uint64_t ticks_left;
  int32_t position[TRAMMEL_MAX_AXES];  // pulses, wrapping; 0 for axes that the card lacks
  // Whether `position` includes the steps of all ticks taken; false after an abort in motion.
  bool exact;
} trammel_rest;

// TRAMMEL_STATE while the card is stopping, TRAMMEL_ARGUMENT if its map is older than 3.4.
TRAMMEL_API trammel_result trammel_read_rest(trammel_card* card, trammel_rest* rest);
// Waits until a stop under way (status.stopping) has ended. TRAMMEL_TIMEOUT `margin_ns` (card time) after the longest
// ramp.
TRAMMEL_API trammel_result trammel_wait_until_stopped(trammel_card* card, int64_t margin_ns);

// Bits of FAULT and of fault masks. A bit is used by cards with the engine that sets it. Bits 0 to 7 are step faults of
// the axes 0 to 7: a step had to wait too long for the one before it.
typedef enum trammel_fault {
  TRAMMEL_FAULT_STEPS = 0xFF,              // step fault of any axis
  TRAMMEL_FAULT_TICK_MISMATCH = 1 << 8,    // ticks of feed and geometry did not match at a barrier
  TRAMMEL_FAULT_PATH_INCOMPLETE = 1 << 9,  // a path did not end at its end point
  TRAMMEL_FAULT_MISSING_PERIOD = 1 << 10,  // position streaming got no new period in time
  TRAMMEL_FAULT_LIMIT = 1 << 11,           // a step into a limit switch
  TRAMMEL_FAULT_EMERGENCY_STOP = 1 << 12,  // cannot be cleared while the pin is active
  TRAMMEL_FAULT_DRIVE_FAULT = 1 << 13,     // cannot be cleared while the drive reports it
  TRAMMEL_FAULT_WATCHDOG = 1 << 14,        // the program was silent for too long
  TRAMMEL_FAULT_LINK_LOSS = 1 << 15,       // the link was lost: no access of the program arrived
  TRAMMEL_FAULT_SOFT_LIMIT = 1 << 16,      // a step beyond a soft limit
  TRAMMEL_FAULT_PROBE = 1 << 17,           // the probe became active outside probing
  TRAMMEL_FAULT_TOOL_SETTER = 1 << 18      // the tool setter's switch became active during a move
} trammel_fault;

// FAULT; 0 if there is no fault.
TRAMMEL_API trammel_result trammel_read_faults(trammel_card* card, uint32_t* faults);
// Clears all faults; nothing moves. The stream restarts (trammel_restart_stream()). On a fault's ramp it first waits
// for the end, as trammel_wait_until_stopped() with a margin of one second; if that fails, the faults stay. Two faults
// stay although the result is TRAMMEL_OK: that of a drive that still reports it, and that of an emergency stop whose
// button is pressed.
TRAMMEL_API trammel_result trammel_clear_faults(trammel_card* card);
// Sets the watchdog: the card stops, with the cause in FAULT, when this program is silent for `time_ns`; 0: never.
// Calls that wait, and streams, restart it; set 0 when the motion is over. Choose `time_ns` longer than 4/3 of the time
// that the link may take to recover; at most 65,535 * 65,536 clocks.
TRAMMEL_API trammel_result trammel_set_watchdog(trammel_card* card, int64_t time_ns);
// The names of the bits, for messages: at most `size` bytes including the final 0.
TRAMMEL_API trammel_result trammel_describe_faults(uint32_t faults, char* text, size_t size);
// The same for the present faults, with the axes and sides of limits: "LIMIT (axis 0 plus)"; "none" if there is no
// fault.
TRAMMEL_API trammel_result trammel_read_fault_text(trammel_card* card, char* text, size_t size);

// Inputs and outputs of a card with path commands. Bit n: input n after its polarity, output n.
TRAMMEL_API trammel_result trammel_read_inputs(trammel_card* card, uint32_t* levels);
TRAMMEL_API trammel_result trammel_read_outputs(trammel_card* card, uint16_t* levels);
TRAMMEL_API trammel_result trammel_set_input_polarity(trammel_card* card, uint32_t inverted);
// Safe levels at rest: the levels that the outputs in `change` take at an abort, and when the card has come to rest
// after a fault.
TRAMMEL_API trammel_result trammel_set_output_safe(trammel_card* card, uint16_t levels, uint16_t change);
// Safe levels at the cause, for a laser: the levels are taken in the clock in which a fault is latched, at an emergency
// stop without a clock, and at an abort. They take precedence over the safe levels at rest, and stay until the stop is
// over and the fault is cleared. TRAMMEL_ARGUMENT if the card's map is older than 3.5.
TRAMMEL_API trammel_result trammel_set_output_safe_cause(trammel_card* card, uint16_t levels, uint16_t change);
// The number of MARK commands executed since reset, and the state latched by the last one. Either pointer may be null.
TRAMMEL_API trammel_result trammel_read_marks(trammel_card* card, uint32_t* marks, trammel_snapshot* last);

// For cards with the engine machine_inputs. TRAMMEL_ARGUMENT on others, and for inputs and axes that the card lacks.
// Masks of inputs: bit n is input n. Masks of axes: bit n is axis n.
//
// Write polarity and filters before roles: an input with a wrong polarity is active, and a drive's fault then stops at
// once.

// The role of an input: its function. An input may have several roles, a role several inputs.
typedef enum trammel_role {
  // Roles that exist once per axis.
  TRAMMEL_ROLE_LIMIT_MINUS = 0,
  TRAMMEL_ROLE_LIMIT_PLUS = 1,
  TRAMMEL_ROLE_HOME = 2,
  TRAMMEL_ROLE_INDEX = 3,
  TRAMMEL_ROLE_DRIVE_FAULT = 4,
  TRAMMEL_ROLE_IN_POSITION = 5,
  // Roles that exist once per card; `axis` is 0.
  TRAMMEL_ROLE_PROBE = 48,
  TRAMMEL_ROLE_TOOL_SETTER = 49,
  TRAMMEL_ROLE_FEED_HOLD = 50,
  TRAMMEL_ROLE_CYCLE_START = 51,
  TRAMMEL_ROLE_SPINDLE_AT_SPEED = 52
} trammel_role;

// Roles that are active now.
typedef struct trammel_active_roles {
  uint8_t limit_minus;  // mask of axes, as the next two
  uint8_t limit_plus;
  uint8_t drive_fault;
  bool feed_hold;  // the button is pressed; trammel_status.button_hold says whether the card holds
  bool cycle_start;
  bool tool_setter;
  bool probe;
} trammel_active_roles;

// Limits and drives that caused the present fault: masks of axes.
typedef struct trammel_limit_state {
  uint8_t minus;
  uint8_t plus;
  uint8_t drive_fault;
  // With TRAMMEL_FAULT_SOFT_LIMIT: the number of the axis that caused it, and whether at its positive end.
  uint8_t soft_axis;
  bool soft_plus;
} trammel_limit_state;

// Stops by inputs. A struct of zeros: limits and drives stop at once, the probe and the tool setter do not stop.
typedef struct trammel_input_stops {
  uint8_t any_step;  // mask, CoreXY: an active limit of any of these counts for every step of each
  uint8_t shared;    // mask: one switch serves both ends of these axes
  bool probe;        // an edge of the probe outside probing stops the card
  bool tool_setter;  // the tool setter stops the card
  // Reactions: true stops on a ramp, false at once.
  bool limit_ramps;
  bool drive_fault_ramps;
  bool probe_ramps;
  bool tool_setter_ramps;
} trammel_input_stops;

// Number of inputs and outputs of any card with path commands. Either pointer may be null.
TRAMMEL_API trammel_result trammel_count_ports(trammel_card* card, unsigned* inputs, unsigned* outputs);
// Levels before the filters; trammel_read_inputs() returns those after the filters.
TRAMMEL_API trammel_result trammel_read_raw_inputs(trammel_card* card, uint32_t* levels);
// Sets the filter of an input. A level that lasts at most `time_ns` does not pass. A level that lasts `time_ns`,
// rounded up to 64 clocks, plus 64 clocks passes. 0: no filter; at most 65,535 * 64 clocks. The rounded value is read
// back.
TRAMMEL_API trammel_result trammel_set_input_filter(trammel_card* card, unsigned input, int64_t time_ns);
TRAMMEL_API trammel_result trammel_read_input_filter(trammel_card* card, unsigned input, int64_t* time_ns);
// Assigns a role (a trammel_role) to the inputs in the mask; 0: to none. The role is active while one of them is.
TRAMMEL_API trammel_result trammel_set_role(trammel_card* card, int32_t role, unsigned axis, uint32_t inputs);
TRAMMEL_API trammel_result trammel_read_role(trammel_card* card, int32_t role, unsigned axis, uint32_t* inputs);
// "limit minus of axis 0", "feed hold": at most `size` bytes including the final 0.
TRAMMEL_API trammel_result trammel_role_name(int32_t role, unsigned axis, char* text, size_t size);
TRAMMEL_API trammel_result trammel_read_roles(trammel_card* card, trammel_active_roles* roles);
TRAMMEL_API trammel_result trammel_read_limit_state(trammel_card* card, trammel_limit_state* state);
TRAMMEL_API trammel_result trammel_set_input_stops(trammel_card* card, const trammel_input_stops* stops);
// Number of steps, 0 .. 65535, that the axis may make into an active limit on a ramp. One step more stops at once.
TRAMMEL_API trammel_result trammel_set_overtravel(trammel_card* card, unsigned axis, uint32_t steps);
// Overrides active limits: they stop nothing until they are released. Masks of axes.
TRAMMEL_API trammel_result trammel_override_limits(trammel_card* card, uint8_t minus, uint8_t plus);

// Time and positions at an edge of an input, latched at the edge; the input's filter only confirms or rejects the edge.
// For cards with the unit `captures`; TRAMMEL_ARGUMENT for units and inputs that the card lacks.

// The edges that a unit captures, and what it does with them. With neither edge selected it captures nothing.
typedef struct trammel_capture_select {
  unsigned input;
  bool to_active;    // edges to the active level, after polarity
  bool to_inactive;  // edges to the inactive level
  bool continuous;   // the unit continues after each capture; else it takes one only
  bool queue;        // captures go straight into the card's queue; the unit keeps none
} trammel_capture_select;

typedef struct trammel_capture_state {
  bool pending;  // an edge was seen and is not confirmed, rejected or written yet
  bool valid;    // a capture is latched
  bool overrun;  // a confirmed edge was lost; see trammel_read_captures()
  bool active;   // level after the captured edge
} trammel_capture_state;

typedef struct trammel_capture_states {
  trammel_capture_state units[TRAMMEL_MAX_CAPTURES];  // zeros for units that the card lacks
  uint16_t snapshots;                                 // for captures, including rejected ones; modulo 2^16
} trammel_capture_states;

typedef struct trammel_capture {
  trammel_snapshot at;  // state at the edge
  bool active;          // level after the edge
  bool overrun;         // later edges were lost
} trammel_capture;

typedef struct trammel_capture_queue {
  unsigned captures;  // captures in the queue, 0 to TRAMMEL_CAPTURE_QUEUE
  uint16_t lost;      // captures lost since reset because the queue was full; modulo 2^16
} trammel_capture_queue;

typedef struct trammel_queued_capture {
  trammel_snapshot at;  // state at the edge
  unsigned unit;
  bool active;  // level after the edge
} trammel_queued_capture;

// 0 on a card without captures.
TRAMMEL_API trammel_result trammel_count_captures(const trammel_card* card, unsigned* units);
// Restarts the unit and drops its previous capture. An edge counts if the input was at the previous level for a whole
// filter length before it; bounces after the first contact belong to the same edge.
TRAMMEL_API trammel_result trammel_select_capture(trammel_card* card, unsigned unit,
                                                  const trammel_capture_select* select);
TRAMMEL_API trammel_result trammel_stop_capture(trammel_card* card, unsigned unit);
TRAMMEL_API trammel_result trammel_read_captures(trammel_card* card, trammel_capture_states* states);
// Returns the latched capture and clears it. `taken`: whether there was one; otherwise `capture` is unchanged.
TRAMMEL_API trammel_result trammel_take_capture(trammel_card* card, unsigned unit, trammel_capture* capture,
                                                bool* taken);
// Waits for a capture and takes it. TRAMMEL_TIMEOUT after `timeout_ns` of card time, TRAMMEL_CANCELLED by
// trammel_set_interrupt(); the unit stays active in both cases. The trammel_request_... functions do not end the wait.
TRAMMEL_API trammel_result trammel_wait_for_capture(trammel_card* card, unsigned unit, int64_t timeout_ns,
                                                    trammel_capture* capture);
// Clears the latched captures and the overrun flags of the units in the mask.
TRAMMEL_API trammel_result trammel_clear_captures(trammel_card* card, unsigned units);

// The queue of captures, fed by units that were selected with `queue`, in the order in which their filters confirmed
// them. A capture that does not fit is lost and counted; trammel_read_captures() shows the overrun of the unit. These
// functions except the first return TRAMMEL_ARGUMENT on a card without a queue.
TRAMMEL_API trammel_result trammel_has_capture_queue(const trammel_card* card, bool* has);
TRAMMEL_API trammel_result trammel_read_capture_queue(trammel_card* card, trammel_capture_queue* queue);
// Takes the captures that are in the queue at the call, the oldest first. `captures` must have room for
// TRAMMEL_CAPTURE_QUEUE entries; `count` is the number taken. One program at a time may do so.
TRAMMEL_API trammel_result trammel_take_queued_captures(trammel_card* card, trammel_queued_capture* captures,
                                                        unsigned* count);

// The allowed positions of an axis, ends included, in pulses as the card counts them (trammel_snapshot.position),
// modulo 2^32. This is the second guard, after the program, which should not order moves beyond them. An outward pulse
// that ends beyond the range stops the card (TRAMMEL_FAULT_SOFT_LIMIT); pulses back are allowed. A stop on a ramp
// overshoots the end by the length of the ramp.
//
// For cards with the engine soft_limits; TRAMMEL_ARGUMENT on others.

typedef struct trammel_soft_range {
  bool limited;  // false: this axis has no soft limits; the ends are ignored
  int32_t minus;
  int32_t plus;
} trammel_soft_range;

TRAMMEL_API trammel_result trammel_has_soft_limits(const trammel_card* card, bool* has);
// Sets the soft limits of the first `count` axes from `ranges`; further axes get no limits. A `count` of 0, with which
// `ranges` may be null, switches all off. Call it while the axes are at rest, and again whenever a position changes its
// meaning. TRAMMEL_ARGUMENT for more ranges than the card has axes, and for a plus below its minus.
TRAMMEL_API trammel_result trammel_set_soft_limits(trammel_card* card, const trammel_soft_range* ranges, size_t count);
// `ranges`: room for TRAMMEL_MAX_AXES; `limited` is false for axes that the card lacks.
TRAMMEL_API trammel_result trammel_read_soft_limits(trammel_card* card, trammel_soft_range* ranges);
// Selects stops on a ramp (the default after a reset) or at once.
TRAMMEL_API trammel_result trammel_set_soft_limit_ramps(trammel_card* card, bool ramp);

// For cards with the engine `enables`. TRAMMEL_ARGUMENT on others, for outputs and axes that the card lacks, and for
// times out of range. A reset, a new program and trammel_clear_faults() enable nothing. trammel_status.enabled and
// .enable_waits show the state.

// Outputs that follow the state of the drives or of the card; bit n: output n. An inactive output has its idle level
// (strap output_idle_i), an active one the opposite level; commands and safe levels do not change it. An output has at
// most one role.
typedef struct trammel_output_roles {
  uint16_t enable;       // active while the drives are enabled
  uint16_t brake;        // active while the brake is released
  uint16_t charge_pump;  // a square wave while the card is healthy
  uint16_t healthy;      // active while the card is healthy
} trammel_output_roles;

// The enable sequence, common to the drives of all axes in `axes`. Delays are rounded up to 4,096 clocks of the card,
// the idle time to 2^20 clocks; each may be up to 65,535 of these units.
typedef struct trammel_enable_sequence {
  uint8_t axes;                  // axes of the sequence; 0: none, motion waits for nothing
  bool manual;                   // motion waits for trammel_enable(), else enables
  int64_t brake_release_ns;      // from the enable to the release of the brake
  int64_t before_first_step_ns;  // from the release of the brake to the first step
  int64_t after_last_step_ns;    // from the last step to the setting of the brake
  int64_t brake_set_ns;          // from the setting of the brake to the disable
  int64_t idle_ns;               // without motion, to the disable; 0: never
  // Faults (bits of trammel_fault) that disable the drives at rest; the emergency stop disables them at once.
  uint32_t disable_causes;
} trammel_enable_sequence;

// Conditions under which the card is healthy.
typedef struct trammel_health {
  uint32_t causes;              // none of these faults (bits of trammel_fault) is present
  bool needs_watchdog;          // and the watchdog is running
  int64_t pump_half_period_ns;  // half the wave's period, rounded up to clocks, up to 65,535; 0: no wave
} trammel_health;

TRAMMEL_API trammel_result trammel_set_output_roles(trammel_card* card, const trammel_output_roles* roles);
// A new mask of axes takes effect when the card is at rest.
TRAMMEL_API trammel_result trammel_set_enable_sequence(trammel_card* card, const trammel_enable_sequence* sequence);
// The program's request for enabled drives: true enables them now and keeps them enabled until false. Motion needs it
// only if trammel_enable_sequence.manual is set.
TRAMMEL_API trammel_result trammel_enable(trammel_card* card, bool on);
TRAMMEL_API trammel_result trammel_set_health(trammel_card* card, const trammel_health* health);

// **Not a safety function**: the button must itself cut the drives' power (docs/user/outputs.md of the project). The
// pin informs the card, which stops and drops its path. For cards with the engine emergency_stop; TRAMMEL_ARGUMENT on
// others.

TRAMMEL_API trammel_result trammel_has_emergency_stop(const trammel_card* card, bool* has);
// Whether an emergency stop is latched; any press of the button latches it, however short. trammel_clear_faults()
// clears it only after the button is released, so read it again afterwards.
TRAMMEL_API trammel_result trammel_read_emergency_stop(trammel_card* card, bool* stopped);
// Selects whether the emergency stop stops the axes on a ramp or at once (the default after a reset). Outputs with safe
// levels at the cause change at once in both cases. A card with an enable sequence disables its drives at an emergency
// stop, and therefore always stops at once.
TRAMMEL_API trammel_result trammel_set_emergency_stop_ramps(trammel_card* card, bool ramp);

// The card keeps the machine's place for the next program: machine zero, and for each axis whether its place is valid
// and whether it was homed. The place survives the end of this program, a stop on the path and a lost link. A reset of
// the card clears it. An axis loses its place by a fault of its drive; when its drive is disabled; and by an immediate
// stop while it moves: an abort before the card is at rest, or a fault without a ramp. trammel_set_keeps_place()
// exempts axes from the last two. Masks: bit n is axis n. A lost place does not prevent motion: a program must call
// trammel_begin_at_place() before it moves the card.
//
// For cards with the map 3.3 or newer; TRAMMEL_ARGUMENT on others, and for axes that the card lacks.

#define TRAMMEL_NO_SCALES 0u         // no place was set since the card's reset
#define TRAMMEL_SCALES_IN_PULSES 1u  // a program that counts in pulses has set machine zero

typedef struct trammel_place {
  bool first;                              // trammel_begin_at_place() set machine zero: none was set since the reset
  uint8_t valid;                           // mask: `pulses` is correct for these axes
  uint8_t homed;                           // mask: machine zero was found at a reference; a homed axis is valid
  uint8_t keeps;                           // mask: these axes keep their place at an immediate stop
  uint32_t scales;                         // hash of the scales of the coordinates, or one of the two values above
  int32_t machine_zero[TRAMMEL_MAX_AXES];  // POSITION at machine zero, pulses, wrapping
  int32_t pulses[TRAMMEL_MAX_AXES];        // distance from machine zero; 0 with TRAMMEL_NO_SCALES
} trammel_place;

TRAMMEL_API trammel_result trammel_read_place(trammel_card* card, trammel_place* place);
// For a program in pulses, before it moves the axes in `axes`. If no place was set since the card's reset, sets machine
// zero at the present position and marks all axes valid; otherwise keeps the place. TRAMMEL_STATE, and nothing is
// written, if the card is busy, or if one of `axes` has lost its place. With `trust` such an axis is marked valid again
// instead: use it if no step was lost. `place` (may be null): the card's place after the call.
TRAMMEL_API trammel_result trammel_begin_at_place(trammel_card* card, uint8_t axes, bool trust, trammel_place* place);
// The parts of the place. To set machine zero of an axis at rest: 1. trammel_begin_at_place() without that axis in
// `axes`, so that there is a place; 2. trammel_set_place() with `valid` false, so that a program that ends in between
// leaves a lost place; 3. trammel_set_machine_zero(); 4. trammel_set_place() with `valid` true. Call
// trammel_set_place() only for axes at rest: otherwise it could hide a loss that the host has not seen.
// TRAMMEL_ARGUMENT for `homed` without `valid`.
TRAMMEL_API trammel_result trammel_set_place(trammel_card* card, uint8_t axes, bool valid, bool homed);
TRAMMEL_API trammel_result trammel_set_machine_zero(trammel_card* card, unsigned axis, int32_t pulses);
// The `trammel` command refuses a place whose scales differ from its machine file's. It accepts a place in pulses and
// writes its own scales.
TRAMMEL_API trammel_result trammel_set_scales(trammel_card* card, uint32_t hash);
// Sets the axes that keep their place at an immediate stop, because their mechanism cannot lose steps in it.
TRAMMEL_API trammel_result trammel_set_keeps_place(trammel_card* card, uint8_t axes);

// ---- Hold, override, stop, abort ----

// The class of a feed piece, `piece_class` below: selects its ratio of the time base.
typedef enum trammel_piece_class {
  TRAMMEL_CLASS_FEED = 0,
  TRAMMEL_CLASS_RAPID = 1,
  TRAMMEL_CLASS_FIXED = 2  // a hold waits for the end of these pieces
} trammel_piece_class;

// Slews to rest on the path, or resumes. Nothing is lost.
TRAMMEL_API trammel_result trammel_set_hold(trammel_card* card, bool hold);
// Fraction of enabled clocks, 0 .. TRAMMEL_FULL_RATIO. A card without classes has only the ratio of TRAMMEL_CLASS_FEED.
TRAMMEL_API trammel_result trammel_set_ratio(trammel_card* card, int32_t piece_class, uint32_t ratio);
// Sets the ratio to `percent` / `max_percent`. `max_percent` is the largest override for which programs are planned.
TRAMMEL_API trammel_result trammel_set_override(trammel_card* card, int32_t piece_class, double percent,
                                                double max_percent);
// Time of a slew from ratio 0 to the full ratio; up to 2^30 clocks.
TRAMMEL_API trammel_result trammel_set_slew_time(trammel_card* card, int64_t full_scale_ns);
// Drops all queued commands and stops at once. Positions are kept; faults stay latched. The stream restarts.
TRAMMEL_API trammel_result trammel_abort(trammel_card* card);
// Stops on the path: holds, aborts when the card is at rest, and ends the hold. No pulse follows. `snapshot` (may be
// null) returns the state at the end. TRAMMEL_TIMEOUT if the card is not at rest `margin_ns` (card time) after the
// ramp.
TRAMMEL_API trammel_result trammel_stop(trammel_card* card, int64_t margin_ns, trammel_snapshot* snapshot);

// Takes over a card that another host has left: ends its hold, and drops the rest of a path on which the card holds.
// `dropped` (may be null): whether there was any. TRAMMEL_STATE, and nothing changes, if the card moves without a hold.
TRAMMEL_API trammel_result trammel_take_over(trammel_card* card, bool* dropped);

// Requests to the call that waits, or to the next one that does; it serves them at its next poll of the card. An abort
// ends that call with TRAMMEL_STATE, a stop with TRAMMEL_STOPPED. A null card, and a ratio or class out of range, are
// ignored.
TRAMMEL_API void trammel_request_hold(trammel_card* card, bool hold);
TRAMMEL_API void trammel_request_ratio(trammel_card* card, int32_t piece_class, uint32_t ratio);
TRAMMEL_API void trammel_request_abort(trammel_card* card);
TRAMMEL_API void trammel_request_stop(trammel_card* card);

// ---- One-shot lines: one burst starts a line, and the card makes it without further commands ----

typedef struct trammel_one_shot {
  int64_t pulses[TRAMMEL_MAX_AXES];  // from start to end, pulses
  // Either a duration, or a speed along the path; the other is 0.
  int64_t duration_ns;
  uint64_t speed_pulses;   // speed: pulses per `speed_seconds`
  uint32_t speed_seconds;  // at least 1 if `speed_pulses` is not 0
  // Pulses/s; 0: limited by the card's step times only. A line that is too fast returns TRAMMEL_ARGUMENT, unless
  // slow_down.
  uint64_t max_velocity[TRAMMEL_MAX_AXES];
  bool slow_down;
} trammel_one_shot;

typedef struct trammel_line_plan {
  size_t parts;     // lines that the card runs in sequence: 1 up to 2^32 pulses and 2^40 clocks
  uint64_t clocks;  // length of all parts together
  bool slowed;
} trammel_line_plan;

// Starts a line of one part and returns at once. `plan` may be null.
TRAMMEL_API trammel_result trammel_start_line(trammel_card* card, const trammel_one_shot* line,
                                              trammel_line_plan* plan);
// Runs all parts and returns when the last has ended, at most `margin_ns` later than planned. TRAMMEL_HELD, and nothing
// is started, on a card that holds or whose ratio is 0; a later hold is waited out.
TRAMMEL_API trammel_result trammel_run_line(trammel_card* card, const trammel_one_shot* line, int64_t margin_ns,
                                            trammel_line_plan* plan);

// Registers select the outputs of a channel and its period; a command of the stream (TRAMMEL_PWM) sets the duty at a
// point of the path. See docs/reference/behaviour.md of the project, PWM.

#define TRAMMEL_PWM_CHANNELS 2

typedef struct trammel_pwm_channel {
  uint32_t period;   // clocks of the card, 100 .. 100,000,000; 10,000 after a reset
  uint16_t outputs;  // bit n: output n carries the pulses; 0: the channel is off
} trammel_pwm_channel;

TRAMMEL_API trammel_result trammel_has_pwm(trammel_card* card, bool* has);
// The period of a frequency, rounded to whole clocks. TRAMMEL_ARGUMENT for a frequency outside 1 Hz to 1 MHz, and for a
// period that the card cannot make at this clock.
TRAMMEL_API trammel_result trammel_pwm_period(double frequency_hz, uint32_t clock_hz, uint32_t* period);
// `channels`: TRAMMEL_PWM_CHANNELS entries. Writing a channel's period ends its pulse and restarts it. TRAMMEL_ARGUMENT
// if the card has no PWM or lacks an output, and for a period out of range.
TRAMMEL_API trammel_result trammel_set_pwm(trammel_card* card, const trammel_pwm_channel* channels);
TRAMMEL_API trammel_result trammel_read_pwm(trammel_card* card, trammel_pwm_channel* channels);

// Paths and feed pieces go into two queues of the card. Put a piece before the path that uses it. The ticks of the
// pieces up to a barrier (dwell, end, waiting for an input) must equal those of the paths up to it.

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

// A straight line; an axis that does not move has 0. |pulses| <= ticks.
typedef struct trammel_line_command {
  uint64_t ticks;  // 1 .. 2^40 - 1
  int64_t pulses[TRAMMEL_MAX_AXES];
} trammel_line_command;

// An arc of a circle in the plane of two axes, the first to the right, the second up.
typedef struct trammel_arc_command {
  uint64_t ticks;                     // at least the arc's steps
  int64_t centre_x;                   // from start to centre, 1/256 pulses
  int64_t centre_y;                   //
  int32_t end_x;                      // from start to end, pulses
  int32_t end_y;                      //
  bool clockwise;                     //
  double sweep;                       // angle without the extra turns, radians, >= 0; a full turn is 2 pi
  uint32_t turns;                     // full turns beyond `sweep`
  uint8_t axis_x;                     //
  uint8_t axis_y;                     //
  bool eight_directions;              // a step may move both axes; accumulator_8, not for chords
  int64_t further[TRAMMEL_MAX_AXES];  // arcs in chords only: straight motion of these, pulses
} trammel_arc_command;

// An arc of an ellipse whose axes are parallel to the plane's, about a centre on a whole pulse.
typedef struct trammel_ellipse_command {
  uint64_t ticks;
  int64_t semi_x;  // pulses, 2 .. 2^20; 1 .. 2^20 with eight_directions
  int64_t semi_y;
  int64_t start_x;  // from centre to start, pulses
  int64_t start_y;
  int32_t end_x;  // from start to end, pulses
  int32_t end_y;
  bool clockwise;
  double sweep;  // angle swept by the ray from the centre, radians
  uint32_t turns;
  uint8_t axis_x;
  uint8_t axis_y;
  bool eight_directions;
} trammel_ellipse_command;

// A piece of the feed profile.
typedef struct trammel_feed_command {
  uint64_t ticks;
  uint64_t rate;           // at the start, 2^-64 ticks per enabled clock
  int64_t acceleration;    // the same unit, per update of 32 enabled clocks
  int64_t jerk;            // the same unit, per update squared
  uint32_t floor;          // 2^-32 ticks per enabled clock, not 0
  uint32_t stop_distance;  // ticks needed for a stop on the path; 0: the piece ends at rest
  int32_t piece_class;     // a trammel_piece_class
  bool silent;             // its ticks advance the path, but move no axis; map 3.2 or later
  uint32_t slew_shift;     // 0 .. 3 doublings of SLEW while it is in force; classes, map 3.4 or later
} trammel_feed_command;

// Switches outputs with the last tick of the previous path, or at once if no path is under way. Bit n: output n.
typedef struct trammel_output_command {
  uint16_t set;
  uint16_t clear;
} trammel_output_command;

// A wait until an input has a level.
typedef struct trammel_input_condition {
  uint8_t input;     // 0 .. 31; an input that the card lacks reads 0
  bool level;        //
  uint64_t timeout;  // clocks, 0: no timeout. Not for probes
} trammel_input_condition;

// Sets the duty of a PWM channel with the last tick of the previous path, or at once if no path is under way.
typedef struct trammel_pwm_command {
  uint8_t channel;  // 0 or 1
  uint16_t duty;    // 2^-16 of the period, 65535: full; the largest duty if `follows`
  bool follows;     // duty follows the speed: trammel_pwm_for_speed(); else shift and gain are 0
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
  uint64_t commands_sent;  // commands sent since the stream was opened or restarted
  uint32_t geometry_begun;
  uint32_t feed_begun;
  trammel_status status;
} trammel_progress;

typedef struct trammel_stream_options {
  int64_t margin_ns;  // card time beyond the planned time, before TRAMMEL_TIMEOUT; 0: one second
  // Called while a call of the stream waits; false ends that call with TRAMMEL_CANCELLED. May be null.
  bool (*progress)(void* context, const trammel_progress* progress);
  void* context;
} trammel_stream_options;

// A duty that follows the speed: `duty` at `rate` feed ticks per clock (2^-31 < rate <= 1), proportional at others, and
// at most `most`. TRAMMEL_ARGUMENT for another rate.
TRAMMEL_API trammel_result trammel_pwm_for_speed(uint8_t channel, uint16_t duty, double rate, uint16_t most,
                                                 trammel_pwm_command* command);

// A feed piece from its speeds, for callers that plan themselves: constant acceleration from one speed to the other.
// Speeds are feed ticks/s, 0 .. one per enabled clock.
typedef struct trammel_ramp {
  uint64_t ticks;    // length of the piece, 1 .. 2^40 - 1
  double speed;      // speed at the start; 0: from rest
  double end_speed;  // speed at the end; 0: the piece ends at rest
  // For the under-run hold: the highest speed of this piece and of all following pieces up to the next rest. If it is
  // below both speeds, the higher of them is used.
  double highest_speed;
  int64_t slew_time_ns;  // as given to trammel_set_slew_time(); for pieces that do not end at rest
} trammel_ramp;

// `clock_hz`: enabled clocks per second at the caller's 100 %. If 100 % is the full ratio, this is the card's clock. A
// ramp to rest does not slow down below r = sqrt(deceleration * 1 tick), its speed half a tick before rest; otherwise
// its last tick would be late. That tick comes early by 1 / (2 r). The class is TRAMMEL_CLASS_FEED. TRAMMEL_ARGUMENT
// for values out of range, two speeds of 0, a stop of more than 2^32 - 1 ticks, and a rate that changes by half a tick
// per clock or more within 32 clocks. Needs no card; any thread.
TRAMMEL_API trammel_result trammel_feed_for_ramp(const trammel_ramp* ramp, uint32_t clock_hz,
                                                 trammel_feed_command* command);

// Opens the card's stream; the card must be idle. A stream that was open is closed. `options` may be null. TRAMMEL_HELD
// if the card is in a hold that this handle has not set.
TRAMMEL_API trammel_result trammel_open_stream(trammel_card* card, const trammel_stream_options* options);
// Accepts a command, as a whole or not at all, and writes it now or later. After TRAMMEL_REFUSED, TRAMMEL_LINK or
// TRAMMEL_STATE the stream is closed until trammel_restart_stream().
TRAMMEL_API trammel_result trammel_put(trammel_card* card, const trammel_command* command);
// Writes the commands that trammel_put() has buffered.
TRAMMEL_API trammel_result trammel_flush(trammel_card* card);
// Flushes and waits until all is done. `status` may be null.
TRAMMEL_API trammel_result trammel_finish(trammel_card* card, trammel_status* status);
// Drops the card's queued commands and restarts the stream.
TRAMMEL_API trammel_result trammel_restart_stream(trammel_card* card);

typedef enum trammel_probe_outcome {
  TRAMMEL_PROBE_MISSED = 0,          // the paths ended without an edge
  TRAMMEL_PROBE_TRIPPED = 1,         // the edge came during the motion
  TRAMMEL_PROBE_TRIPPED_ALREADY = 2  // the input had the level before the first path; nothing moved
} trammel_probe_outcome;

typedef struct trammel_probe_result {
  trammel_probe_outcome outcome;
  trammel_snapshot edge;  // zeros when missed
  trammel_snapshot rest;  // the state at the end
} trammel_probe_result;

// Moves along `paths` (with their feed pieces) until the input has the level, then ramps to rest along them. Waits
// until the card is at rest. The stream continues from there.
TRAMMEL_API trammel_result trammel_probe(trammel_card* card, const trammel_input_condition* condition,
                                         const trammel_command* paths, size_t count, trammel_probe_result* result);

// For a host with its own servo cycle. Once per period the host gives the axes' positions for the period's end, and the
// card moves there in a straight line (docs/user/position-streaming.md of the project). For cards with the engine
// `streaming`, at the full ratio. Positions are 2^-24 pulses, by axis, counted from the position at which the stream
// was opened.

#define TRAMMEL_POSITION_PULSE (INT64_C(1) << 24)

typedef struct trammel_position_options {
  unsigned stale_periods;  // periods that the card may continue when the next is late, 0 .. 255
  unsigned ahead;          // periods sent before the card starts the first, at least 1
  // Pulses/s; 0: limited by the card and its step times only.
  double max_speed[TRAMMEL_MAX_AXES];
  int64_t margin_ns;  // card time beyond the queued periods before TRAMMEL_TIMEOUT; 0: one second
} trammel_position_options;

typedef struct trammel_position_sent {
  uint64_t ahead;         // queued periods that have not begun
  uint64_t stale_ticks;   // excess ticks (2 clocks each) when this period came; 0: it was in time
  uint64_t ticks_behind;  // excess ticks still to be subtracted from future periods
} trammel_position_sent;

typedef struct trammel_position_stop {
  uint32_t faults;                      // FAULT
  uint64_t stale_ticks;                 // excess ticks after the last period
  int64_t positions[TRAMMEL_MAX_AXES];  // positions of the axes, whole pulses
} trammel_position_stop;

// Opens position streaming at the present position; the card must be idle. A stream that was open is closed. `options`
// may be null: 1 stale period, 2 ahead.
TRAMMEL_API trammel_result trammel_open_positions(trammel_card* card, const trammel_position_options* options);
// Sends one period: the axes are at the TRAMMEL_MAX_AXES `targets` when `duration_ns` has passed since the end of the
// previous period. `sent` may be null. After TRAMMEL_ARGUMENT (too fast, too short, too far) nothing was sent, and
// another period may be sent instead. TRAMMEL_FAULT: a period was missing, or another fault stopped the card.
TRAMMEL_API trammel_result trammel_send_positions(trammel_card* card, const int64_t* targets, int64_t duration_ns,
                                                  trammel_position_sent* sent);
// After TRAMMEL_FAULT: waits until the card is at rest and clears the fault. The stream continues from there: the next
// targets start at `stopped->positions`.
TRAMMEL_API trammel_result trammel_recover_positions(trammel_card* card, trammel_position_stop* stopped);
// Ends the stream after the last period, which should end at rest, and waits until the card is idle. `positions` (may
// be null): room for TRAMMEL_MAX_AXES positions of the axes.
TRAMMEL_API trammel_result trammel_finish_positions(trammel_card* card, int64_t* positions);

// ---- Simulated cards only: TRAMMEL_STATE for others ----

typedef struct trammel_step {
  uint64_t cycle;    // clock since reset
  uint64_t command;  // step of a path: number of its command, not wrapped; else 0
  uint64_t tick;     // step of a path: its tick, from 1; else 0
  uint8_t axis;      //
  int8_t direction;  // +1 or -1
  bool at_pin;       // a leading edge at a STEP pin; else a step of the path, before the shaper
} trammel_step;

// `listener` is called for each step while the card is used. It must not use the card. Null: no more calls.
TRAMMEL_API trammel_result trammel_simulated_listen(trammel_card* card,
                                                    void (*listener)(void* context, const trammel_step* step),
                                                    void* context);

// Outputs that changed at their pins in one clock; bit n: output n.
typedef struct trammel_output_change {
  uint64_t cycle;    // clock since reset in which the pins have their new levels
  uint16_t changed;  //
  uint16_t levels;   // levels of all outputs
} trammel_output_change;

// `listener` is called for each change while the card is used, after the steps of the same clock. It must not use the
// card. Null: no more calls.
TRAMMEL_API trammel_result trammel_simulated_listen_to_outputs(
    trammel_card* card, void (*listener)(void* context, const trammel_output_change* change), void* context);
// Simulates `clocks` clocks.
TRAMMEL_API trammel_result trammel_simulated_wait(trammel_card* card, uint64_t clocks);
// Sets the levels at the input pins; bit n: input n. The simulated card has 16.
TRAMMEL_API trammel_result trammel_simulated_set_inputs(trammel_card* card, uint32_t levels);
// Sets the level of one input; the others stay. An input that was never set is unwired and has its inactive level.
TRAMMEL_API trammel_result trammel_simulated_set_input(trammel_card* card, unsigned input, bool level);
// Presses or releases the emergency stop's button.
TRAMMEL_API trammel_result trammel_simulated_set_emergency_stop(trammel_card* card, bool pressed);
// Resets the card, as its reset input does.
TRAMMEL_API trammel_result trammel_simulated_reset(trammel_card* card);

#ifdef __cplusplus
}
#endif

#endif
