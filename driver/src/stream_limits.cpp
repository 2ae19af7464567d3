#include "stream_limits.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;

StreamLimits StreamLimits::read_from(Card& card, const std::array<std::int32_t, card_map::kMaxAxes>& origin,
                                     unsigned stale_periods) {
  StreamLimits limits;
  limits.stale_periods_ = stale_periods;
  if (!card.has_soft_limits()) return limits;
  Registers& registers = card.parts().registers;
  const std::uint32_t axes = registers.read(reg::kSoftLimits);
  limits.ramp_clocks_ = kSlowestSlew / std::max<std::uint32_t>(registers.read(reg::kSlew), 1);
  for (unsigned n = 0; n < card.identification().axes; ++n) {
    if ((axes >> n & 1) == 0) continue;
    const auto from_origin = [&](std::uint32_t end) {
      return std::int64_t{pulses_between(origin[n], static_cast<std::int32_t>(end))};
    };
    limits.ends_[n] =
        Ends{from_origin(registers.read(reg::soft_minus(n))), from_origin(registers.read(reg::soft_plus(n)))};
  }
  return limits;
}

// A line has at most 2^31 pulses, so that neither product reaches 2^62.
std::int64_t StreamLimits::stopping(const Way& way) const {
  const auto pulses = static_cast<std::uint64_t>(way.pulses < 0 ? -way.pulses : way.pulses);
  const std::uint64_t ramp = (pulses * ((ramp_clocks_ + 1) / 2) + way.clocks - 1) / way.clocks;
  return static_cast<std::int64_t>(pulses * stale_periods_ + ramp);
}

std::string StreamLimits::complaint(unsigned axis, const Way& way) const {
  if (!ends_[axis] || way.pulses == 0) return "";
  const std::int64_t end = way.pulses > 0 ? ends_[axis]->plus : ends_[axis]->minus;
  const std::int64_t left = way.pulses > 0 ? end - way.end : way.end - end;
  const std::int64_t needed = stopping(way);
  if (left >= needed) return "";
  return fmt::format(
      "{} pulses in {} clocks would end {} pulses before the soft limit at {}, and the card needs {} to stop from this "
      "speed: brake earlier",
      way.pulses, way.clocks, left, end, needed);
}

}  // namespace trammel::driver
