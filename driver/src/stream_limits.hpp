// The soft limits of a card as a position stream enforces them: it refuses a period after which the card, without
// further periods, would not come to rest inside the limits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "trammel/driver/card.hpp"

namespace trammel::driver {

class StreamLimits {
 public:
  // A line of one axis: its pulses and clocks, and its end position, counted from `origin`.
  struct Way {
    std::int64_t pulses = 0;
    std::uint64_t clocks = 1;
    std::int64_t end = 0;
  };

  // Reads the limits; on a card without soft limits nothing is limited. `origin`: POSITION at the stream's position 0.
  static StreamLimits read_from(Card& card, const std::array<std::int32_t, card_map::kMaxAxes>& origin,
                                unsigned stale_periods);

  // The reason why a line is refused; empty if it is allowed. Inward lines are always allowed.
  std::string complaint(unsigned axis, const Way& way) const;

 private:
  struct Ends {
    std::int64_t minus = 0;
    std::int64_t plus = 0;
  };
  // Pulses until the axis is at rest. The line continues for the stale periods; then the ratio falls linearly to 0, so
  // half of the slew time counts.
  std::int64_t stopping(const Way& way) const;

  std::array<std::optional<Ends>, card_map::kMaxAxes> ends_;
  std::uint64_t ramp_clocks_ = 0;  // from full ratio to 0; at most kSlowestSlew, 2^30
  std::uint64_t stale_periods_ = 0;
};

}  // namespace trammel::driver
