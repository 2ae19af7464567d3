// One card: who it is, its settings, its state. Addresses and limits come from the generated card map.
//
// Units: times in nanoseconds of real time where a motor driver's data sheet gives them, else in card clocks; positions
// in pulses. Every argument is checked before the first access to the bus (ArgumentError). Errors besides those named:
// LinkError; RefusedError, or FaultError when the card refuses because of a fault. A write is confirmed before it
// counts as made: where the bus does not report refusals, the driver reads REFUSAL behind it, in the same transfer.
// After any error the objects stay usable; after a LinkError, a card on a new connection is opened anew.
//
// Thread-safety: one thread at a time uses a card, its bus and its streams, but for request_hold(), request_ratio() and
// request_abort(), which any thread may call while another one is in a call that waits.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "trammel/card_map.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/unit_table.hpp"

namespace trammel::driver {

// What the card says of itself.
struct Identification {
  std::uint16_t map_major = 0;
  std::uint16_t map_minor = 0;
  std::uint32_t commands_version = 0;
  unsigned axes = 0;                 // 1 .. 8
  std::uint32_t clock_hz = 0;        // Hz
  UnitTable units;                   // what it is built of
  std::uint32_t engines = 0;         // the same as card_map::engine's bits
  std::uint32_t geometry_depth = 0;  // halfwords
  std::uint32_t feed_depth = 0;      // halfwords
};

// What it was made of.
struct Build {
  std::uint32_t id = 0;     // of the sources; 0 where nobody said
  bool dirty = false;       // one of them was changed
  std::uint32_t board = 0;  // docs/user/boards.md; 0 where nobody said
};

enum class StepMode : std::uint8_t { kStepDirection = 0, kUpDown = 1, kQuadrature = 2 };

// Settings of an axis. Times are those of the motor driver's data sheet; the card keeps at least these: clocks are
// rounded up, 0 .. 65535 clocks each. A step pulse and its space last at least 1 clock.
struct AxisSettings {
  std::chrono::nanoseconds step_length{0};      // the pulse
  std::chrono::nanoseconds step_space{0};       // trailing edge to the next leading edge
  std::chrono::nanoseconds direction_setup{0};  // direction stable before the leading edge
  std::chrono::nanoseconds direction_hold{0};   // and after the trailing edge
  StepMode mode = StepMode::kStepDirection;
  bool invert_first = false;   // pin STEP, UP or A
  bool invert_second = false;  // pin DIR, DOWN or B
};

// STATUS.
struct Status {
  bool busy = false;          // something runs or is queued
  bool direct = false;        // a one-shot line runs
  bool path_active = false;   // a path is under way
  bool feed_active = false;   // a feed piece is under way
  bool held = false;          // the time base's ratio is 0
  bool ended = false;         // END was reached
  bool faulted = false;       // FAULT is not 0
  bool refused = false;       // REFUSAL is not 0
  bool snapshot = false;      // a snapshot is under way
  bool incomplete = false;    // the stream stands inside a command
  bool stopping = false;      // on a ramp to a stop
  bool geometry_low = false;  // fewer halfwords queued than the queue's watermark
  bool feed_low = false;
  bool probed = false;        // a probe has tripped, until clear_probe()
  bool probe_missed = false;  // probing paths ended without an edge
  bool waiting = false;       // for an input
};

// REFUSAL.
struct Refusal {
  std::uint8_t reason = 0;          // value of card_map::Reason, not 0
  std::uint8_t command_number = 0;  // of a stream command
  std::uint32_t address = 0;        // byte address of the access
};

// State of one clock.
struct Snapshot {
  std::uint64_t time = 0;                                   // clocks since reset
  Status status;                                            //
  std::uint32_t faults = 0;                                 // FAULT
  std::uint32_t rate = 0;                                   // 2^-32 feed ticks an enabled clock
  std::uint32_t ratio = 0;                                  // 2^-16, of the time base
  std::uint32_t geometry_begun = 0;                         // commands begun from the geometry queue since the last cut
  std::uint32_t feed_begun = 0;                             // and from the feed queue
  std::array<std::int32_t, card_map::kMaxAxes> position{};  // pulses, wrapping; 0 for axes that the card lacks
};

// Pulses from one position of an axis to another. The counters wrap: for distances below 2^31.
constexpr std::int32_t pulses_between(std::int32_t from, std::int32_t to) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}

// A count of the card, which has 32 bits, carried on from `before`: for less than 2^32 more.
constexpr std::uint64_t count_after(std::uint64_t before, std::uint32_t counter) {
  return before + (counter - static_cast<std::uint32_t>(before));
}

// Names of the fault bits, for messages: "step fault of axis 2, TICK_MISMATCH".
std::string describe_faults(std::uint32_t faults);
// Name of a refusal reason and what it means.
std::string describe_reason(std::uint8_t reason);

class Card {
 public:
  // Full ratio of the time base: every clock is enabled.
  static constexpr std::uint32_t kFullRatio = 0x10000;
  // Longest time from no ratio to the full one, clocks.
  static constexpr std::uint64_t kSlowestSlew = std::uint64_t{card_map::constant::kSlewClocks}
                                                << card_map::constant::kSlewFractionBits;

  // Reads who the card is and its step times. Throws IdentificationError, naming what does not fit and what would,
  // unless it is a Trammel card with a map and commands that this driver knows. Writes nothing.
  // `bus` must outlive the card.
  static Card open(Bus& bus);

  const Identification& identification() const { return identification_; }
  // As read by open() or written by configure_axis() since.
  const CardTiming& timing() const { return timing_; }
  Bus& bus() const { return *bus_; }

  // One transfer; only while the axis stands. Throws ArgumentError for an axis that the card lacks, a negative time or
  // one over 65535 clocks.
  void configure_axis(unsigned axis, const AxisSettings& settings);

  // Time base: share of clocks that are enabled, 2^-16, 0 .. kFullRatio, in pieces of a class; on a card without
  // classes feed's is that of all pieces, and the others throw ArgumentError.
  void set_ratio(PieceClass piece_class, std::uint32_t ratio);
  void set_ratio(std::uint32_t ratio) { set_ratio(PieceClass::kFeed, ratio); }
  // As set_ratio() has set it last, or as somebody else has, where a wait has found that.
  std::uint32_t ratio(PieceClass piece_class = PieceClass::kFeed) const {
    return ratios_[has_engine(card_map::engine::kClasses) ? static_cast<std::size_t>(piece_class) : 0];
  }
  // The ratio of an override. What is 100 % is the host's convention: `most_percent`, the largest override that its
  // programs are planned for, is the full ratio. Rounded. Throws ArgumentError unless 0 <= percent <= most_percent.
  static std::uint32_t ratio_of(double percent, double most_percent = 100);
  void set_override(PieceClass piece_class, double percent, double most_percent = 100) {
    set_ratio(piece_class, ratio_of(percent, most_percent));
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

  // From any thread (and from a signal handler): what the thread that is in a call that waits shall do at its next look
  // at the card: set_hold(hold), or abort(), after which its call throws StateError. Where no call waits, the next one
  // that does finds the request. Of several holds the last counts; an abort drops them.
  void request_hold(bool hold) noexcept { requests_->hold.store(hold ? 1 : 0); }
  void request_abort() noexcept { requests_->abort.store(true); }
  // Likewise stop(), after which its call throws StoppedError.
  void request_stop() noexcept { requests_->stop.store(true); }
  // Likewise set_ratio(); of several for a class the last counts. A ratio that it would not take is left out.
  void request_ratio(PieceClass piece_class, std::uint32_t ratio) noexcept {
    requests_->ratio[static_cast<std::size_t>(piece_class)].store(ratio);
  }

  // All of one clock. Throws TimeoutError if the card does not come up with it.
  Snapshot snapshot();
  // What the card latched when it was stopped by the first cause of its present or last fault; zeros if there was none.
  Snapshot stop_snapshot();

  Build build();

  Status status();
  bool busy() { return status().busy; }
  // Waits until the card is idle, and then for its identity: StateError if it was reset since. Throws HeldError where
  // it stands in a hold that this object has not set, FaultError once it is faulted, TimeoutError after `timeout` of
  // card time in which it was not held. Where the ratio is below 1 the timeout is stretched by as much; a ratio of 0 is
  // a hold.
  void wait_until_idle(std::chrono::nanoseconds timeout);

  // Inputs and outputs, of a card with path commands; else ArgumentError. Bit n: input n after its polarity, output n.
  std::uint16_t inputs();
  std::uint16_t outputs();
  unsigned inputs_present();  // how many it has, 1 .. 16; IdentificationError for another number
  unsigned outputs_present();
  // Which inputs are inverted.
  void set_input_polarity(std::uint16_t inverted);
  // Levels that the outputs in `change` take at an abort and at a fault.
  void set_output_safe(std::uint16_t levels, std::uint16_t change);
  // MARKs passed since reset, and what the last one latched.
  std::uint32_t marks();
  Snapshot mark_snapshot();

  // What the last probe's edge latched (Stream::probe() gives it); zeros where there was none.
  Snapshot probe_snapshot();
  // Leaves the state after a probe: commands behind PROBE_END go on.
  void clear_probe();

  // FAULT, 0 if there is none.
  std::uint32_t faults();
  // Clears all faults. Nothing moves by it: a fault has dropped all that the card had, and an abort may come before,
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
  // from there. Throws TimeoutError, the card still holding, where it is not at rest `patience` (card time) after the
  // ramp.
  Snapshot stop(std::chrono::nanoseconds patience = std::chrono::seconds(1));
  // In position: the queues and the shapers are empty, and nothing runs. A card that holds with a path under way is
  // not.
  bool in_position() { return !busy(); }

  // The rest is for what is built on cards: streams, lines.

  // Makes the accesses in one transfer, and sees to it that none was refused: else RefusedError, or FaultError.
  // `accesses` has room for count + 1. `context` names the operation in messages.
  void transfer(Access* accesses, std::size_t count, std::string_view context);
  // Likewise for words of the stream: whatever was refused since the stream was opened counts.
  void transfer_stream(Access* accesses, std::size_t count);
  // One read of a register.
  std::uint32_t read(std::uint32_t address);
  // Throws LinkError where a value has bits without meaning in that register: what answers is not the card.
  static void check_read(const Access& access);
  // Of a value read from STATUS.
  Status status_of(const Access& access) const;
  // Throws LinkError if what answers is no card any more, StateError if it has other step times than it was given.
  void check_identity();
  // Throws FaultError if the card is faulted; reads FAULT only if `status` says so.
  void throw_if_faulted(const Status& status, std::string_view context);
  // Throws HeldError if the card holds, whoever has made it.
  void throw_if_held(std::string_view context);
  // Whether set_hold(true) of this object, or a request, was its last word.
  bool holds_by_this_program() const { return own_hold_.value_or(false); }
  // Throws what a refusal means: FaultError for the reason FAULTED, else RefusedError.
  [[noreturn]] void throw_refused(const Refusal& refusal, std::string_view context);
  // Somebody else has set this ratio.
  void note_ratio(PieceClass piece_class, std::uint32_t ratio) {
    ratios_[static_cast<std::size_t>(piece_class)] = ratio;
  }
  // Does what other threads have asked for. Throws StateError after an abort, StoppedError after a stop, also after the
  // one that an InterruptScope asks for.
  void serve_requests();
  // Lets up to `clocks` pass: fewer only where the bus has an interrupt and the card is faulted, refuses something or
  // gets to what `wake` asks for, by the bits of IRQ_ENABLE. True for the interrupt.
  bool pause(std::uint64_t clocks, std::uint32_t wake);
  // Whether a wait for room in the queues can end by an interrupt.
  bool tells_of_room() const { return bus_->has_interrupt() && has_engine(card_map::engine::kWatermarks); }
  // What to wake for in pause(), so that it ends when the queues have this much room, halfwords (0: whatever they
  // have). Sets their watermarks. Only where tells_of_room().
  std::uint32_t wake_at_room(std::uint32_t geometry, std::uint32_t feed);

  // Nanoseconds to card clocks, rounded up. Throws ArgumentError for a negative time or one of 2^63 clocks or more;
  // `what` names it in the message.
  std::uint64_t clocks(std::chrono::nanoseconds time, const char* what) const;
  // A pause between two looks at the card, clocks: 50 microseconds, at least 64 clocks.
  std::uint64_t poll_interval() const;

 private:
  struct Requests {
    static constexpr std::uint32_t kNoRatio = ~std::uint32_t{0};
    std::atomic<int> hold{-1};  // 1 hold, 0 go on, -1 nothing asked
    std::array<std::atomic<std::uint32_t>, kPieceClasses> ratio{kNoRatio, kNoRatio, kNoRatio};
    std::atomic<bool> abort{false};
    std::atomic<bool> stop{false};
  };

  explicit Card(Bus& bus) : bus_(&bus), requests_(std::make_shared<Requests>()) {}
  void write(std::uint32_t address, std::uint32_t value, std::string_view context);
  void wait_for_rest(std::uint64_t limit, bool held_is_rest);
  [[noreturn]] void stop_on_request(const char* why);
  unsigned pins_present(std::uint32_t mask, std::uint32_t shift, const char* pins);
  std::size_t checked_transfer(Access* accesses, std::size_t count);
  void confirmed_transfer(Access* accesses, std::size_t count, bool confirm, std::string_view context);
  std::optional<Refusal> latched_refusal();
  void forget_latched_refusal();
  void keep_earlier_refusal();
  [[noreturn]] void throw_refused_access(const Access& access, std::string_view context);
  void enable_interrupts(std::uint32_t wake);
  bool has_engine(std::uint32_t engine) const { return card_map::has_engine(identification_.engines, engine); }
  Snapshot read_area(card_map::Area area);
  void require_path_commands(std::string_view what) const;

  Bus* bus_;
  Identification identification_;
  CardTiming timing_;
  std::array<std::uint32_t, kPieceClasses> ratios_{kFullRatio, kFullRatio, kFullRatio};
  std::optional<bool> own_hold_;             // HOLD as this object has written it last
  std::optional<Refusal> earlier_;           // taken from the card and not reported yet
  std::optional<std::uint32_t> irq_enable_;  // as written last, and so the watermarks
  std::optional<std::uint32_t> geometry_watermark_;
  std::optional<std::uint32_t> feed_watermark_;
  std::shared_ptr<Requests> requests_;
};

}  // namespace trammel::driver
