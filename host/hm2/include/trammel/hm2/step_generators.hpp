// hostmot2's step generators on a card of this project: each axis has a rate, which holds until the next one is
// written, and an accumulator that shows its position.
//
// The card executes them by position streaming, in lines of kSlice. A new rate takes effect with the next line. That
// line is sent kLead before the end of the current one, so a rate takes effect between kLead and kLead + kSlice after
// it was written. While all rates are 0 the card is at rest, without a stream.
//
// Units. Rates: 2^-32 pulses per clock of the card, signed, as in hostmot2's register. Positions: 2^-32 pulses. Times:
// clocks of the card.
//
// Rounding does not accumulate: an axis has made floor(1/2 + p) pulses, where p is the sum of rate * clocks, exact to
// 2^-32.
//
// The accumulator has 16 fraction bits. Its value rounded to the nearest integer is always the card's position counter,
// which counts pulses at the pins. The fraction is that of p if p and the counter agree to within half a pulse;
// otherwise it is clamped to the nearest end of that half pulse. Therefore an axis at rest on a whole pulse reads as
// that pulse, and a driver that wants it there does not send pulses back and forth.
//
// Errors: LinkError. Any other refusal of the card ends the motion, and trouble() gives the reason. Used by one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "trammel/card_map.hpp"
#include "trammel/driver/axis_settings.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/position_stream.hpp"
#include "trammel/hm2/card_time.hpp"

namespace trammel::hm2 {

// Step settings of an axis; times in clocks.
struct StepTimes {
  std::uint32_t length = 0;
  std::uint32_t space = 0;
  std::uint32_t setup = 0;
  std::uint32_t hold = 0;
  driver::StepMode mode = driver::StepMode::kStepDirection;
  bool invert_first = false;
  bool invert_second = false;
};

class StepGenerators {
 public:
  static constexpr double kSlice = 500e-6;  // s, but at least kLeastSlice clocks and two pulses of each moving axis
  static constexpr double kLead = 60e-6;    // s, but at least kLeastLead clocks: accesses of a line and a snapshot
  static constexpr std::uint64_t kLeastSlice = 1000;
  static constexpr std::uint64_t kLeastLead = 600;
  static constexpr std::uint64_t kNever = UINT64_MAX;

  struct Counts {
    std::uint64_t lines = 0;        // lines sent to the card
    std::uint64_t clamped = 0;      // lines in which an axis was slower than requested, because of its step times
    std::uint64_t streams = 0;      // streams, each from rest to rest
    std::uint64_t stale_ticks = 0;  // ticks for which the card continued without a new line
  };

  // `card`, which is at rest, and `time` must outlive this object. Throws ArgumentError for a card without position
  // streaming.
  StepGenerators(driver::Card& card, CardTime& time);

  unsigned axes() const { return axes_; }
  // Takes effect with the next line. Ignored while trouble() is not empty.
  void set_rate(unsigned axis, std::int32_t rate);
  // Takes effect when all axes are next at rest.
  void set_times(unsigned axis, const StepTimes& times);

  // Advances the card's time to `clock`, or some hundred clocks beyond it, and sends the lines that are due by then.
  void run_to(std::uint64_t clock);
  // The clock at which the next line is due; kNever at rest.
  std::uint64_t next_due() const;
  bool moves() const { return stream_.has_value(); }

  // Ends all motion at once: the card drops its lines and completes pulses that have begun. Sets all rates to 0.
  void stop();
  // The reason why the card's motion has ended; empty if there is no trouble.
  const std::string& trouble() const { return trouble_; }
  // Clears the card's faults and trouble(), if their cause is gone.
  void clear_trouble();

  // Reads the card for accumulator().
  void latch();
  // The value at the last latch(), 2^-16 pulses, wrapping.
  std::uint32_t accumulator(unsigned axis) const { return accumulators_[axis]; }
  const std::array<std::int32_t, card_map::kMaxAxes>& counters() const { return counters_; }

  const Counts& counts() const { return counts_; }
  std::uint64_t slice() const { return slice_; }  // clocks
  std::uint64_t lead() const { return lead_; }

 private:
  using Positions = std::array<std::int64_t, card_map::kMaxAxes>;
  using Rates = std::array<std::int64_t, card_map::kMaxAxes>;
  // The commanded positions of one line: `from` and `rates` for `clocks` clocks from `begin` on.
  struct Line {
    std::uint64_t begin = 0;  // clock
    std::uint64_t clocks = 0;
    Positions from{};
    Rates rates{};
  };

  bool all_rates_are_zero() const;
  void open();
  void close();
  void send_line();
  std::uint64_t next_clocks() const;
  Rates allowed_rates(std::uint64_t clocks);
  void apply_times();
  Positions told_at(std::uint64_t clock) const;
  void read_counters();
  template <class Call>
  void guarded(Call call);

  driver::Card& card_;
  CardTime& time_;
  unsigned axes_;
  std::uint64_t slice_;
  std::uint64_t lead_;
  std::array<std::int32_t, card_map::kMaxAxes> rates_{};
  std::array<StepTimes, card_map::kMaxAxes> times_{};
  unsigned new_times_ = 0;  // bit n: times of axis n are not written to the card yet

  std::optional<driver::PositionStream> stream_;
  std::array<std::int32_t, card_map::kMaxAxes> origin_{};  // counters when the stream was opened
  Positions told_{};                                       // commanded at the end of the lines sent, from the origin
  std::uint64_t end_ = 0;                                  // clock at the end of the lines sent
  std::array<Line, 4> lines_{};                            // the last lines sent, in a ring
  std::uint64_t sent_ = 0;                                 // lines sent in this stream

  std::array<std::int32_t, card_map::kMaxAxes> counters_{};
  std::array<std::uint32_t, card_map::kMaxAxes> accumulators_{};
  std::string trouble_;
  Counts counts_;
};

}  // namespace trammel::hm2
