#include "jog_profile.hpp"

#include <algorithm>
#include <cmath>

#include "trammel/card_map.hpp"

namespace trammel::run {
namespace {

constexpr double kUpdate = card_map::constant::kUpdateClocks;

std::uint32_t floor_of(double rate) { return static_cast<std::uint32_t>(std::max(1.0, rate * 0x1p32)); }

// A piece with constant acceleration that begins at rate `from`. The card holds the rate for an update and then adds
// `gain`, so the first rate is half a gain above `from`.
driver::FeedCommand piece(std::uint64_t ticks, double from, double gain, double floor) {
  driver::FeedCommand command;
  command.ticks = ticks;
  command.rate =
      std::max<std::uint64_t>(static_cast<std::uint64_t>((from + gain / 2) * 0x1p64), std::uint64_t{1} << 32);
  command.acceleration = static_cast<std::int64_t>(gain * 0x1p64);
  command.floor = floor_of(floor);
  return command;
}

}  // namespace

std::vector<driver::FeedCommand> jog_profile(std::uint64_t ticks, double rate, double acceleration) {
  // At a lower rate the last tick of a stop would take too long.
  const double rest = std::min(std::sqrt(acceleration), rate);
  const auto updates_to = [&](double top) { return std::max(1.0, std::ceil((top - rest) / (acceleration * kUpdate))); };
  double top = rate;
  double updates = updates_to(top);
  double ramp = std::floor(updates * kUpdate * (rest + top) / 2);
  const bool reached = 2 * ramp + 1 <= static_cast<double>(ticks);
  if (!reached) {
    ramp = std::floor((static_cast<double>(ticks) - 1) / 2);
    updates = updates_to(std::sqrt(rest * rest + 2 * acceleration * ramp));
    top = 2 * ramp / (updates * kUpdate) - rest;
  }
  if (ramp < 1 || top <= rest) return {piece(ticks, rest, 0, rest)};
  const double gain = (top - rest) / updates;
  const auto up = static_cast<std::uint64_t>(ramp);
  // A stop takes one tick more than the start: it ends on the floor, not a fraction of a tick above it.
  const std::uint64_t cruise = reached ? ticks - 2 * up - 1 : 0;
  std::vector<driver::FeedCommand> pieces{piece(up, rest, gain, rest)};
  if (cruise != 0) pieces.push_back(piece(cruise, top, 0, top));
  pieces.push_back(piece(ticks - up - cruise, top, -gain, rest));
  return pieces;
}

}  // namespace trammel::run
