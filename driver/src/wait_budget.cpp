#include "wait_budget.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {
namespace {

namespace reg = card_map::reg;
namespace constant = card_map::constant;

std::uint64_t saturated(Uint128 value) {
  return value.high() != 0 ? std::numeric_limits<std::uint64_t>::max() : value.low();
}

// ceil(gated / ratio); divides 128 bits only if the ratio is not 1.
Uint128 at_ratio(Uint128 gated, std::uint32_t ratio) {
  if (ratio != kFullRatio) return ceil_div(gated, ratio);
  return (gated + Uint128(kFullRatio - 1)) >> constant::kRatioFractionBits;
}

}  // namespace

void WaitBudget::allow(const PlannedTime& planned) {
  planned_ = planned;
  for (std::size_t i = 0; i < gated_left_.size(); ++i) {
    gated_left_[i] = Uint128(planned.parts[i].gated) << constant::kRatioFractionBits;
  }
  real_left_ = saturated(Uint128(planned.real) + Uint128(margin_));
  waited_ = 0;
  slews_counted_ = false;
}

void WaitBudget::allow_again() {
  const std::uint64_t waited = waited_;
  allow(planned_);
  waited_ = waited;
}

// Whether the part under way, as far as known, has a ratio of 0.
bool WaitBudget::stands() const {
  for (std::size_t i = 0; i < gated_left_.size(); ++i) {
    if (gated_left_[i] > Uint128(0)) return ratio_of(i) == 0;
  }
  return false;
}

// Clocks that remain at the ratios known so far. A part with ratio 0 is waited for when its turn comes.
std::uint64_t WaitBudget::left() const {
  Uint128 clocks(real_left_);
  for (std::size_t i = 0; i < gated_left_.size(); ++i) {
    if (ratio_of(i) != 0) clocks = clocks + at_ratio(gated_left_[i], ratio_of(i));
  }
  return saturated(clocks);
}

bool WaitBudget::ratios_changed(const Access* accesses, std::size_t count) {
  bool changed = false;
  for (std::size_t i = 0; i < count; ++i) {
    Registers::check_read(accesses[i]);
    const auto piece_class = static_cast<PieceClass>(i);
    changed = changed || card_.ratio(piece_class) != accesses[i].data;
    card_.parts().time_base.note_ratio(piece_class, accesses[i].data);
  }
  return changed;
}

// Reads the card's time base only after the time has passed. Another program may have changed it. Between two ratios
// the actual ratio is lower, for at most a full slew down and up again.
bool WaitBudget::overdue() {
  const std::size_t ratios = card_.parts().time_base.has_classes() ? kPieceClasses : 1;
  std::array<Access, kPieceClasses + 2> accesses{read_of(reg::kRatioFeed), read_of(reg::kRatioRapid),
                                                 read_of(reg::kRatioFixed)};
  accesses[ratios] = read_of(reg::kSlew);
  card_.parts().registers.transfer(accesses.data(), ratios + 1, context_);
  Registers::check_read(accesses[ratios]);
  if (ratios_changed(accesses.data(), ratios)) {
    allow_again();
    return false;
  }
  if (stands()) {
    return false;
  }
  if (slews_counted_) {
    // Another program may have lowered the ratio temporarily, which leaves no trace; the card is not overdue while a
    // piece runs.
    const Snapshot now = card_.read_snapshot();
    const bool runs = margin_ != 0 && now.rate != 0 && now.ratio != 0;
    if (runs) allow_again();
    return !runs;
  }
  slews_counted_ = true;
  real_left_ += 2 * kSlowestSlew / std::max<std::uint32_t>(accesses[ratios].data, 1);
  return real_left_ == 0;
}

void WaitBudget::count(std::uint64_t clocks) {
  waited_ += clocks;
  for (std::size_t i = 0; i < gated_left_.size(); ++i) {
    const std::uint32_t ratio = ratio_of(i);
    const Uint128 gated = Uint128::product(clocks, ratio);
    if (gated_left_[i] > gated) {
      gated_left_[i] = gated_left_[i] - gated;
      return;
    }
    if (ratio == 0) continue;
    clocks -= std::min(clocks, at_ratio(gated_left_[i], ratio).low());
    gated_left_[i] = Uint128(0);
  }
  real_left_ -= std::min(real_left_, clocks);
}

void WaitBudget::pause(const Status& status, std::uint64_t clocks, std::uint32_t wake) {
  // An interrupt reports the end by itself; polls then only serve requests of other threads.
  constexpr std::uint32_t kLooksPerSecond = 100;
  const std::uint32_t clock_hz = card_.identification().clock_hz;
  std::uint64_t longest = clocks;
  if (wake != 0 && card_.bus().has_interrupt()) longest = std::max<std::uint64_t>(clocks, clock_hz / kLooksPerSecond);
  // The time until an input's level is unlimited.
  const bool stopped = status.held || status.waiting;
  if (!stopped && (stands() || left() == 0) && overdue()) {
    throw TimeoutError(context_, waited_);
  }
  const bool counts = !stopped && !stands();
  if (counts) {
    longest = std::min(longest, left());
  }
  // After an interrupt the elapsed time is unknown. Its cause may still be present, so the next pause is a sleep.
  if (interrupted_) {
    interrupted_ = false;
    card_.bus().sleep(time_of(longest, clock_hz));
  } else {
    interrupted_ = card_.parts().interrupt.pause(longest, wake);
  }
  if (counts && !interrupted_) {
    count(longest);
  }
}

}  // namespace trammel::driver
