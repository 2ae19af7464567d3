// One card: identification, settings, state. Addresses and limits come from the generated card map.
//
// Units: times in nanoseconds of real time if a motor driver's data sheet gives them, else in card clocks; positions in
// pulses. Every argument is checked before the first access to the bus (ArgumentError). Every function may also throw
// LinkError, and RefusedError, or FaultError if the card refuses because of a fault. A write is confirmed before it
// counts as made: if the bus does not report refusals, the driver reads REFUSAL after it, in the same transfer. The
// objects stay usable after any error. After a LinkError, a card on a new connection needs a new Card::open().
//
// Thread-safety: one thread at a time uses a card, its bus and its streams. Exception: any thread may call the
// request_...() functions while another thread is in a call that waits.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trammel/driver/axis_settings.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/captures.hpp"
#include "trammel/driver/card_state.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/drives.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/identification.hpp"
#include "trammel/driver/pwm.hpp"
#include "trammel/driver/roles.hpp"

namespace trammel::driver {

struct CardParts;

class Card {
 public:
  static constexpr std::uint32_t kFullRatio = driver::kFullRatio;      // in units of 2^-16
  static constexpr std::uint64_t kSlowestSlew = driver::kSlowestSlew;  // clocks

  // Reads the card's identification and step times; writes nothing. Throws IdentificationError unless the card is a
  // Trammel card whose map and commands this driver knows; the message names the mismatch and the supported value.
  // `bus` must outlive the card.
  static Card open(Bus& bus);
  ~Card();
  Card(Card&&) noexcept;
  Card& operator=(Card&&) noexcept;

  const Identification& identification() const;
  // Timing as read by open(), or as written by configure_axis() since.
  const CardTiming& timing() const;
  Bus& bus() const;

  // Makes one transfer. Call it only while the axis is at rest. Throws ArgumentError for an axis that the card lacks,
  // or a time that is negative or over 65535 clocks.
  void configure_axis(unsigned axis, const AxisSettings& settings);

  // Sets the ratio of the time base for pieces of a class: the fraction of clocks that are enabled, 2^-16, 0 ..
  // kFullRatio. On a card without classes, kFeed sets the ratio of all pieces, and the other classes throw
  // ArgumentError.
  void set_ratio(PieceClass piece_class, std::uint32_t ratio);
  void set_ratio(std::uint32_t ratio) { set_ratio(PieceClass::kFeed, ratio); }
  // The ratio that set_ratio() set last, or that another program set, if a wait has noticed it.
  std::uint32_t ratio(PieceClass piece_class = PieceClass::kFeed) const;
  // The ratio of an override, rounded. The host chooses the meaning of 100 %: `max_percent`, the largest override for
  // which its programs are planned, corresponds to the full ratio. Throws ArgumentError unless 0 <= percent <=
  // max_percent.
  static std::uint32_t ratio_of(double percent, double max_percent = 100);
  void set_override(PieceClass piece_class, double percent, double max_percent = 100) {
    set_ratio(piece_class, ratio_of(percent, max_percent));
  }
  // Time of a slew from ratio 0 to the full ratio, up to 2^30 clocks. The slew is rounded down, so it is never faster.
  // Times below 5 clocks give the card's fastest slew, 8 clocks.
  void set_slew_time(std::chrono::nanoseconds full_scale);
  // Holds or resumes: slews the time base to 0 or back to its ratio, after the end of fixed pieces that are under way.
  // Nothing is lost. Time-outs do not run during a hold.
  void set_hold(bool hold);
  // Takes over a card that another host has left: ends its hold, and drops the rest of a path on which the card holds.
  // Returns the state at rest if something was dropped. Throws StateError, and changes nothing, if the card moves
  // without a hold: then another program moves it. Other errors as stop().
  std::optional<Snapshot> take_over();
  // Longest time that a step may wait for the previous step; a longer wait is a step fault. 1 .. 65535 clocks, rounded
  // up.
  void set_longest_step_wait(std::chrono::nanoseconds longest);

  // Sets the watchdog: the card stops, with FAULT.watchdog, when this program has been silent for `time`. It stops on a
  // ramp unless STOP_REACTION selects otherwise. `time` is rounded up to 65,536 clocks; 0 switches the watchdog off.
  // Throws ArgumentError for a negative time or one over 65,535 * 65,536 clocks (43 s at 100 MHz).
  //
  // Calls that wait, and streams, restart the watchdog: they write it each time a quarter of `time` has passed. Choose
  // `time` longer than 4/3 of the time that the link may take to recover. WatchdogScope switches the watchdog off when
  // the motion is over. From map 3.5 on the card also stops (FAULT.link_loss) when none of this program's accesses has
  // arrived for `time` plus up to 65,536 clocks.
  void set_watchdog(std::chrono::nanoseconds time);

  // For any thread, and for signal handlers: asks the thread that is in a call that waits to call set_hold(hold) or
  // abort() at its next poll of the card. After an abort that call throws StateError. If no call waits, the next call
  // that waits serves the request. Of several hold requests the last one counts; an abort drops them.
  void request_hold(bool hold) noexcept;
  void request_abort() noexcept;
  // The same for stop(); the call that waits then throws StoppedError.
  void request_stop() noexcept;
  // The same for set_ratio(). Of several requests for a class the last one counts. A ratio or class that set_ratio()
  // would refuse is ignored.
  void request_ratio(PieceClass piece_class, std::uint32_t ratio) noexcept;

  // The state in one clock. Throws TimeoutError if the card does not deliver it.
  Snapshot read_snapshot();
  // The state that the card latched at the first cause of its present or last fault; zeros if there was none.
  Snapshot read_stop_snapshot();

  // The state in which the last stop left the card: the command under way, its remaining ticks, and positions. Throws
  // StateError while the card is stopping, ArgumentError if its map is older than 3.4.
  Rest read_rest();
  // Waits until a stop under way has ended (STATUS.stopping is 0). Then the card accepts commands once FAULT is clear,
  // and read_rest() is valid. Throws TimeoutError `margin` (card time) after the longest ramp.
  void wait_until_stopped(std::chrono::nanoseconds margin = std::chrono::seconds(1));

  Build read_build();

  Status read_status();
  bool busy() { return read_status().busy; }
  // Waits until the card is idle, then checks its identity and throws StateError if it was reset since open(). Throws
  // HeldError if the card is in a hold that this object has not set, FaultError when the card has a fault, TimeoutError
  // after `timeout` of card time outside holds. A ratio below 1 extends the timeout in proportion; a ratio of 0 counts
  // as a hold.
  void wait_until_idle(std::chrono::nanoseconds timeout);

  // Inputs and outputs of a card with path commands; on other cards these functions throw ArgumentError. Bit n: input n
  // after its polarity, output n.
  std::uint32_t read_inputs();
  std::uint16_t read_outputs();
  unsigned inputs_present();   // 1 .. 32; throws IdentificationError for another number
  unsigned outputs_present();  // 1 .. 16; throws as inputs_present()
  // Bit n: input n is inverted.
  void set_input_polarity(std::uint32_t inverted);

  // Machine inputs: filters and roles. Each function throws ArgumentError on a card without machine inputs.
  //
  // Levels before the filters; read_inputs() returns those after the filters.
  std::uint32_t read_raw_inputs();
  // Sets the filter of an input. A level that lasts at most `time` does not pass. A level that lasts `time`, rounded up
  // to 64 clocks, plus 64 clocks passes. 0: no filter. Throws ArgumentError for an input that the card lacks, or a time
  // that is negative or over 65,535 * 64 clocks (42 ms at 100 MHz).
  void set_input_filter(unsigned input, std::chrono::nanoseconds time);
  std::chrono::nanoseconds read_input_filter(unsigned input);  // rounded as above; `input`: 0 to 31
  // The value of INPUT_FILTER for `time`. Errors as set_input_filter().
  static std::uint32_t filter_scans(std::chrono::nanoseconds time, std::uint32_t clock_hz);
  // Assigns a role to the inputs in the mask, bit n: input n; 0: to none. The role is active while one of them is.
  // Throws ArgumentError for an axis or an input that the card lacks.
  void set_role(Role role, std::uint32_t inputs);
  std::uint32_t read_role(Role role);
  // The present state of the roles on which the card acts.
  ActiveRoles read_roles();
  // The limits and drives that caused the present fault.
  LimitState read_limit_state();
  // Selects the inputs' stop causes and the reactions to them. Makes two writes. Throws ArgumentError for axes that the
  // card lacks.
  void set_input_stops(const InputStops& stops);
  // Number of steps, 0 .. 65535, that the axis may make into an active limit on a ramp. One step more stops at once.
  void set_overtravel(unsigned axis, std::uint32_t steps);
  // Overrides active limits: they stop nothing until they are released. Bit n of `minus` and `plus`: axis n.
  void override_limits(std::uint8_t minus, std::uint8_t plus);

  // Captures: time and positions at an edge of an input. The length of the input's filter does not affect them. Each
  // function throws ArgumentError for a unit that the card lacks.
  unsigned captures_present() const;  // number of capture units, 0 to 4
  // Restarts the unit and drops its previous capture. An edge counts if the input was at the previous level for a whole
  // filter length before it; bounces after the first contact belong to the same edge. Throws ArgumentError for an input
  // that the card lacks.
  void select_capture(unsigned unit, const CaptureSelect& select);
  void stop_capture(unsigned unit);
  CaptureStates read_captures();
  // Returns the latched capture and clears it; nullopt if there is none.
  std::optional<Capture> take_capture(unsigned unit);
  // Waits for a capture and takes it. Throws TimeoutError after `timeout` of card time, InterruptedError if
  // interrupted().
  Capture wait_for_capture(unsigned unit, std::chrono::nanoseconds timeout);
  // The queue of captures, fed by units that were selected with `queue`. It holds at most 16, in the order in which
  // their filters confirmed them. A capture that does not fit is lost and counted; read_captures() shows which unit
  // lost captures, also because edges came too fast. Functions of the queue throw ArgumentError on a card without one.
  bool has_capture_queue() const;
  CaptureQueue read_capture_queue();
  // Takes the captures that are in the queue at the call, the oldest first. One program at a time may do so.
  std::vector<QueuedCapture> take_queued_captures();
  // Clears the latched captures and the overrun flags of the units in the mask.
  void clear_captures(unsigned units);
  // Whether the card itself compares positions with soft limits. This is the second guard, after the host, which
  // refuses moves beyond them.
  bool has_soft_limits() const;
  // Sets the soft limits, by axis of the card. Axes without a range, and axes beyond the end of `ranges`, get no
  // limits. Call it while the axes are at rest, and again whenever a position changes its meaning. An outward pulse
  // that ends beyond the range stops the card (FAULT.soft_limit), by default on a ramp. Throws ArgumentError on a card
  // without soft limits, for an axis that the card lacks, and for a plus below its minus.
  void set_soft_limits(const std::vector<std::optional<SoftRange>>& ranges);
  // Reads the soft limits from the card, one entry per axis. Throws ArgumentError on a card without soft limits.
  std::vector<std::optional<SoftRange>> read_soft_limits();
  // Selects whether soft limits stop the axes on a ramp (the default after a reset) or at once. Throws ArgumentError on
  // a card without soft limits.
  void set_soft_limit_ramps(bool ramp);

  // PWM on outputs. Writing a channel's period ends its pulse and restarts it. Makes one read and three writes. Throws
  // ArgumentError on a card without PWM, for outputs that it lacks, and for a period out of range.
  bool has_pwm() const;
  void set_pwm(const PwmChannels& channels);
  // Reads the channels from the card. Throws ArgumentError on a card without PWM.
  PwmChannels read_pwm();

  // Safe levels at rest: the levels that the outputs in `change` take at an abort, and when the card has come to rest
  // after a fault. Typical use: a spindle.
  void set_output_safe(std::uint16_t levels, std::uint16_t change);
  // Safe levels at the cause: the levels that the outputs in `change` take at an abort, and in the clock in which a
  // fault is latched. Typical use: a laser. They take precedence over the safe levels at rest, and stay until the stop
  // is over and the fault is cleared. Throws ArgumentError on a card whose map is older than 3.5.
  void set_output_safe_cause(std::uint16_t levels, std::uint16_t change);
  // Whether the card has a pin for an emergency stop. It is not a safety function (docs/user/outputs.md).
  bool has_emergency_stop() const;
  // Whether an emergency stop is latched; any press of the button latches it, however short. clear_faults() clears it
  // unless the pin is active. Throws ArgumentError on a card without an emergency stop.
  bool read_emergency_stop();
  // Selects whether the emergency stop stops the axes on a ramp or at once. Outputs with safe levels at the cause
  // change at once in both cases. Throws ArgumentError on a card without an emergency stop.
  void set_emergency_stop_ramps(bool ramp);

  // Drives and an emergency-stop chain. The functions throw ArgumentError on cards without the engine `enables`, for
  // outputs and axes that the card lacks, and for times out of range. A reset, a new host and clear_faults() enable
  // nothing.
  //
  // Selects the outputs that follow the drives and the card. Makes two writes.
  void set_output_roles(const OutputRoles& roles);
  // Sets the sequence of enable and brake. A new mask of axes takes effect when the card is at rest.
  void set_enable_sequence(const EnableSequence& sequence);
  // The host's request for enabled drives: true enables them now and keeps them enabled until false. Motion needs it
  // only if EnableSequence::manual is set.
  void enable(bool on);
  void set_health(const Health& health);
  // The number of MARK commands executed since reset, and the state latched by the last one.
  std::uint32_t read_marks();
  Snapshot read_mark_snapshot();

  // The state latched by the last probe's edge (Stream::probe() returns it); zeros if there was none.
  Snapshot read_probe_snapshot();
  // Leaves the state after a probe, so that the commands after PROBE_END run.
  void clear_probe();

  // FAULT; 0 if there is no fault.
  std::uint32_t read_faults();
  // The faults as text, from describe_faults(): names the axes and sides of limits and the axes of drives; "none" if
  // there is no fault.
  std::string read_fault_text();
  // The names of the axes, by number, in this object's messages about faults: of read_fault_text() and of FaultError.
  // An axis without a name is "axis N". Accesses no register.
  void name_axes(std::vector<std::string> names);
  // Clears all faults. Restarts an expired watchdog, or switches it off if this object has set none. During a stop it
  // first waits for the end, as wait_until_stopped(), so the card accepts commands afterwards. If the wait throws
  // (TimeoutError, InterruptedError), the faults stay. The fault of a drive that still reports it cannot be cleared.
  //
  // Clearing faults moves nothing: a fault has dropped all commands in the card. An abort may come before or after it,
  // or not at all. The stream restarts with number 0 (Stream::restart()).
  void clear_faults(std::chrono::nanoseconds margin = std::chrono::seconds(1));
  // The first refused access or command since the last clear that no RefusedError has reported. A refusal of the stream
  // stays until the stream is restarted.
  std::optional<Refusal> refusal();
  void clear_refusal();

  // Drops the queues, stops the path and reopens the stream. Positions are kept; faults stay latched.
  void abort();

  // Stops on the path: holds, aborts when the card is at rest, and ends the hold. Returns the state at the end, in
  // which the counts of begun commands are those before the abort. No pulse follows, and a stream may start from there.
  // Throws TimeoutError, and leaves the card in the hold, if the card is not at rest `margin` (card time) after the
  // ramp.
  Snapshot stop(std::chrono::nanoseconds margin = std::chrono::seconds(1));
  // Whether the card is in position: queues and shapers are empty, and nothing is under way. A card that holds on a
  // path is not in position.
  bool in_position() { return !busy(); }

  // The machine's place, which the card keeps for the next program. A reset of the card clears it. An axis loses both
  // bits of its Place by a fault of its drive; when its drive is disabled; and by an immediate stop while it moves,
  // that is an abort before it is at rest or a fault without a ramp. set_keeps_place() exempts axes from the last two.
  // Each function makes one access, whatever the state of the card; card_place.hpp reads the whole place at once. Each
  // throws ArgumentError on a card whose map is older than 3.3, which keeps no place.
  //
  // The axes whose place is valid, and those that were homed.
  Place read_place();
  // Writes both bits of the axes in `axes` (bit n: axis n); the other axes keep theirs. Call it only while these axes
  // are at rest: otherwise the write could hide a loss that the host has not seen. Throws ArgumentError for an axis
  // that the card lacks, and for `homed` without `valid`.
  void set_place(std::uint8_t axes, bool valid, bool homed);
  // Axes that keep their place at an immediate stop and when their drives are disabled, because their motors cannot
  // lose steps. Throws ArgumentError as above.
  std::uint8_t read_keeps_place();
  void set_keeps_place(std::uint8_t axes);
  // POSITION of the axis at machine coordinate 0, pulses, wrapping. pulses_between(zero, position) is the axis's
  // position. The card stores the value and does not use it. Throws ArgumentError for an axis that the card lacks.
  std::int32_t read_machine_zero(unsigned axis);
  void set_machine_zero(unsigned axis, std::int32_t pulses);
  // The host's hash of the scales in which it counts coordinates; 0: no place was set since the card's reset.
  std::uint32_t read_scales();
  void set_scales(std::uint32_t hash);

  // Access to the parts of the card, for code with its own way of moving the card and for tools that show registers:
  // low_level/card_parts.hpp.
  CardParts& parts() const { return *parts_; }

 private:
  explicit Card(std::unique_ptr<CardParts> parts);
  void wait_for_rest(std::uint64_t limit, bool held_is_rest);
  void check_capture(unsigned unit) const;
  void check_capture_queue() const;

  std::unique_ptr<CardParts> parts_;
};

}  // namespace trammel::driver
