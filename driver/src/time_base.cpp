#include "trammel/driver/low_level/time_base.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;

// Indexed by PieceClass.
constexpr std::array<std::uint32_t, kPieceClasses> kRatios{reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};

}  // namespace

void TimeBase::set_ratio(PieceClass piece_class, std::uint32_t ratio) {
  const auto index = static_cast<std::size_t>(piece_class);
  if (index >= kPieceClasses) throw ArgumentError(fmt::format("time base: class {}", index));
  if (piece_class != PieceClass::kFeed && !has_classes()) {
    throw ArgumentError(fmt::format("time base: a ratio for class {} needs {}, which the card does not have", index,
                                    map::kEngineNames[map::engine::kClasses]));
  }
  check_setting(kRatios[index], ratio, fmt::format("time base: ratio {} / 65536", ratio));
  registers_.write(kRatios[index], ratio, "time base: ratio");
  ratios_[index] = ratio;
}

void TimeBase::set_slew_time(std::chrono::nanoseconds full_scale) {
  // The ratio moves by `slew` * 2^-28 every 4 clocks, so slew = 4 * 2^28 / clocks.
  const std::uint64_t time = std::max<std::uint64_t>(clocks_of(full_scale, card_.clock_hz, "time base: slew time"), 1);
  const std::uint64_t slew = std::min<std::uint64_t>(kSlowestSlew / time, register_at(reg::kSlew).maximum);
  check_setting(reg::kSlew, slew,
                fmt::format("time base: slew of {} ns, {} clocks, which gives {} and", full_scale.count(), time, slew));
  registers_.write(reg::kSlew, static_cast<std::uint32_t>(slew), "time base: slew");
}

void TimeBase::set_hold(bool hold) {
  registers_.write(reg::kHold, hold ? 1 : 0, "time base: hold");
  own_hold_ = hold;
}

void TimeBase::throw_if_held(std::string_view context) {
  if (!hold()) return;
  const std::string origin = own_hold_.value_or(false) ? "set by this program"
                             : own_hold_               ? std::string()
                                                       : registers_.bus().hold_origin();
  throw HeldError(fmt::format("{}: the card holds{}{}: take it over, or end the hold", context,
                              origin.empty() ? "" : ": ", origin));
}

}  // namespace trammel::driver
