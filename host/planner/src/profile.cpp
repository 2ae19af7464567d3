#include "trammel/planner/profile.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trammel::planner {
namespace {

constexpr std::uint64_t kMaxTicks = (std::uint64_t{1} << 40) - 1;

// The card adds the upper 48 of the rate's 64 bits: a clock loses up to 2^-48 tick.
constexpr double kLostPerClock = 0x1p-48;
// A ramp's ticks are a product of rounded numbers: less than this share too many.
constexpr double kRounding = 0x1p-50;

constexpr double kUpdate = static_cast<double>(kClocksPerUpdate);

// Rates are at most kMaxTickRate.
std::uint64_t fixed64(double rate) { return static_cast<std::uint64_t>(rate * 0x1p64); }

std::uint32_t fixed32(double rate) { return static_cast<std::uint32_t>(std::clamp(rate * 0x1p32, 1.0, 4294967295.0)); }

// A ramp between the rest rate `low` and `high` over whole updates.
struct Ramp {
  double low;
  double high;
  double updates;  // whole
  // Ticks that certainly pass before its updates are over.
  std::uint64_t ticks() const {
    const double clocks = updates * kUpdate;
    const double gross = clocks * (low + high) / 2;
    const double total = gross - gross * kRounding - clocks * kLostPerClock;
    return total < 1 ? 0 : static_cast<std::uint64_t>(std::min(total, static_cast<double>(kMaxTicks)));
  }
};

Ramp ramp_to(double low, double high, double acceleration) {
  return {low, high, std::max(1.0, std::ceil((high - low) / acceleration / kUpdate))};
}

// The ramp that gains all it may in `ticks`. Its high rate is at most low when there is nothing to gain.
Ramp ramp_over(std::uint64_t ticks, double low, double acceleration) {
  const double distance = static_cast<double>(ticks);
  const double high = std::sqrt(low * low + 2 * acceleration * distance);
  const Ramp longest = ramp_to(low, high, acceleration);
  const double clocks = longest.updates * kUpdate;
  return {low, 2 * (distance + clocks * kLostPerClock) / clocks - low, longest.updates};
}

driver::FeedCommand constant(std::uint64_t ticks, double rate) {
  driver::FeedCommand piece;
  piece.ticks = ticks;
  piece.rate = std::max<std::uint64_t>(fixed64(rate), std::uint64_t{1} << 32);
  piece.floor = fixed32(rate);
  return piece;
}

driver::FeedCommand rising(const Ramp& ramp, std::uint64_t ticks) {
  const double gain = (ramp.high - ramp.low) / ramp.updates;
  driver::FeedCommand piece = constant(ticks, ramp.low + gain / 2);
  // Rounded up: a ramp that fell short would go on into an update above its high rate.
  piece.acceleration = static_cast<std::int64_t>(fixed64(gain) + 1);
  piece.floor = fixed32(ramp.low);
  return piece;
}

driver::FeedCommand falling(const Ramp& ramp, std::uint64_t ticks) {
  const double loss = (ramp.high - ramp.low) / ramp.updates;
  driver::FeedCommand piece = constant(ticks, ramp.high - loss / 2);
  piece.acceleration = -static_cast<std::int64_t>(fixed64(loss));
  piece.floor = fixed32(ramp.low);
  return piece;
}

void check(std::uint64_t ticks, const ProfileLimits& limits) {
  if (ticks == 0 || ticks > kMaxTicks) throw std::invalid_argument("ticks of a profile must be 1 .. 2^40 - 1");
  if (!(limits.rate > 0) || !(limits.acceleration > 0)) {
    throw std::invalid_argument("rate and acceleration of a profile must be above 0");
  }
}

Profile one_rate(std::uint64_t ticks, double rate) {
  Profile profile;
  profile.add(constant(ticks, rate));
  profile.top_rate = rate;
  return profile;
}

}  // namespace

Profile trapezoid(std::uint64_t ticks, const ProfileLimits& limits) {
  check(ticks, limits);
  const double top = std::min(limits.rate, kMaxTickRate);
  const double rest = std::min(std::sqrt(limits.acceleration), top);
  Ramp ramp = ramp_to(rest, top, limits.acceleration);
  // A stop takes one tick more than the start: it ends on the floor, not a fraction of a tick above it.
  std::uint64_t start_ticks = ramp.ticks();
  if (top <= rest || start_ticks == 0) return one_rate(ticks, top);
  std::uint64_t cruise_ticks = 0;
  if (2 * start_ticks + 1 <= ticks) {
    cruise_ticks = ticks - 2 * start_ticks - 1;
  } else {
    start_ticks = (ticks - 1) / 2;
    if (start_ticks != 0) ramp = ramp_over(start_ticks, rest, limits.acceleration);
    if (start_ticks == 0 || ramp.high <= rest) return one_rate(ticks, rest);
  }
  Profile profile;
  profile.top_rate = ramp.high;
  profile.add(rising(ramp, start_ticks));
  if (cruise_ticks != 0) profile.add(constant(cruise_ticks, top));
  profile.add(falling(ramp, ticks - start_ticks - cruise_ticks));
  return profile;
}

double duration(const Profile& profile) {
  double clocks = 0;
  for (const driver::FeedCommand& piece : profile) {
    const double ticks = static_cast<double>(piece.ticks);
    const double gain = static_cast<double>(piece.acceleration) * 0x1p-64 / kUpdate;
    const double start = static_cast<double>(piece.rate) * 0x1p-64 - gain * kUpdate / 2;
    const double floor = piece.floor * 0x1p-32;
    const double end = std::max(std::sqrt(std::max(0.0, start * start + 2 * gain * ticks)), floor);
    clocks += 2 * ticks / (start + end);
  }
  return clocks;
}

}  // namespace trammel::planner
