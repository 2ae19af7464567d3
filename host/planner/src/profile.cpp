#include "trammel/planner/profile.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "real.hpp"

namespace trammel::planner {
namespace {

constexpr std::uint64_t kMaxTicks = (std::uint64_t{1} << 40) - 1;

constexpr double kUpdate = static_cast<double>(kClocksPerUpdate);
constexpr int kUpdatePower = 5;
static_assert(kClocksPerUpdate == 1U << kUpdatePower);

// The card adds the upper 48 of the rate's 64 bits: a clock loses up to 2^-48 tick.
Real lost_in(Real clocks) { return clocks.scaled(-48); }

// Rates are at most kMaxTickRate.
std::uint64_t fixed64(Real rate) { return rate.floor(64); }
std::uint32_t fixed32(Real rate) { return std::max<std::uint32_t>(1, static_cast<std::uint32_t>(rate.floor(32))); }

// A ramp between the rest rate `low` and `high` over whole updates.
struct Ramp {
  Real low;
  Real high;
  Real updates;  // whole
  // Ticks that certainly pass before its updates are over.
  std::uint64_t ticks() const {
    const Real clocks = updates.scaled(kUpdatePower);
    const Real gross = (clocks * (low + high)).scaled(-1);
    const Real lost = lost_in(clocks);
    if (gross <= lost) return 0;
    const Real total = gross - lost;
    const Real most = Real::whole(kMaxTicks);
    return total < most ? total.floor() : kMaxTicks;
  }
};

Ramp ramp_to(Real low, Real high, Real acceleration) {
  const Real updates = ceiling(((high - low) / acceleration).scaled(-kUpdatePower));
  return {low, high, updates < Real::whole(1) ? Real::whole(1) : updates};
}

// The ramp that gains all it may in `ticks`. Its high rate is `low` when there is nothing to gain.
Ramp ramp_over(std::uint64_t ticks, Real low, Real acceleration) {
  const Real distance = Real::whole(ticks);
  const Real high = square_root(low * low + acceleration.scaled(1) * distance);
  const Ramp longest = ramp_to(low, high < low ? low : high, acceleration);
  const Real clocks = longest.updates.scaled(kUpdatePower);
  const Real twice_mean = (distance + lost_in(clocks)).scaled(1) / clocks;
  const Real reached = low < twice_mean ? twice_mean - low : low;
  return {low, reached < low ? low : reached, longest.updates};
}

driver::FeedCommand constant(std::uint64_t ticks, Real rate) {
  driver::FeedCommand piece;
  piece.ticks = ticks;
  piece.rate = std::max<std::uint64_t>(fixed64(rate), std::uint64_t{1} << 32);
  piece.floor = fixed32(rate);
  return piece;
}

driver::FeedCommand rising(const Ramp& ramp, Real gain, std::uint64_t ticks) {
  driver::FeedCommand piece = constant(ticks, ramp.low + gain.scaled(-1));
  // Rounded up: a ramp that fell short would go on into an update above its high rate.
  piece.acceleration = static_cast<std::int64_t>(fixed64(gain) + 1);
  piece.floor = fixed32(ramp.low);
  return piece;
}

driver::FeedCommand falling(const Ramp& ramp, Real loss, std::uint64_t ticks) {
  driver::FeedCommand piece = constant(ticks, ramp.high - loss.scaled(-1));
  piece.acceleration = -static_cast<std::int64_t>(fixed64(loss));
  piece.floor = fixed32(ramp.low);
  return piece;
}

void check(std::uint64_t ticks, const PathLimits& limits) {
  if (ticks == 0 || ticks > kMaxTicks) throw std::invalid_argument("ticks of a profile must be 1 .. 2^40 - 1");
  if (!(limits.length > 0) || !(limits.velocity > 0) || !(limits.acceleration > 0)) {
    throw std::invalid_argument("length, velocity and acceleration of a profile must be above 0");
  }
}

Profile one_rate(std::uint64_t ticks, Real rate, bool reaches_limit) {
  Profile profile;
  profile.add(constant(ticks, rate));
  profile.top_rate = rate.value();
  profile.reaches_limit = reaches_limit;
  return profile;
}

}  // namespace

Profile trapezoid(std::uint64_t ticks, const PathLimits& limits, std::uint32_t clock_hz) {
  check(ticks, limits);
  const Real density = Real::whole(ticks) / Real(limits.length);
  const Real clock = Real::whole(clock_hz);
  const Real wanted = Real(limits.velocity) * density / clock;
  const Real acceleration = Real(limits.acceleration) * density / clock / clock;
  const Real most = Real(kMaxTickRate);
  const bool possible = wanted <= most;
  const Real top = possible ? wanted : most;
  const Real free_rest = square_root(acceleration);
  const Real rest = free_rest < top ? free_rest : top;
  Ramp ramp = ramp_to(rest, top, acceleration);
  // A stop takes one tick more than the start: it ends on the floor, not a fraction of a tick above it.
  std::uint64_t start_ticks = ramp.ticks();
  if (top <= rest || start_ticks == 0) return one_rate(ticks, top, possible);
  Profile profile;
  std::uint64_t cruise_ticks = 0;
  if (2 * start_ticks + 1 <= ticks) {
    cruise_ticks = ticks - 2 * start_ticks - 1;
    profile.reaches_limit = possible;
  } else {
    start_ticks = (ticks - 1) / 2;
    if (start_ticks != 0) ramp = ramp_over(start_ticks, rest, acceleration);
    if (start_ticks == 0 || ramp.high <= rest) return one_rate(ticks, rest, false);
  }
  const Real gain = (ramp.high - ramp.low) / ramp.updates;
  profile.top_rate = ramp.high.value();
  profile.add(rising(ramp, gain, start_ticks));
  if (cruise_ticks != 0) profile.add(constant(cruise_ticks, top));
  profile.add(falling(ramp, gain, ticks - start_ticks - cruise_ticks));
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
