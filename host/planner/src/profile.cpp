#include "trammel/planner/profile.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trammel::planner {
namespace {

constexpr std::uint64_t kMaxTicks = (std::uint64_t{1} << 40) - 1;

// The card adds the upper 48 of the rate's 64 bits: a clock loses up to 2^-48 tick.
const long double kLostPerClock = std::ldexp(1.0L, -48);

long double update_clocks() { return static_cast<long double>(kClocksPerUpdate); }

std::uint64_t fixed64(long double rate) { return static_cast<std::uint64_t>(std::ldexp(rate, 64)); }

std::uint32_t fixed32(long double rate) {
  const long double units = std::floor(std::ldexp(rate, 32));
  return static_cast<std::uint32_t>(std::clamp(units, 1.0L, 4294967295.0L));
}

// A ramp between the rest rate `low` and `high` over whole updates.
struct Ramp {
  long double low;
  long double high;
  long double updates;  // whole
  // Ticks that certainly pass before its updates are over.
  std::uint64_t ticks() const {
    const long double clocks = updates * update_clocks();
    const long double total = clocks * (low + high) / 2 - clocks * kLostPerClock;
    return total < 1 ? 0 : static_cast<std::uint64_t>(std::min(total, static_cast<long double>(kMaxTicks)));
  }
};

Ramp ramp_to(long double low, long double high, long double acceleration) {
  const long double clocks = (high - low) / acceleration;
  return {low, high, std::max(1.0L, std::ceil(clocks / update_clocks()))};
}

// The ramp that gains all it may in `ticks`. Its high rate is at most low when there is nothing to gain.
Ramp ramp_over(std::uint64_t ticks, long double low, long double acceleration) {
  const long double distance = static_cast<long double>(ticks);
  const long double high = std::sqrt(low * low + 2 * acceleration * distance);
  const Ramp longest = ramp_to(low, high, acceleration);
  const long double clocks = longest.updates * update_clocks();
  return {low, 2 * (distance + clocks * kLostPerClock) / clocks - low, longest.updates};
}

driver::FeedCommand constant(std::uint64_t ticks, long double rate) {
  driver::FeedCommand piece;
  piece.ticks = ticks;
  piece.rate = std::max<std::uint64_t>(fixed64(rate), std::uint64_t{1} << 32);
  piece.floor = fixed32(rate);
  return piece;
}

driver::FeedCommand rising(const Ramp& ramp, std::uint64_t ticks) {
  const long double gain = (ramp.high - ramp.low) / ramp.updates;
  driver::FeedCommand piece = constant(ticks, ramp.low + gain / 2);
  // Rounded up: a ramp that fell short would go on into an update above its high rate.
  piece.acceleration = static_cast<std::int64_t>(fixed64(gain) + 1);
  piece.floor = fixed32(ramp.low);
  return piece;
}

driver::FeedCommand falling(const Ramp& ramp, std::uint64_t ticks) {
  const long double loss = (ramp.high - ramp.low) / ramp.updates;
  driver::FeedCommand piece = constant(ticks, ramp.high - loss / 2);
  piece.acceleration = -static_cast<std::int64_t>(fixed64(loss));
  piece.floor = fixed32(ramp.low);
  return piece;
}

void check(std::uint64_t ticks, const ProfileLimits& limits) {
  if (ticks == 0 || ticks > kMaxTicks) {
    throw std::invalid_argument("ticks of a profile must be 1 .. 2^40 - 1");
  }
  if (!(limits.rate > 0) || !(limits.acceleration > 0)) {
    throw std::invalid_argument("rate and acceleration of a profile must be above 0");
  }
}

}  // namespace

std::vector<driver::FeedCommand> trapezoid(std::uint64_t ticks, const ProfileLimits& limits) {
  check(ticks, limits);
  const long double top = std::min(limits.rate, static_cast<long double>(kMaxTickRate));
  const long double rest = std::min(std::sqrt(limits.acceleration), top);
  Ramp ramp = ramp_to(rest, top, limits.acceleration);
  // A stop takes one tick more than the start: it ends on the floor, not a fraction of a tick above it.
  const std::uint64_t start_ticks = ramp.ticks();
  if (top <= rest || start_ticks == 0) {
    return {constant(ticks, top)};
  }
  if (2 * start_ticks + 1 <= ticks) {
    std::vector<driver::FeedCommand> pieces = {rising(ramp, start_ticks)};
    const std::uint64_t cruise_ticks = ticks - 2 * start_ticks - 1;
    if (cruise_ticks != 0) {
      pieces.push_back(constant(cruise_ticks, top));
    }
    pieces.push_back(falling(ramp, start_ticks + 1));
    return pieces;
  }
  const std::uint64_t half = (ticks - 1) / 2;
  if (half != 0) {
    ramp = ramp_over(half, rest, limits.acceleration);
  }
  if (half == 0 || ramp.high <= rest) {
    return {constant(ticks, rest)};
  }
  return {rising(ramp, half), falling(ramp, ticks - half)};
}

long double duration(const std::vector<driver::FeedCommand>& pieces) {
  long double clocks = 0;
  for (const driver::FeedCommand& piece : pieces) {
    const long double ticks = static_cast<long double>(piece.ticks);
    const long double gain = std::ldexp(static_cast<long double>(piece.acceleration), -64) / update_clocks();
    const long double start = std::ldexp(static_cast<long double>(piece.rate), -64) - gain * update_clocks() / 2;
    const long double floor = std::ldexp(static_cast<long double>(piece.floor), -32);
    const long double end = std::max(std::sqrt(std::max(0.0L, start * start + 2 * gain * ticks)), floor);
    clocks += 2 * ticks / (start + end);
  }
  return clocks;
}

}  // namespace trammel::planner
