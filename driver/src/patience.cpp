#include "patience.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "trammel/card_map.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::driver {
namespace {

namespace reg = card_map::reg;
namespace constant = card_map::constant;

std::uint64_t saturated(Uint128 value) {
  return value.high() != 0 ? std::numeric_limits<std::uint64_t>::max() : value.low();
}

}  // namespace

// Clocks that may still be waited; 0 when it is overdue. The card is asked for its time base only once the time at full
// ratio has passed: whoever set it, and whenever.
std::uint64_t Patience::left() {
  const Uint128 at_full = Uint128(planned_.gated) + Uint128(planned_.real) + Uint128(margin_);
  if (at_full > Uint128(waited_)) {
    return saturated(at_full - Uint128(waited_));
  }
  std::array<Access, 3> accesses{read_of(reg::kRatioFeed), read_of(reg::kSlew)};
  card_.transfer(accesses.data(), 2, context_);
  Card::check_read(accesses[0]);
  Card::check_read(accesses[1]);
  const std::uint32_t ratio = accesses[0].data;
  if (ratio == 0) {
    return std::numeric_limits<std::uint64_t>::max();
  }
  // On the way from one ratio to another it is lower for as long as a full slew at most, down and up again.
  const std::uint64_t slew = (std::uint64_t{constant::kSlewClocks} << constant::kSlewFractionBits) /
                             std::max<std::uint32_t>(accesses[1].data, 1);
  const Uint128 stretched = ceil_div(Uint128(planned_.gated) << constant::kRatioFractionBits, ratio);
  const Uint128 limit = stretched + Uint128(planned_.real) + Uint128(margin_) + Uint128(2 * slew);
  return limit > Uint128(waited_) ? saturated(limit - Uint128(waited_)) : 0;
}

void Patience::pause(const Status& status, std::uint64_t clocks, bool until_idle) {
  // An interrupt tells of the end by itself; looks are for other threads' requests then.
  constexpr std::uint32_t kLooksPerSecond = 100;
  const std::uint32_t clock_hz = card_.identification().clock_hz;
  std::uint64_t longest = clocks;
  if (until_idle && card_.bus().has_interrupt()) longest = std::max<std::uint64_t>(clocks, clock_hz / kLooksPerSecond);
  if (!status.held) {
    const std::uint64_t allowed = left();
    if (allowed == 0) {
      throw TimeoutError(context_, waited_);
    }
    longest = std::min(longest, allowed);
  }
  // After an interrupt nothing says how much time has passed; what raised it may still stand, so the next pause is one
  // of time alone.
  if (interrupted_) {
    interrupted_ = false;
    card_.bus().sleep(time_of(longest, clock_hz));
  } else {
    interrupted_ = card_.pause(longest, until_idle);
  }
  if (!status.held && !interrupted_) {
    waited_ += longest;
  }
}

}  // namespace trammel::driver
