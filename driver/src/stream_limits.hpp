// The soft limits of a card as a position stream keeps them: a period is refused where the card, left alone behind it,
// would no longer come to rest inside.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "trammel/driver/card.hpp"

namespace trammel::driver {

class StreamLimits {
 public:
  // Pulses of one axis and clocks of a line, and where it ends, counted from `origin`.
  struct Way {
    std::int64_t pulses = 0;
    std::uint64_t clocks = 1;
    std::int64_t end = 0;
  };

  // Those of a card that has none hold for nothing. `origin`: POSITION where the stream counts from.
  static StreamLimits read_from(Card& card, const std::array<std::int32_t, card_map::kMaxAxes>& origin,
                                unsigned stale_periods);

  // What is wrong with a way that the axis goes; empty: nothing. Inward every way is allowed.
  std::string complaint(unsigned axis, const Way& way) const;

 private:
  struct Ends {
    std::int64_t minus = 0;
    std::int64_t plus = 0;
  };
  // Pulses until the axis stands: the line goes on for the stale periods, then the ratio falls evenly to 0, so that
  // half of the slew's time counts.
  std::int64_t stopping(const Way& way) const;

  std::array<std::optional<Ends>, card_map::kMaxAxes> ends_;
  std::uint64_t ramp_clocks_ = 0;  // from full ratio to 0; at most kSlowestSlew, 2^30
  std::uint64_t stale_periods_ = 0;
};

}  // namespace trammel::driver
