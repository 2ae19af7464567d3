// Commands for card tests: lines and pieces by their meaning, and random ones.
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

// A piece at a constant rate of one tick in `clocks`.
inline driver::FeedCommand feed(std::uint64_t ticks, double clocks) {
  driver::FeedCommand result;
  result.ticks = ticks;
  result.rate = static_cast<std::uint64_t>(0x1p64 * std::min(1 / clocks, 1 - 0x1p-50));
  result.floor = 1;
  return result;
}

// A quarter or a whole circle of up to 20 pulses about an axis crossing, on two axes by chance.
template <class Random>
driver::ArcCommand random_arc(Random&& random, unsigned axes) {
  driver::ArcGeometry arc;
  const auto radius = static_cast<std::int32_t>(1 + random(20));
  arc.clockwise = random(2) == 0;
  arc.centre_x = -radius * driver::kCentreUnitsPerPulse;
  const bool whole = random(3) == 0;
  arc.end_x = whole ? 0 : -radius;
  arc.end_y = whole ? 0 : (arc.clockwise ? -radius : radius);
  arc.sweep = whole ? 6.283185307179586 : 1.5707963267948966;
  arc.axis_x = static_cast<std::uint8_t>(random(axes));
  arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + 1 + random(axes - 1)) % axes);
  return driver::prepare(arc);
}

// A line, or one path in `arc_every` an arc, for ticks that come one in `pace` clocks; adds its ticks to `total`.
// `random(n)`: 0 .. n - 1.
template <class Random>
driver::Command random_path(Random&& random, unsigned axes, double pace, std::uint64_t& total, unsigned arc_every = 4) {
  const std::uint64_t ticks = random(3) == 0 ? 1 + random(30) : 1 + random(400);
  total += ticks;
  if (axes > 1 && random(arc_every) == 0) {
    const driver::ArcCommand arc = random_arc(random, axes);
    total += arc.path_ticks;
    driver::ArcCommand timed = driver::with_ticks(arc, ticks + arc.path_ticks);
    // An end that the walk does not meet: PATH_INCOMPLETE.
    if (random(20) == 0) timed.end_x += 3;
    return timed;
  }
  std::vector<std::int64_t> pulses(axes);
  // Steps come no closer than the shaper serves them, but for some lines that overrun it.
  const double most = static_cast<double>(ticks) * (random(40) == 0 ? 1.0 : std::min(1.0, pace / 14));
  for (std::int64_t& p : pulses) {
    const auto bound = static_cast<std::uint64_t>(most) + 1;
    p = static_cast<std::int64_t>(random(2 * bound + 1)) - static_cast<std::int64_t>(bound);
    p = std::clamp(p, -static_cast<std::int64_t>(ticks), static_cast<std::int64_t>(ticks));
  }
  return line(ticks, pulses);
}

// A piece about one tick in `pace` clocks, half of them with acceleration and jerk.
template <class Random>
driver::FeedCommand random_piece(Random&& random, std::uint64_t ticks, double pace) {
  driver::FeedCommand result = feed(ticks, pace);
  result.floor = static_cast<std::uint32_t>(0x1p32 / (4 * pace));
  if (random(2) == 0) {
    const double change = (static_cast<double>(random(2001)) - 1000) / 1000;
    result.acceleration = static_cast<std::int64_t>(change * 0x1p64 / pace / pace / static_cast<double>(ticks));
    result.jerk = -result.acceleration / static_cast<std::int64_t>(1 + random(100));
  }
  return result;
}

}  // namespace trammel::test
