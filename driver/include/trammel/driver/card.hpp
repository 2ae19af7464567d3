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

#include "trammel/driver/axis_settings.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/card_state.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/identification.hpp"

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
  // link may take to recover. WatchdogScope switches it off again where the motion is over. Throws ArgumentError for a
  // negative time or one over 65,535 * 65,536 clocks (43 s at 100 MHz).
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

  Build read_build();

  Status read_status();
  bool busy() { return read_status().busy; }
  // Waits until the card is idle, and then for its identity: StateError if it was reset since. Throws HeldError where
  // it stands in a hold that this object has not set, FaultError once it is faulted, TimeoutError after `timeout` of
  // card time in which it was not held. Where the ratio is below 1 the timeout is stretched by as much; a ratio of 0 is
  // a hold.
  void wait_until_idle(std::chrono::nanoseconds timeout);

  // Inputs and outputs, of a card with path commands; else ArgumentError. Bit n: input n after its polarity, output n.
  std::uint16_t read_inputs();
  std::uint16_t read_outputs();
  unsigned inputs_present();  // how many it has, 1 .. 16; IdentificationError for another number
  unsigned outputs_present();
  // Which inputs are inverted.
  void set_input_polarity(std::uint16_t inverted);
  // Levels that the outputs in `change` take at an abort and at a fault.
  void set_output_safe(std::uint16_t levels, std::uint16_t change);
  // MARKs passed since reset, and what the last one latched.
  std::uint32_t read_marks();
  Snapshot read_mark_snapshot();

  // What the last probe's edge latched (Stream::probe() gives it); zeros where there was none.
  Snapshot read_probe_snapshot();
  // Leaves the state after a probe: commands behind PROBE_END go on.
  void clear_probe();

  // FAULT, 0 if there is none.
  std::uint32_t read_faults();
  // Clears all faults; a watchdog that has expired starts anew with it, or is off where this object has set none.
  // Nothing moves by it: a fault has dropped all that the card had, and an abort may come before,
  // after or not at all. The stream begins with number 0 (Stream::restart()).
  void clear_faults();
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

  // For code that moves the card in a way of its own, and for tools that show registers: low_level/card_parts.hpp.
  CardParts& parts() const { return *parts_; }

 private:
  explicit Card(std::unique_ptr<CardParts> parts);
  void wait_for_rest(std::uint64_t limit, bool held_is_rest);

  std::unique_ptr<CardParts> parts_;
};

}  // namespace trammel::driver
