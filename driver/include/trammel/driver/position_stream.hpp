// Position streaming: a host with a servo cycle (about 1 kHz) gives the card, in each period, the axes' positions for
// the period's end. The card moves there in a straight line. Needs a card with the engine `streaming`.
//
// Units. Positions: 2^-24 pulses, counted from the position of each axis when the stream was opened. Times: card
// clocks, or nanoseconds; a stream runs at the full ratio, where every clock is enabled. Ticks (in results): 2 clocks
// each.
//
// No error accumulates. A period's line ends at the rounded target. So an axis is at most half a pulse from its target
// at the end of a period, and at most one pulse from the straight line between two targets. Fractions of ticks and of
// clocks in the durations are carried over exactly: the end of a period is at most one tick from the sum of all
// durations.
//
// A late period. If the next period has not arrived when the last one ends, the card continues along the last line, for
// at most `stale_periods` times its duration. When the next period has been sent, the excess distance and time are
// known to the tick. The stream subtracts them from the following periods, from durations and distances alike, so that
// the speed stays; at most half a period's duration is subtracted at a time. A period that comes later still is
// missing: the card ramps down along the line (by the slew), and every call throws FaultError with the bit
// kFaultMissingPeriod, until recover().
//
// Soft limits. If the card compares positions with soft limits (Card::set_soft_limits), send() refuses a period after
// which the card could not come to rest inside them. The stop takes the speed times half of the slew's time, plus the
// stale periods. So a stream stops before the limit even if its host fails. The stream reads limits and slew when it is
// opened and at recover(); set them before.
//
// Thread-safety as of the card: one thread at a time. send() does not allocate.
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
  // Number of periods for which the card may continue along the last line, 0 .. 255.
  unsigned stale_periods = 1;
  // Number of periods that are sent before the card starts the first one, at least 1. The host may be late by this
  // time. It is also the delay from sending a period to its start.
  unsigned ahead = 2;
  // Largest speed of each axis, pulses/s; 0: limited by the card and its step times only.
  std::array<double, card_map::kMaxAxes> max_speed{};
  // Time beyond that of the queued periods that the card may take to come to rest before TimeoutError.
  std::chrono::nanoseconds margin = std::chrono::seconds(1);
};

class PositionStream {
 public:
  static constexpr unsigned kFractionBits = 24;
  static constexpr std::int64_t kPulse = std::int64_t{1} << kFractionBits;
  static constexpr std::uint64_t kClocksPerTick = 2;

  using Positions = std::array<std::int64_t, card_map::kMaxAxes>;  // 2^-24 pulses; axes that the card lacks: 0

  // State of the card after a period was sent.
  struct Sent {
    std::uint64_t ahead = 0;        // queued periods that have not begun
    std::uint64_t stale_ticks = 0;  // excess ticks when this period came; 0: it was in time
  };
  // State of the card after a fault.
  struct Stopped {
    std::uint32_t faults = 0;       // FAULT
    std::uint64_t stale_ticks = 0;  // excess ticks after a missing period, else 0
    Positions positions{};          // positions of the axes, whole pulses
  };

  // Opens the stream at the present position of the axes. Drops queued commands and resets their numbers; makes a
  // missing period stop on a ramp. Throws ArgumentError for options out of range or a card without the engine,
  // HeldError if the card is in a hold that this program has not set, StateError if the card is busy or its ratio is
  // not the full one, FaultError if it has a fault. `card` must outlive the stream.
  explicit PositionStream(Card& card, const PositionStreamOptions& options = {});

  // Sends one period: the axes are at `targets` when `clocks` have passed since the end of the previous period.
  //
  // Throws ArgumentError before any access if an axis would be faster than allowed or could not stop before its soft
  // limit, or if targets or duration are out of range (shortest_period() .. 2^32 clocks; targets within 2^30 pulses).
  // Throws StateError if the card's queue is full. In both cases the period was not sent, and another may be sent
  // instead.
  //
  // Throws FaultError for a missing period, or another fault that stopped the card; LinkError; RefusedError; and
  // StateError when another program reset or aborted the card, or when the bus is so slow that the period was over
  // before the poll. After these errors, call recover() or open a new stream.
  Sent send(const Positions& targets, std::uint64_t clocks);
  // The same; a fraction of a clock in the duration is carried over to the next period.
  Sent send(const Positions& targets, std::chrono::nanoseconds duration);

  // Ends the stream after the last period sent. That period should end at rest, because the card stops there without a
  // ramp. Waits until the card is idle, and switches position streaming off. Returns the positions of the axes: the
  // rounded targets, plus the excess if the END was late. Errors as send(); TimeoutError.
  Positions finish();

  // After a FaultError: waits until the card is at rest, reads how far it went, and clears the fault. The stream
  // continues from there. The next target counts from the same origin as before, and must lie within a period's reach
  // of `Stopped::positions`. Throws TimeoutError, LinkError.
  Stopped recover();

  // Shortest duration of a period, clocks: the time in which the card can decode the next one.
  std::uint64_t shortest_period() const { return 2 * kClocksPerTick * gap_free_ticks(axes_); }
  // Ticks for which the card has continued without a new period, in total since the stream was opened.
  std::uint64_t stale_ticks() const { return all_stale_ticks_; }
  // Those of stale_ticks() that are still to be subtracted from future periods.
  std::uint64_t ticks_behind() const { return behind_; }
  // Whether the card executes the periods. It does once `ahead` periods were sent; before that nothing moves.
  bool has_begun() const { return fed_; }
  // Positions of the axes when all sent periods have ended, whole pulses.
  Positions position() const;

 private:
  friend struct PositionStreamCount;  // for tests of the wrap: 2^32 lines take weeks
  using Pulses = std::array<std::int64_t, card_map::kMaxAxes>;
  // A line to send.
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
  // A poll of the card that found no stale motion.
  struct Look {
    std::uint64_t begun = 0;        // lines begun
    std::uint32_t stale_ticks = 0;  // excess ticks of the line before the one under way
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
  std::array<std::uint64_t, card_map::kMaxAxes> least_clocks_{};  // least clocks per pulse
  std::array<std::int32_t, card_map::kMaxAxes> origin_{};         // POSITION at the opening
  std::shared_ptr<const StreamLimits> limits_;                    // never null in an open stream

  // Carried over to the next period: clocks that make no whole tick, nanoseconds that make no whole clock (times Hz).
  std::uint64_t odd_clocks_ = 0;
  std::uint64_t odd_time_ = 0;

  Pulses told_{};                      // last target, whole pulses
  Pulses beyond_{};                    // excess distance at the end of all sent lines, pulses
  std::uint64_t behind_ = 0;           // excess time, ticks
  std::uint64_t all_stale_ticks_ = 0;  // excess ticks since the stream was opened
  LineCommand last_;                   // the last line sent
  bool pending_ = false;               // the excess of the last line is not known yet

  std::uint64_t lines_ = 0;          // lines sent since start()
  std::uint64_t begun_ = 0;          // lines begun, at the last poll
  std::uint64_t longest_ticks_ = 0;  // longest line, ticks
  std::uint32_t geometry_room_ = 0;  // room of the geometry queue at the last poll, halfwords
  std::uint8_t number_ = 0;          // number of the next command, mod 256
  bool fed_ = false;
  bool open_ = false;

  std::array<Access, kMaxAccesses> accesses_{};
  std::size_t used_ = 0;
};

}  // namespace trammel::driver
