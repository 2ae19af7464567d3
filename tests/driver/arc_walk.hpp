// Arcs walked by the golden model, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "trammel/driver/arc.hpp"
#include "trammel/driver/trigonometry.hpp"
#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::driver {

using model::DeviationPath;

inline DeviationPath path_of(const ArcCommand& arc) {
  const auto aligned = [](const Int128& value) {
    using Word = DeviationPath::Word;
    const Word word =
        static_cast<Word>(static_cast<std::uint64_t>(value.high())) << 64 | static_cast<Word>(value.low());
    return word << DeviationPath::kAlign;
  };
  DeviationPath path;
  path.state.deviation = aligned(arc.deviation);
  path.state.gradient_x = aligned(arc.gradient_x);
  path.state.gradient_y = aligned(arc.gradient_y);
  path.state.half_x = arc.half_x;
  path.state.half_y = arc.half_y;
  path.state.left_x = static_cast<std::uint32_t>(arc.end_x);
  path.state.left_y = static_cast<std::uint32_t>(arc.end_y);
  path.state.quadrants = arc.quadrants;
  path.state.clockwise = arc.clockwise;
  path.state.eight_directions = arc.eight_directions;
  path.begin();
  return path;
}

// Walks the arc and calls `visit(x, y)` after every step, with the point relative to the start. Returns true if the
// walk reaches the end point after exactly L steps and not before.
template <class Visit>
bool walk(const ArcCommand& arc, Visit&& visit) {
  DeviationPath path = path_of(arc);
  std::int64_t x = 0;
  std::int64_t y = 0;
  for (std::uint64_t i = 0; i < arc.path_ticks; ++i) {
    if (path.at_end()) return false;
    const auto step = path.step();
    if (step.in_x) x += step.negative_x ? -1 : 1;
    if (step.in_y) y += step.negative_y ? -1 : 1;
    visit(x, y);
  }
  return path.at_end() && x == arc.end_x && y == arc.end_y;
}

// The angle from start to end in the given direction, 0 .. 2 pi.
inline double sweep_between(double from, double to, bool clockwise) {
  const double sweep = std::remainder(clockwise ? from - to : to - from, 2 * kPi);
  return sweep < 0 ? sweep + 2 * kPi : sweep;
}

// A 32-bit host of the tests is emulated, so it runs one case in 50.
inline constexpr bool kFewCases = sizeof(void*) < 8;
constexpr int some_of(int count) { return kFewCases ? std::max(1, count / 50) : count; }

}  // namespace trammel::driver
