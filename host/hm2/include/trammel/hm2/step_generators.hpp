// hostmot2's step generators on a card of this project: a rate for each axis, which holds until the next one, and an
// accumulator that tells where the axis is.
//
// The card runs them by position streaming, in lines of kSlice. A new rate counts from the next line on. That line is
// sent kLead before the one under way ends, so that a rate takes effect between kLead and kLead + kSlice after it came.
// While all rates are 0 the card rests, without a stream.
//
// Units. Rates: 2^-32 pulses per clock of the card, signed, as in hostmot2's register. Positions: 2^-32 pulses. Times:
// clocks of the card.
//
// Nothing is rounded twice: an axis has made floor(1/2 + p) pulses where p is the sum of rate * clocks, exact to 2^-32.
//
// The accumulator has 16 fraction bits. Its whole part, rounded to the nearest, is always the card's position counter,
// which counts pulses at the pins. The fraction is p's, where p and the counter agree to half a pulse; else it is held
// at the nearest end of that half pulse. So an axis that stands on a whole pulse reads as that pulse, and a driver that
// wants it there sends no pulse to and fro.
//
// Errors: LinkError. What else the card refuses ends the motion, and trouble() says why. One thread.
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

// Registers of an axis; times in clocks.
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
    std::uint64_t lines = 0;        // sent to the card
    std::uint64_t clamped = 0;      // of these, in which an axis was slower than told: its step times allow no more
    std::uint64_t streams = 0;      // from rest to rest
    std::uint64_t stale_ticks = 0;  // that the card went on for without a new line
  };

  // `card`, which stands, and `time` must outlive it. Throws ArgumentError for a card without position streaming.
  StepGenerators(driver::Card& card, CardTime& time);

  unsigned axes() const { return axes_; }
  // From the next line on. Ignored while there is trouble.
  void set_rate(unsigned axis, std::int32_t rate);
  // Counts from the next time on at which all axes stand.
  void set_times(unsigned axis, const StepTimes& times);

  // Lets the card's time go on to `clock`, some hundred clocks more at most, with the lines that are due until then.
  void run_to(std::uint64_t clock);
  // When the next line is due; kNever at rest.
  std::uint64_t next_due() const;
  bool moves() const { return stream_.has_value(); }

  // Ends all motion at once: the card drops what it has, and pulses under way are made whole. Rates are 0.
  void stop();
  // Why the card's motion has ended; empty where all is well.
  const std::string& trouble() const { return trouble_; }
  // Clears the card's faults and the trouble, where their cause has gone.
  void clear_trouble();

  // Looks at the card, for accumulator().
  void latch();
  // As of latch(), 2^-16 pulses, wrapping.
  std::uint32_t accumulator(unsigned axis) const { return accumulators_[axis]; }
  const std::array<std::int32_t, card_map::kMaxAxes>& counters() const { return counters_; }

  const Counts& counts() const { return counts_; }
  std::uint64_t slice() const { return slice_; }  // clocks
  std::uint64_t lead() const { return lead_; }

 private:
  using Positions = std::array<std::int64_t, card_map::kMaxAxes>;
  using Rates = std::array<std::int64_t, card_map::kMaxAxes>;
  // Where the axes are told to be: from `begin` on for so many clocks, then the next one.
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
  unsigned new_times_ = 0;  // bit n: those of axis n are not the card's yet

  std::optional<driver::PositionStream> stream_;
  std::array<std::int32_t, card_map::kMaxAxes> origin_{};  // counters at the opening
  Positions told_{};                                       // at the end of what was sent, from the origin
  std::uint64_t end_ = 0;                                  // clock
  std::array<Line, 4> lines_{};                            // the last ones, in a ring
  std::uint64_t sent_ = 0;                                 // lines of this stream

  std::array<std::int32_t, card_map::kMaxAxes> counters_{};
  std::array<std::uint32_t, card_map::kMaxAxes> accumulators_{};
  std::string trouble_;
  Counts counts_;
};

}  // namespace trammel::hm2
