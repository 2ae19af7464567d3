#include "patience.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

namespace reg = card_map::reg;
namespace constant = card_map::constant;

std::uint64_t saturated(Uint128 value) {
  return value.high() != 0 ? std::numeric_limits<std::uint64_t>::max() : value.low();
}

// ceil(gated / ratio); a division of 128 bits only where there is something to divide.
Uint128 at_ratio(Uint128 gated, std::uint32_t ratio) {
  if (ratio != Card::kFullRatio) return ceil_div(gated, ratio);
  return (gated + Uint128(Card::kFullRatio - 1)) >> constant::kRatioFractionBits;
}

}  // namespace

void Patience::allow(const PlannedTime& planned) {
  planned_ = planned;
  gated_left_ = Uint128(planned.gated) << constant::kRatioFractionBits;
  real_left_ = saturated(Uint128(planned.real) + Uint128(margin_));
  waited_ = 0;
  slews_counted_ = false;
}

// Clocks that may still be waited at the ratio that the card is known to have, which is not 0.
std::uint64_t Patience::left() const { return saturated(at_ratio(gated_left_, card_.ratio()) + Uint128(real_left_)); }

// The card is asked for its time base only once the time has passed: somebody else may have set it, and on the way from
// one ratio to another it is lower for as long as a full slew at most, down and up again.
bool Patience::overdue() {
  std::array<Access, 3> accesses{read_of(reg::kRatioFeed), read_of(reg::kSlew)};
  card_.transfer(accesses.data(), 2, context_);
  Card::check_read(accesses[0]);
  Card::check_read(accesses[1]);
  if (card_.ratio() != accesses[0].data) {
    card_.note_ratio(accesses[0].data);
    const std::uint64_t waited = waited_;
    allow(planned_);
    waited_ = waited;
    return false;
  }
  if (card_.ratio() == 0) {
    return false;
  }
  if (slews_counted_) {
    return true;
  }
  slews_counted_ = true;
  real_left_ += 2 * (std::uint64_t{constant::kSlewClocks} << constant::kSlewFractionBits) /
                std::max<std::uint32_t>(accesses[1].data, 1);
  return real_left_ == 0;
}

void Patience::count(std::uint64_t clocks) {
  waited_ += clocks;
  const std::uint32_t ratio = card_.ratio();
  const Uint128 gated = Uint128::product(clocks, ratio);
  if (gated_left_ > gated) {
    gated_left_ = gated_left_ - gated;
    return;
  }
  const std::uint64_t used = at_ratio(gated_left_, ratio).low();
  gated_left_ = Uint128(0);
  real_left_ -= std::min(real_left_, clocks - used);
}

void Patience::pause(const Status& status, std::uint64_t clocks, bool until_idle) {
  // An interrupt tells of the end by itself; looks are for other threads' requests then.
  constexpr std::uint32_t kLooksPerSecond = 100;
  const std::uint32_t clock_hz = card_.identification().clock_hz;
  std::uint64_t longest = clocks;
  if (until_idle && card_.bus().has_interrupt()) longest = std::max<std::uint64_t>(clocks, clock_hz / kLooksPerSecond);
  if (!status.held && (card_.ratio() == 0 || left() == 0) && overdue()) {
    throw TimeoutError(context_, waited_);
  }
  const bool counts = !status.held && card_.ratio() != 0;
  if (counts) {
    longest = std::min(longest, left());
  }
  // After an interrupt nothing says how much time has passed; what raised it may still stand, so the next pause is one
  // of time alone.
  if (interrupted_) {
    interrupted_ = false;
    card_.bus().sleep(time_of(longest, clock_hz));
  } else {
    interrupted_ = card_.pause(longest, until_idle);
  }
  if (counts && !interrupted_) {
    count(longest);
  }
}

}  // namespace trammel::driver
