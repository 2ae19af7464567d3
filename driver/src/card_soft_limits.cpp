// Soft limits of the card's axes: writes of their registers.
#include <fmt/format.h>

#include <algorithm>

#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;

bool Card::has_soft_limits() const {
  return card_map::has_engine(identification().engines, card_map::engine::kSoftLimits);
}

// None holds while the ends change.
void Card::set_soft_limits(const std::vector<std::optional<SoftRange>>& ranges) {
  if (!has_soft_limits()) {
    throw ArgumentError(fmt::format("soft limits: the card has none (engines 0x{:X})", identification().engines));
  }
  if (ranges.size() > identification().axes) {
    throw ArgumentError(fmt::format("soft limits of {} axes: the card has {}", ranges.size(), identification().axes));
  }
  for (std::size_t n = 0; n < ranges.size(); ++n) {
    if (!ranges[n] || ranges[n]->length() >= 0) continue;
    throw ArgumentError(
        fmt::format("soft limits of axis {}: {} to {} is no range", n, ranges[n]->minus, ranges[n]->plus));
  }
  constexpr std::string_view kWhat = "soft limits";
  parts_->registers.write(reg::kSoftLimits, 0, kWhat);
  std::uint32_t axes = 0;
  for (unsigned n = 0; n < ranges.size(); ++n) {
    if (!ranges[n]) continue;
    parts_->registers.write(reg::soft_minus(n), static_cast<std::uint32_t>(ranges[n]->minus), kWhat);
    parts_->registers.write(reg::soft_plus(n), static_cast<std::uint32_t>(ranges[n]->plus), kWhat);
    axes |= 1U << n;
  }
  if (axes != 0) parts_->registers.write(reg::kSoftLimits, axes, kWhat);
}

}  // namespace trammel::driver
