// Commands for card tests: lines and pieces from physical values, and random ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::test {

// A line of p pulses on each axis over `ticks` ticks.
inline driver::LineCommand line(std::uint64_t ticks, const std::vector<std::int64_t>& pulses) {
  driver::LineCommand result;
  result.ticks = ticks;
  for (std::size_t n = 0; n < pulses.size(); ++n) {
    if (pulses[n] == 0) continue;
    result.mask = static_cast<std::uint8_t>(result.mask | 1U << n);
    const auto magnitude = static_cast<std::uint64_t>(std::abs(pulses[n])) << 40;
    const auto increment = static_cast<std::int64_t>((magnitude + ticks / 2) / ticks);
    result.increment[n] = pulses[n] < 0 ? -increment : increment;
  }
  if (result.mask == 0) result.mask = 1;
  return result;
}

// A piece at a constant rate of one tick per `clocks` clocks.
inline driver::FeedCommand feed(std::uint64_t ticks, double clocks) {
  driver::FeedCommand result;
  result.ticks = ticks;
  result.rate = static_cast<std::uint64_t>(0x1p64 * std::min(1 / clocks, 1 - 0x1p-50));
  result.floor = 1;
  return result;
}

// A quarter or a full circle of up to 20 pulses about an axis crossing, on two random axes, by either step rule.
template <class Random>
driver::ArcCommand random_arc(Random&& random, unsigned axes) {
  driver::ArcGeometry arc;
  const auto radius = static_cast<std::int32_t>(2 + random(19));
  arc.clockwise = random(2) == 0;
  arc.centre_x = -radius * driver::kCentreUnitsPerPulse;
  const bool whole = random(3) == 0;
  arc.end_x = whole ? 0 : -radius;
  arc.end_y = whole ? 0 : (arc.clockwise ? -radius : radius);
  arc.sweep = whole ? 6.283185307179586 : 1.5707963267948966;
  arc.axis_x = static_cast<std::uint8_t>(random(axes));
  arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + 1 + random(axes - 1)) % axes);
  return driver::prepare(arc, random(2) == 0 ? driver::StepRule::kFourDirections : driver::StepRule::kEightDirections);
}

// An arc in chords, with random further axes, as words without their number; adds its ticks to `total`. The sum of
// the increments is at most one pulse per tick.
template <class Random>
std::vector<std::uint32_t> random_chords(Random&& random, unsigned axes, std::uint64_t& total) {
  const std::uint64_t path_ticks = 1 + random(600);
  const std::uint64_t ticks = path_ticks + random(600);
  const std::uint64_t x = random(axes);
  const std::uint64_t y = (x + 1 + random(axes - 1)) % axes;
  const std::uint64_t mask = 1U << x | 1U << y | random(std::uint64_t{1} << axes);
  const std::uint64_t k = 1 + random(24);
  std::vector<std::uint16_t> halfwords{static_cast<std::uint16_t>(3 | mask << 8), 0};
  const auto put = [&halfwords](std::uint64_t value, unsigned count) {
    for (unsigned i = 0; i < count; ++i) halfwords.push_back(static_cast<std::uint16_t>(value >> (16 * i)));
  };
  const auto any = [&random](std::uint64_t bits) {
    const std::uint64_t magnitude = random(std::uint64_t{1} << bits);
    return random(2) == 0 ? magnitude : std::uint64_t{0} - magnitude;
  };
  put(ticks, 3);
  put(path_ticks, 3);
  // Rounded; exact in 64 bits, because there are few ticks.
  put(((path_ticks << 40) + ticks / 2) / ticks, 3);
  put(y << 8 | x << 4 | random(2), 1);
  put((5 + random(4)) << 8 | k, 1);
  put(any(k + 36), 4);
  put(any(k + 36), 4);
  for (const std::uint64_t bits : {38U, 38U, 34U, 34U}) put(any(bits), 3);
  for (unsigned axis = 0; axis < axes; ++axis) {
    if (axis != x && axis != y && (mask >> axis & 1) != 0) put(any(38), 3);
  }
  if (halfwords.size() % 2 != 0) halfwords.push_back(0);
  halfwords[1] = static_cast<std::uint16_t>(halfwords.size() / 2);
  std::vector<std::uint32_t> words;
  for (std::size_t i = 0; i < halfwords.size(); i += 2)
    words.push_back(halfwords[i] | std::uint32_t{halfwords[i + 1]} << 16);
  total += ticks;
  return words;
}

// A line, or for one path in `arc_every` an arc, for one tick per `pace` clocks; adds its ticks to `total`.
// `random(n)`: 0 .. n - 1.
template <class Random>
driver::Command random_path(Random&& random, unsigned axes, double pace, std::uint64_t& total, unsigned arc_every = 4) {
  const std::uint64_t ticks = random(3) == 0 ? 1 + random(30) : 1 + random(400);
  total += ticks;
  if (axes > 1 && random(arc_every) == 0) {
    const driver::ArcCommand arc = random_arc(random, axes);
    total += arc.path_ticks;
    driver::ArcCommand timed = driver::with_ticks(arc, ticks + arc.path_ticks);
    // An end that the walk does not reach: PATH_INCOMPLETE.
    if (random(20) == 0) timed.end_x += 3;
    return timed;
  }
  std::vector<std::int64_t> pulses(axes);
  // Steps come no faster than the shaper makes them, except on some lines that overrun it.
  const double most = static_cast<double>(ticks) * (random(40) == 0 ? 1.0 : std::min(1.0, pace / 14));
  for (std::int64_t& p : pulses) {
    const auto bound = static_cast<std::uint64_t>(most) + 1;
    p = static_cast<std::int64_t>(random(2 * bound + 1)) - static_cast<std::int64_t>(bound);
    p = std::clamp(p, -static_cast<std::int64_t>(ticks), static_cast<std::int64_t>(ticks));
  }
  return line(ticks, pulses);
}

// A piece with about one tick per `pace` clocks; half of the pieces have acceleration and jerk.
template <class Random>
driver::FeedCommand random_piece(Random&& random, std::uint64_t ticks, double pace) {
  driver::FeedCommand result = feed(ticks, pace);
  result.floor = static_cast<std::uint32_t>(0x1p32 / (4 * pace));
  if (random(2) == 0) {
    const double change = (static_cast<double>(random(2001)) - 1000) / 1000;
    constexpr double kMost = 0x1.fffffffffffffp62;  // the largest double below 2^63
    const double acceleration = change * 0x1p64 / pace / pace / static_cast<double>(ticks);
    result.acceleration = static_cast<std::int64_t>(std::clamp(acceleration, -kMost, kMost));
    result.jerk = -result.acceleration / static_cast<std::int64_t>(1 + random(100));
  }
  if (random(3) == 0) result.stop_distance = static_cast<std::uint32_t>(1 + random(random(8) == 0 ? 1U << 31 : 2000));
  return result;
}

}  // namespace trammel::test
