#include "trammel/driver/feed_ramp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {
namespace {

constexpr double kRampUpdate = card_map::constant::kUpdateClocks;
constexpr double kLeastRampRate = 0x1p-32;  // one unit of the field `floor`

double checked_rate(const char* name, double speed, std::uint32_t clock_hz) {
  if (!(speed >= 0 && speed <= clock_hz)) {
    throw ArgumentError(fmt::format("{} is 0 to {} ticks/s, not {}", name, clock_hz, speed));
  }
  return speed / clock_hz;
}

// The length of a ramp to rest: half of the slew time at the highest rate. At least one tick, because 0 means that the
// piece ends at rest.
std::uint32_t stop_distance(const FeedRamp& ramp, double highest_rate, std::uint32_t clock_hz) {
  if (ramp.end_speed == 0) return 0;
  const double clocks = std::chrono::duration<double>(ramp.slew_time).count() * clock_hz / 2;
  const double ticks = std::max(1.0, std::ceil(clocks * highest_rate));
  if (ticks > UINT32_MAX) throw ArgumentError(fmt::format("a stop would take {} ticks, more than 2^32 - 1", ticks));
  return static_cast<std::uint32_t>(ticks);
}

}  // namespace

FeedCommand feed_for_ramp(const FeedRamp& ramp, std::uint32_t clock_hz) {
  if (clock_hz == 0) throw ArgumentError("a clock of 0 Hz");
  if (ramp.ticks == 0 || ramp.ticks >> card_map::constant::kFractionBits != 0) {
    throw ArgumentError(fmt::format("a piece has 1 to 2^40 - 1 ticks, not {}", ramp.ticks));
  }
  if (ramp.slew_time.count() < 0) throw ArgumentError("a slew time below 0");
  const double rate = checked_rate("speed", ramp.speed, clock_hz);
  const double end_rate = checked_rate("end_speed", ramp.end_speed, clock_hz);
  const double most = std::max(rate, end_rate);
  if (most == 0) throw ArgumentError("a piece from rest to rest has no speed: plan one up, and one down");
  const double highest_rate = std::max(most, checked_rate("highest_speed", ramp.highest_speed, clock_hz));

  const auto ticks = static_cast<double>(ramp.ticks);
  const double acceleration = (end_rate - rate) * (end_rate + rate) / (2 * ticks);
  const double clocks = 2 * ticks / (rate + end_rate);

  // The first ticks pass at the previous speed. Then the card holds each rate for an update; the value used is the mean
  // of the update.
  const double lead = std::min(ticks, kFeedSwapDelay * rate);
  const bool one_rate = clocks < kRampUpdate;
  // The field holds -0.5 to 0.5 ticks per clock.
  if (!one_rate && std::abs(kRampUpdate * acceleration) >= 0.5) {
    throw ArgumentError(
        fmt::format("from {} to {} ticks/s in {} ticks: the rate changes by half a tick per clock or more within {} "
                    "clocks; give the piece more ticks",
                    ramp.speed, ramp.end_speed, ramp.ticks, kRampUpdate));
  }
  const double behind = std::sqrt(std::max(0.0, rate * rate + 2 * acceleration * lead));
  const double first = one_rate ? ticks / clocks : behind + kRampUpdate / 2 * acceleration;
  FeedCommand piece;
  piece.ticks = ramp.ticks;
  piece.rate = static_cast<std::uint64_t>(std::clamp(first, kLeastRampRate, 1 - 0x1p-53) * 0x1p64);
  piece.acceleration = one_rate ? 0 : static_cast<std::int64_t>(kRampUpdate * acceleration * 0x1p64);
  // By v^2 = 2 a s, a ramp to rest reaches sqrt(a) half a tick before rest; it keeps that rate to the end.
  const double slowest = std::max(end_rate, std::min(rate, std::sqrt(std::abs(acceleration))));
  const double floor = std::min(first, acceleration < 0 ? slowest : rate);
  piece.floor = static_cast<std::uint32_t>(std::clamp(floor, kLeastRampRate, 0.5) * 0x1p32);
  piece.stop_distance = stop_distance(ramp, highest_rate, clock_hz);
  return piece;
}

}  // namespace trammel::driver
