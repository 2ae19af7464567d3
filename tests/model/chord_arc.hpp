// From an arc's points to what ARC_CHORD carries, and the path that the fields make by the rule of their increments
// alone. Floating point for angles; for tests on one machine, until the driver prepares arcs portably.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "trammel/model/arc_generator.hpp"

namespace trammel::model {

inline constexpr long double kTurn = 6.283185307179586476925286766559L;

struct Radii {
  long double start, end;
  long double mean() const { return (start + end) / 2; }
};

// Start and end in pulses, the centre in 1/256 pulses. Start and end alike: a whole turn, and `turns` further ones.
struct ArcPoints {
  std::array<std::int64_t, 2> start{}, end{}, centre{};
  bool clockwise = false;
  unsigned turns = 0;
  unsigned ticks_a_pulse = 8;  // at least

  long double from_centre(const std::array<std::int64_t, 2>& point, unsigned axis) const {
    return static_cast<long double>(point[axis] * 256 - centre[axis]) / 256;
  }
  Radii radii() const {
    return {std::hypot(from_centre(start, 0), from_centre(start, 1)),
            std::hypot(from_centre(end, 0), from_centre(end, 1))};
  }
};

struct ChordFields {
  ChordRotation::State state;
  std::array<std::int64_t, 2> first{};
  std::uint64_t path_ticks = 0;
};

namespace chord_arc {

inline std::int64_t rounded(long double value, int fraction_bits) {
  return static_cast<std::int64_t>(std::llround(std::ldexp(value, fraction_bits)));
}

// From a point at `radius` to the circle `mean`, along the radius, at most 3/8 pulse.
inline long double to_circle(long double radius, long double mean) {
  return std::max(-0.375L, std::min(0.375L, mean - radius));
}

// Where the chords are after `chords` chords from the first one's start, for the coordinate whose angle is `at(time)`:
// on the straight line between the two ends, which lie `late` after whole times.
template <class At>
long double on_chords(At at, long double chords, long double late) {
  const long double whole = std::floor(chords - late);
  const long double part = chords - late - whole;
  return at(whole + late) + part * (at(whole + late + 1) - at(whole + late));
}

}  // namespace chord_arc

// A radius below 2^31, at most half a pulse a tick.
inline ChordFields prepare_chords(const ArcPoints& arc) {
  using namespace chord_arc;
  const long double sense = arc.clockwise ? -1 : 1;
  const Radii radii = arc.radii();
  const long double radius = radii.mean();
  const long double a0 = std::atan2(arc.from_centre(arc.start, 1), arc.from_centre(arc.start, 0));
  const long double a1 = std::atan2(arc.from_centre(arc.end, 1), arc.from_centre(arc.end, 0));
  long double sweep = sense * (a1 - a0);
  while (sweep <= 1e-12L) sweep += kTurn;
  sweep += kTurn * arc.turns;

  ChordFields fields;
  ChordRotation::State& state = fields.state;
  state.clockwise = arc.clockwise;
  while (std::ldexp(radius, -state.k) > std::min(std::sqrt(radius) / 2, 16.0L)) ++state.k;
  // A coordinate has 64 bits, and a chord the ticks that its length asks for.
  while (std::ldexp(1.0L, state.m) < std::ldexp(radius, -state.k) * arc.ticks_a_pulse ||
         std::ldexp(radius, 40 - state.m) >= 0x1p62L)
    ++state.m;
  const long double turn = 2 * std::asin(std::ldexp(1.0L, -state.k - 1));
  fields.path_ticks = static_cast<std::uint64_t>(std::max<std::int64_t>(1, rounded(sweep / turn, state.m)));

  const int bits = 40 - state.m;
  state.x = rounded(radius * std::cos(a0), bits);
  state.y = rounded(radius * std::sin(a0 - sense * turn / 2), bits);

  const auto x_at = [&](long double chords) { return radius * std::cos(a0 + sense * turn * chords); };
  const auto y_at = [&](long double chords) { return radius * std::sin(a0 + sense * turn * chords); };
  const long double chords = std::ldexp(static_cast<long double>(fields.path_ticks), -state.m);
  const long double onto = to_circle(radii.start, radius);
  const long double off = to_circle(radii.end, radius);
  const long double preset[2] = {onto * std::cos(a0), onto * std::sin(a0)};
  const long double moved[2] = {on_chords(x_at, chords, 0) - on_chords(x_at, 0, 0),
                                on_chords(y_at, chords, 0.5L) - on_chords(y_at, 0, 0.5L)};
  const long double wanted[2] = {off * std::cos(a1), off * std::sin(a1)};
  std::int64_t closing[2];
  for (unsigned i = 0; i < 2; ++i) {
    const long double left = static_cast<long double>(arc.end[i] - arc.start[i]) + wanted[i] - preset[i] - moved[i];
    closing[i] = rounded(left / static_cast<long double>(fields.path_ticks), 40);
  }
  state.closing_x = closing[0];
  state.closing_y = closing[1];
  ChordRotation rotation{state};
  fields.first[1] = rotation.chord_y() + rounded(preset[1], 40);
  fields.first[0] = rotation.chord_x() + rounded(preset[0], 40);
  return fields;
}

// The path of an arc from one step to the next, and its chords.
class ChordPath {
 public:
  explicit ChordPath(const ChordFields& fields) : left_(fields.path_ticks), rotation_{fields.state} {
    // The chords in force from the second tick on; the first tick has increments of its own.
    increment_[1] = rotation_.chord_y();
    increment_[0] = rotation_.chord_x();
    half_ = std::uint64_t{1} << (fields.state.m - 1);
    run(1, fields.first, [] {});
  }

  const std::array<std::int64_t, 2>& position() const { return position_; }  // from the start, pulses
  std::uint64_t ticks() const { return ticks_; }                             // made

  // `visit()` after each tick with a step, from the second tick on.
  template <class Visit>
  void finish(Visit visit) {
    while (left_ != 0) half(visit);
  }
  // On to the end of the half chord under way, or of the path.
  template <class Visit>
  void half(Visit visit) {
    run(std::min(half_ - ticks_ % half_, left_), increment_, visit);
    if (ticks_ % half_ != 0) return;
    if (ticks_ / half_ % 2 != 0)
      increment_[1] = rotation_.chord_y();
    else
      increment_[0] = rotation_.chord_x();
  }
  std::uint64_t left() const { return left_; }
  const std::array<std::int64_t, 2>& increment() const { return increment_; }  // of the next tick

 private:
  static constexpr std::int64_t kOne = std::int64_t{1} << 40;

  // How many ticks in a row make no step.
  std::uint64_t silent(unsigned axis, std::int64_t by) const {
    if (by == 0) return UINT64_MAX;
    return static_cast<std::uint64_t>(by > 0 ? (kOne - 1 - phase_[axis]) / by : phase_[axis] / -by);
  }

  template <class Visit>
  void run(std::uint64_t ticks, const std::array<std::int64_t, 2>& by, Visit visit) {
    left_ -= ticks;
    ticks_ += ticks;
    std::array<std::uint64_t, 2> next{silent(0, by[0]), silent(1, by[1])};
    for (;;) {
      const std::uint64_t quiet = std::min(next[0], next[1]);
      const std::uint64_t made = quiet < ticks ? quiet + 1 : ticks;
      bool stepped = false;
      for (unsigned i = 0; i < 2; ++i) {
        phase_[i] += static_cast<std::int64_t>(made) * by[i];
        if (quiet >= ticks) continue;
        if (next[i] != quiet) {
          if (next[i] != UINT64_MAX) next[i] -= made;
          continue;
        }
        position_[i] += by[i] > 0 ? 1 : -1;
        phase_[i] -= by[i] > 0 ? kOne : -kOne;
        next[i] = silent(i, by[i]);
        stepped = true;
      }
      ticks -= made;
      if (stepped) visit();
      if (ticks == 0) return;
    }
  }

  std::uint64_t left_;
  std::uint64_t ticks_ = 0;
  std::uint64_t half_ = 0;
  ChordRotation rotation_;
  std::array<std::int64_t, 2> increment_{};
  std::array<std::int64_t, 2> phase_{kOne / 2, kOne / 2};
  std::array<std::int64_t, 2> position_{};
};

}  // namespace trammel::model
