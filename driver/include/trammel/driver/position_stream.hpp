// Position streaming: a host with a servo cycle (1 kHz or so) gives the card, in each of its periods, where the axes
// shall be at the period's end, and the card goes there in a straight line. Cards with the engine `streaming`.
//
// Units. Positions: 2^-24 pulses, counted from where each axis stood when the stream was opened. Times: card clocks, or
// nanoseconds; a stream runs at the full ratio, where each clock counts. Ticks (of the results): 2 clocks each.
//
// No error adds up. A period's line ends at the rounded target, so that an axis is never more than half a pulse from
// where it was told to be at the end of a period, and never more than one from the straight line between two such
// places. Clocks, and nanoseconds that make no whole clock, are carried over exactly: the end of a period is never more
// than a tick from the sum of all durations.
//
// A late period. If the next period is not there when the last one ends, the card goes on along that line, in all for
// `stale_periods` times its duration. The excess distance and time are known to the tick when the next period has been
// sent. They are taken off the periods after that, off durations and distances alike, so that the speed stays, at most
// half a period's duration at a time. A period that comes later than that is missing: the card ramps down along the
// line (by the slew), and every call throws FaultError with the bit kFaultMissingPeriod, until recover().
//
// Soft limits. Where the card compares positions with soft limits (Card::set_soft_limits), a period after which it
// could not come to rest inside is refused: speed times half of the slew's time, and the stale periods. So a stream
// whose host falls silent ends before the limit. They are read when the stream is opened and at recover(): set them,
// and the slew, before.
//
// Thread-safety: as of the card: one thread at a time. Nothing is allocated for a period.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "trammel/driver/card.hpp"

namespace trammel::driver {

class StreamLimits;

struct PositionStreamOptions {
  // Periods that the card may go on for along the last line, 0 .. 255.
  unsigned stale_periods = 1;
  // Periods that are sent before the card begins with the first one, at least 1. The host may be late by this time. It
  // is also the delay from sending a period to its beginning.
  unsigned ahead = 2;
  // Largest speed of each axis, pulses/s; 0: as fast as the card and its step times allow.
  std::array<double, card_map::kMaxAxes> max_speed{};
  // How much longer than what is queued the card may take to come to rest before it counts as hung.
  std::chrono::nanoseconds margin = std::chrono::seconds(1);
};

class PositionStream {
 public:
  static constexpr unsigned kFractionBits = 24;
  static constexpr std::int64_t kPulse = std::int64_t{1} << kFractionBits;
  static constexpr std::uint64_t kClocksPerTick = 2;

  using Positions = std::array<std::int64_t, card_map::kMaxAxes>;  // 2^-24 pulses; axes that the card lacks: 0

  // What the card says when a period has been sent.
  struct Sent {
    std::uint64_t ahead = 0;        // periods queued that have not begun
    std::uint64_t stale_ticks = 0;  // ticks that the card had gone on for when this period came; 0: it was in time
  };
  // Where the card stands after a fault.
  struct Stopped {
    std::uint32_t faults = 0;       // FAULT
    std::uint64_t stale_ticks = 0;  // ticks that it went on for after the last period; 0 but for a missing period
    Positions positions{};          // whole pulses
  };

  // Opens the stream where the axes stand: queued commands are dropped, numbers begin anew. A missing period stops on a
  // ramp. Throws ArgumentError for options out of range or a card without the engine, HeldError if it stands in a hold
  // that this program has not set, StateError if the card is busy or its ratio is not the full one, FaultError if it is
  // faulted. `card` must outlive the stream.
  explicit PositionStream(Card& card, const PositionStreamOptions& options = {});

  // One period: the axes are at `targets` when `clocks` have passed since the end of the period before.
  //
  // ArgumentError, before any access: an axis would be faster than allowed or could not stop before its soft limit, or
  // targets or duration are out of range (shortest_period() .. 2^32 clocks; targets within 2^30 pulses): the period was
  // not sent, and another may be sent in its place. StateError: the card's queue is full; likewise. FaultError: a
  // missing period, or another fault that stopped the card. LinkError, RefusedError; StateError when the card was reset
  // or aborted by another program, or when the bus is so slow that the period was over when it was looked at. After
  // these, recover() or a new stream.
  Sent send(const Positions& targets, std::uint64_t clocks);
  // Likewise; what a duration has beyond whole clocks is carried over to the next.
  Sent send(const Positions& targets, std::chrono::nanoseconds duration);

  // Ends the stream after the last period sent, which should end at rest (the card stops there without a ramp). Waits
  // until the card is idle, and switches position streaming off. Returns where the axes are: the rounded targets, or
  // what they went too far where the END was late. Errors as send(); TimeoutError.
  Positions finish();

  // After a FaultError: waits until the card stands, reads how far it went, clears the fault. The stream goes on from
  // there: the next target counts from the same places as before, and must lie within a period's reach of
  // `Stopped::positions`. Throws TimeoutError, LinkError.
  Stopped recover();

  // Shortest duration of a period, clocks: in less the card could not take up the next.
  std::uint64_t shortest_period() const { return 2 * kClocksPerTick * gap_free_ticks(axes_); }
  // Ticks that the card went on for in all, since the stream was opened.
  std::uint64_t stale_ticks() const { return all_stale_ticks_; }
  // Ticks of them that are still to be taken off coming periods.
  std::uint64_t ticks_behind() const { return behind_; }
  // Where the axes will be when all that was sent is done, whole pulses.
  Positions position() const;

 private:
  friend struct PositionStreamCount;  // of the tests: 2^32 lines take weeks
  using Pulses = std::array<std::int64_t, card_map::kMaxAxes>;
  // A line to be sent, and what is left then.
  struct Line {
    std::uint64_t ticks = 0;
    Pulses pulses{};
  };
  struct Step {
    Line line;
    Pulses told{};
    Pulses beyond{};
    std::uint64_t behind = 0;
  };
  // The card with nothing stale.
  struct Look {
    std::uint64_t begun = 0;        // lines
    std::uint32_t stale_ticks = 0;  // of the line before the one under way
  };

  void start();
  void require_room();
  Step step_to(const Pulses& told, std::uint64_t ticks) const;
  Step step_to(const Pulses& told, std::uint64_t ticks, std::uint64_t caught_up) const;
  std::optional<unsigned> fastest_axis(const Line& line) const;
  void require_limits(const Step& step) const;
  Sent send_line(const Step& step);
  void put_feed();
  void put(const Command& command);
  Look transfer_and_look();
  [[noreturn]] void throw_not_ours(std::uint32_t begun);
  void gone_beyond(std::uint64_t ticks);
  void expect_positions(const std::array<std::int32_t, card_map::kMaxAxes>& seen) const;
  std::int32_t at_card(unsigned axis, std::int64_t pulses) const;
  std::uint8_t line_mask() const { return static_cast<std::uint8_t>((1U << axes_) - 1); }
  template <class Call>
  auto closing_at_errors(Call call);

  static constexpr std::size_t kMaxAccesses = 64;

  Card* card_;
  PositionStreamOptions options_;
  unsigned axes_;
  std::uint64_t margin_clocks_;
  std::array<std::uint64_t, card_map::kMaxAxes> least_clocks_{};  // of a pulse
  std::array<std::int32_t, card_map::kMaxAxes> origin_{};         // positions at the opening, as the card counts
  std::shared_ptr<const StreamLimits> limits_;                    // never null in an open stream

  // What is carried over: clocks that make no tick, nanoseconds that make no clock (times Hz).
  std::uint64_t odd_clocks_ = 0;
  std::uint64_t odd_time_ = 0;

  Pulses told_{};                      // where the host wants the axes
  Pulses beyond_{};                    // how much farther they will be when all is done
  std::uint64_t behind_ = 0;           // ticks that it takes longer
  std::uint64_t all_stale_ticks_ = 0;  // since the opening
  LineCommand last_;                   // as it was sent
  bool pending_ = false;               // whether the card goes on beyond it is not known yet

  std::uint64_t lines_ = 0;          // sent since start()
  std::uint64_t begun_ = 0;          // of them, as of the last look
  std::uint64_t longest_ticks_ = 0;  // of a line
  std::uint32_t geometry_room_ = 0;  // halfwords
  std::uint8_t number_ = 0;          // of the next command
  bool fed_ = false;
  bool open_ = false;

  std::array<Access, kMaxAccesses> accesses_{};
  std::size_t used_ = 0;
};

}  // namespace trammel::driver
