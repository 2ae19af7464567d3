// One card: who it is, its settings, its state. Addresses and limits come from the generated card map.
//
// Units: times in nanoseconds of real time where a motor driver's data sheet gives them, else in card clocks; positions
// in pulses. Every argument is checked before the first access to the bus (ArgumentError). Errors besides those named:
// LinkError; RefusedError, or FaultError when the card refuses because of a fault. A write is confirmed before it
// counts as made: where the bus does not report refusals, the driver reads REFUSAL behind it, in the same transfer.
// After any error the objects stay usable; after a LinkError, a card on a new connection is opened anew.
//
// Thread-safety: one thread at a time uses a card, its bus and its streams, but for the request_...() functions, which
// any thread may call while another one is in a call that waits.
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
  static constexpr std::uint32_t kFullRatio = driver::kFullRatio;      // 2^-16
  static constexpr std::uint64_t kSlowestSlew = driver::kSlowestSlew;  // clocks

  // Reads who the card is and its step times. Throws IdentificationError, naming what does not fit and what would,
  // unless it is a Trammel card with a map and commands that this driver knows. Writes nothing.
  // `bus` must outlive the card.
  static Card open(Bus& bus);
  ~Card();
  Card(Card&&) noexcept;
  Card& operator=(Card&&) noexcept;

  const Identification& identification() const;
  // As read by open() or written by configure_axis() since.
  const CardTiming& timing() const;
  Bus& bus() const;

  // One transfer; only while the axis stands. Throws ArgumentError for an axis that the card lacks, a negative time or
  // one over 65535 clocks.
  void configure_axis(unsigned axis, const AxisSettings& settings);

  // Time base: share of clocks that are enabled, 2^-16, 0 .. kFullRatio, in pieces of a class; on a card without
  // classes feed's is that of all pieces, and the others throw ArgumentError.
  void set_ratio(PieceClass piece_class, std::uint32_t ratio);
  void set_ratio(std::uint32_t ratio) { set_ratio(PieceClass::kFeed, ratio); }
  // As set_ratio() has set it last, or as somebody else has, where a wait has found that.
  std::uint32_t ratio(PieceClass piece_class = PieceClass::kFeed) const;
  // The ratio of an override. What is 100 % is the host's convention: `max_percent`, the largest override that its
  // programs are planned for, is the full ratio. Rounded. Throws ArgumentError unless 0 <= percent <= max_percent.
  static std::uint32_t ratio_of(double percent, double max_percent = 100);
  void set_override(PieceClass piece_class, double percent, double max_percent = 100) {
    set_ratio(piece_class, ratio_of(percent, max_percent));
  }
  // Time that the ratio takes from 0 to full, up to 2^30 clocks; the slew is rounded down, to one that is no faster.
  // Times under 5 clocks give the card's fastest slew, 8 clocks.
  void set_slew_time(std::chrono::nanoseconds full_scale);
  // A hold: slews the time base to 0 (or back to its ratio), once the fixed pieces that are under way have ended.
  // Nothing is lost; time-outs do not run in a hold.
  void set_hold(bool hold);
  // Takes over a card that another host has left: ends a hold that stands, and drops what is left of a path on which
  // the card holds. Gives back the state at rest where something was dropped. Throws StateError, and changes nothing,
  // where the card moves and does not hold: somebody else moves it. Else errors as stop().
  std::optional<Snapshot> take_over();
  // Longest time that a step may wait for the one before it; longer is a step fault. 1 .. 65535 clocks, rounded up.
  void set_longest_step_wait(std::chrono::nanoseconds longest);

  // The card stops by itself, on a ramp unless STOP_REACTION says otherwise, when this program has been silent for
  // `time`: FAULT then says WATCHDOG. Rounded up to 65,536 clocks; 0 switches it off. Calls that wait, and streams,
  // keep it from expiring: they write it after a quarter of `time`, so choose it longer than 4/3 of the time that the
  // link may take to recover. WatchdogScope switches it off again where the motion is over. From map 3.5 on the card
  // stops likewise (LINK_LOSS) when none of this program's accesses has come for `time` and up to 65,536 clocks more.
  // Throws ArgumentError for a negative time or one over 65,535 * 65,536 clocks (43 s at 100 MHz).
  void set_watchdog(std::chrono::nanoseconds time);

  // From any thread (and from a signal handler): what the thread that is in a call that waits shall do at its next look
  // at the card: set_hold(hold), or abort(), after which its call throws StateError. Where no call waits, the next one
  // that does finds the request. Of several holds the last counts; an abort drops them.
  void request_hold(bool hold) noexcept;
  void request_abort() noexcept;
  // Likewise stop(), after which its call throws StoppedError.
  void request_stop() noexcept;
  // Likewise set_ratio(); of several for a class the last counts. A ratio that it would not take is left out.
  void request_ratio(PieceClass piece_class, std::uint32_t ratio) noexcept;

  // All of one clock. Throws TimeoutError if the card does not come up with it.
  Snapshot read_snapshot();
  // What the card latched when it was stopped by the first cause of its present or last fault; zeros if there was none.
  Snapshot read_stop_snapshot();

  // Where the last stop has left the card: the command under way, its ticks that are left, and positions. Throws
  // StateError while the card is on its way to a stop, ArgumentError where its map is older than 3.4.
  Rest read_rest();
  // Waits until a stop under way (STATUS.stopping) has ended: commands are taken again once FAULT is clear, and
  // read_rest() tells where the card is. Throws TimeoutError `margin` (card time) after the longest ramp.
  void wait_until_stopped(std::chrono::nanoseconds margin = std::chrono::seconds(1));

  Build read_build();

  Status read_status();
  bool busy() { return read_status().busy; }
  // Waits until the card is idle, and then for its identity: StateError if it was reset since. Throws HeldError where
  // it stands in a hold that this object has not set, FaultError once it is faulted, TimeoutError after `timeout` of
  // card time in which it was not held. Where the ratio is below 1 the timeout is stretched by as much; a ratio of 0 is
  // a hold.
  void wait_until_idle(std::chrono::nanoseconds timeout);

  // Inputs and outputs, of a card with path commands; else ArgumentError. Bit n: input n after its polarity, output n.
  std::uint32_t read_inputs();
  std::uint16_t read_outputs();
  unsigned inputs_present();   // how many it has, 1 .. 32; IdentificationError for another number
  unsigned outputs_present();  // likewise, 1 .. 16
  // Which inputs are inverted.
  void set_input_polarity(std::uint32_t inverted);

  // Machine inputs: filters and roles. Each function throws ArgumentError where the card has none.
  //
  // Levels before the filters; read_inputs() gives those behind them.
  std::uint32_t read_raw_inputs();
  // A level that lasts at most `time` does not pass; one that lasts 64 clocks more than `time`, rounded up to 64
  // clocks, does. 0: no filter. Throws ArgumentError for an input that the card lacks, a negative time or one over
  // 65,535 * 64 clocks (42 ms at 100 MHz).
  void set_input_filter(unsigned input, std::chrono::nanoseconds time);
  std::chrono::nanoseconds read_input_filter(unsigned input);  // rounded as above; `input`: 0 to 31
  // What INPUT_FILTER holds for `time`; errors as above.
  static std::uint32_t filter_scans(std::chrono::nanoseconds time, std::uint32_t clock_hz);
  // Which inputs have the role, bit n: input n; it is active while one of them is. 0: none has it. Throws ArgumentError
  // for an axis or an input that the card lacks.
  void set_role(Role role, std::uint32_t inputs);
  std::uint32_t read_role(Role role);
  // Roles that the card acts on, as they are now.
  ActiveRoles read_roles();
  // What brought the fault that stands.
  LimitState read_limit_state();
  // What of the inputs stops the card, and how. Two writes; ArgumentError for axes that the card lacks.
  void set_input_stops(const InputStops& stops);
  // Steps into an active limit that the axis may make on a ramp; one more stops at once. 0 .. 65535.
  void set_overtravel(unsigned axis, std::uint32_t steps);
  // Limits that are active now and stop nothing until they are released: bit n of `minus`, `plus` is axis n.
  void override_limits(std::uint8_t minus, std::uint8_t plus);

  // Captures: time and positions of an input's edge, as the pins were at it and however long its filter is. Each
  // function throws ArgumentError for a unit that the card lacks.
  //
  unsigned captures_present() const;  // units, 0 to 4
  // The unit begins anew, and drops what it had. An edge counts after its input has been quiet, at the level before it
  // for a whole filter length; bounces behind the first touch belong to it. ArgumentError for an input that the card
  // lacks.
  void select_capture(unsigned unit, const CaptureSelect& select);
  void stop_capture(unsigned unit);
  CaptureStates read_captures();
  // The capture that stands, which is cleared with it; none where there is none.
  std::optional<Capture> take_capture(unsigned unit);
  // The same, as soon as there is one. Throws TimeoutError after `timeout` of card time, InterruptedError where
  // interrupted() says so.
  Capture wait_for_capture(unsigned unit, std::chrono::nanoseconds timeout);
  // The queue of captures, of units that were selected with `queue`: 16 at most, in the order in which their filters
  // passed. What does not fit is lost, and is counted; read_captures() says of which unit, and of which one edges came
  // too fast. ArgumentError where the card has no queue.
  bool has_capture_queue() const;
  CaptureQueue read_capture_queue();
  // Those that were in it at the call, the oldest first, which leave it; one program at a time.
  std::vector<QueuedCapture> take_queued_captures();
  // The overruns that read_captures() shows begin anew, of the units of the mask, with what stands with them.
  void clear_captures(unsigned units);
  // Whether the card compares positions with soft limits itself: the last guard, behind the host that refuses such
  // moves.
  bool has_soft_limits() const;
  // By axis of the card; the axes without a range, and those behind the last one, have none then. Write it while the
  // axes stand, and anew when a position gets another meaning. A pulse further out than a range stops the card
  // (FAULT.soft_limit), by default on a ramp. Throws ArgumentError where the card has none, for an axis that it lacks,
  // and for a plus below its minus.
  void set_soft_limits(const std::vector<std::optional<SoftRange>>& ranges);
  // As the card has them, one for each of its axes. ArgumentError where it has none.
  std::vector<std::optional<SoftRange>> read_soft_limits();
  // How they stop the axes; on a ramp after a reset. ArgumentError where the card has none.
  void set_soft_limit_ramps(bool ramp);

  // Pulses on outputs. A channel whose period is written ends its pulse and begins anew. ArgumentError where the card
  // has none, for outputs that it lacks and for a period beyond its limits. One read and three writes.
  bool has_pwm() const;
  void set_pwm(const PwmChannels& channels);
  // As they stand in the card. ArgumentError where it has none.
  PwmChannels read_pwm();

  // Levels that the outputs in `change` take when the card has come to rest after a fault, and at an abort: a spindle.
  void set_output_safe(std::uint16_t levels, std::uint16_t change);
  // The same for the cause of a fault, in the clock in which it is latched, and at an abort: a laser. They go before
  // the others, and stay until the stop is over and the fault is cleared. Throws ArgumentError on a card with a map
  // before 3.5.
  void set_output_safe_cause(std::uint16_t levels, std::uint16_t change);
  // Whether the card has a pin for an emergency stop. It is not a safety function (docs/user/outputs.md).
  bool has_emergency_stop() const;
  // Whether one stands: the button was pressed, however briefly. clear_faults() clears it, but not while the pin is
  // active. Throws ArgumentError on a card without an emergency stop.
  bool read_emergency_stop();
  // How the emergency stop stops the axes; outputs that are safe at the cause change at once either way. Throws
  // ArgumentError on a card without an emergency stop.
  void set_emergency_stop_ramps(bool ramp);

  // Drives and an emergency-stop chain, on cards with the engine enables; ArgumentError on others, for outputs and axes
  // that the card lacks and for times that it does not take. Nothing is enabled by a reset, a new host or
  // clear_faults().
  //
  // Which outputs follow the drives and the card. Two writes.
  void set_output_roles(const OutputRoles& roles);
  // The sequence of enable and brake. A new mask of axes counts once the card rests.
  void set_enable_sequence(const EnableSequence& sequence);
  // The host's order: the drives are enabled now, and stay so until it is taken back. Motion needs none unless
  // EnableSequence::manual says so.
  void enable(bool on);
  void set_health(const Health& health);
  // MARKs passed since reset, and what the last one latched.
  std::uint32_t read_marks();
  Snapshot read_mark_snapshot();

  // What the last probe's edge latched (Stream::probe() gives it); zeros where there was none.
  Snapshot read_probe_snapshot();
  // Leaves the state after a probe: commands behind PROBE_END go on.
  void clear_probe();

  // FAULT, 0 if there is none.
  std::uint32_t read_faults();
  // The same as text, by describe_faults(), with the axes and sides of limits and the axes of drives; "none". `axes`:
  // their names, as there.
  std::string read_fault_text(const std::vector<std::string>& axes = {});
  // Clears all faults; a watchdog that has expired starts anew with it, or is off where this object has set none. On
  // the ramp of a fault it waits for the end first, as wait_until_stopped(): the card takes commands from then on.
  // Where that throws (TimeoutError, InterruptedError) the faults stay. Nothing moves by it: a fault has dropped all
  // that the card had, and an abort may come before, after or not at all. The stream begins with number 0
  // (Stream::restart()). The fault of a drive that still reports it cannot be cleared.
  void clear_faults(std::chrono::nanoseconds margin = std::chrono::seconds(1));
  // The first access or command refused since the last clear that no RefusedError has reported; one of the stream stays
  // until the stream is restarted.
  std::optional<Refusal> refusal();
  void clear_refusal();

  // Drops the queues, stops the path and reopens the stream. Positions stay; faults stay latched.
  void abort();

  // Stops on the path: a hold, and when the card is at rest an abort; the hold is then over. Gives back the state at
  // the end, with the commands begun as they stood before the abort: no pulse comes after it, and a stream may begin
  // from there. Throws TimeoutError, the card still holding, where it is not at rest `margin` (card time) after the
  // ramp.
  Snapshot stop(std::chrono::nanoseconds margin = std::chrono::seconds(1));
  // In position: the queues and the shapers are empty, and nothing runs. A card that holds with a path under way is
  // not.
  bool in_position() { return !busy(); }

  // The machine's place: what the card keeps for whoever uses it next. A reset of the card clears all of it. An axis
  // loses both bits of its Place by a fault of its drive, and by an immediate stop while it moves: an abort before it
  // is at rest, or a fault without a ramp. One access each, whatever the card does. card_place.hpp reads all of it at
  // once. Each throws ArgumentError on a card with a map before 3.3, which keeps no place.
  //
  // Which axes' places are valid, and which were homed.
  Place read_place();
  // Writes both bits of the axes in `axes` (bit n: axis n); the others keep theirs. Only while these axes stand: a loss
  // that the host has not seen would be hidden. Throws ArgumentError for an axis that the card lacks, and for one that
  // is homed and not valid.
  void set_place(std::uint8_t axes, bool valid, bool homed);
  // Axes whose place outlives an immediate stop, since their motors cannot lose steps. ArgumentError as above.
  std::uint8_t read_keeps_place();
  void set_keeps_place(std::uint8_t axes);
  // POSITION of the axis at the machine's coordinate 0, pulses, wrapping: pulses_between(zero, position) is where the
  // axis stands. The card keeps it and does not look at it. Throws ArgumentError for an axis that the card lacks.
  std::int32_t read_machine_zero(unsigned axis);
  void set_machine_zero(unsigned axis, std::int32_t pulses);
  // The host's hash of the scales that it counts coordinates in; 0: nobody has set a place since the card's reset.
  std::uint32_t read_scales();
  void set_scales(std::uint32_t hash);

  // For code that moves the card in a way of its own, and for tools that show registers: low_level/card_parts.hpp.
  CardParts& parts() const { return *parts_; }

 private:
  explicit Card(std::unique_ptr<CardParts> parts);
  void wait_for_rest(std::uint64_t limit, bool held_is_rest);
  void check_capture(unsigned unit) const;
  void check_capture_queue() const;

  std::unique_ptr<CardParts> parts_;
};

}  // namespace trammel::driver
