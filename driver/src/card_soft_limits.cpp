// Soft limits of the card's axes: reads and writes of their registers.
#include <fmt/format.h>

#include <algorithm>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

namespace {

void require_soft_limits(const Card& card) {
  if (card.has_soft_limits()) return;
  throw ArgumentError(fmt::format("soft limits: the card has none (engines 0x{:X})", card.identification().engines));
}

}  // namespace

bool Card::has_soft_limits() const {
  return card_map::has_engine(identification().engines, card_map::engine::kSoftLimits);
}

// No soft limit is active while the ends change.
void Card::set_soft_limits(const std::vector<std::optional<SoftRange>>& ranges) {
  require_soft_limits(*this);
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

std::vector<std::optional<SoftRange>> Card::read_soft_limits() {
  require_soft_limits(*this);
  const std::uint32_t axes = parts_->registers.read(reg::kSoftLimits);
  Registers::check_read({reg::kSoftLimits, axes});
  std::vector<std::optional<SoftRange>> ranges(identification().axes);
  for (unsigned n = 0; n < ranges.size(); ++n) {
    if ((axes >> n & 1U) == 0) continue;
    const std::uint32_t minus = parts_->registers.read(reg::soft_minus(n));
    const std::uint32_t plus = parts_->registers.read(reg::soft_plus(n));
    ranges[n] = SoftRange{static_cast<std::int32_t>(minus), static_cast<std::int32_t>(plus)};
  }
  return ranges;
}

void Card::set_soft_limit_ramps(bool ramp) {
  require_soft_limits(*this);
  constexpr std::uint32_t kReaction = field::kStopReactionSoftLimit;
  set_reactions(parts_->registers, kReaction, ramp ? kReaction : 0, "reaction to soft limits");
}

}  // namespace trammel::driver
