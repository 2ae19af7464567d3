// Turns the points of an arc into the fields of ARC_CHORD (with the driver), and computes the path of these fields from
// the rule for their increments alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "trammel/driver/arc_chord.hpp"
#include "trammel/model/arc_generator.hpp"

namespace trammel::model {

inline constexpr long double kTurn = 6.283185307179586476925286766559L;

struct Radii {
  long double start, end;
  long double mean() const { return (start + end) / 2; }
};

// Start and end in pulses, the centre in 1/256 pulses. Equal start and end mean one whole turn plus `turns` further
// ones.
struct ArcPoints {
  std::array<std::int64_t, 2> start{}, end{}, centre{};
  bool clockwise = false;
  unsigned turns = 0;
  unsigned ticks_a_pulse = 8;  // minimum
  std::uint8_t axis_x = 0;
  std::uint8_t axis_y = 1;

  // Angle from start to end without the further turns; above 0.
  long double sweep() const {
    const long double from = std::atan2(from_centre(start, 1), from_centre(start, 0));
    const long double to = std::atan2(from_centre(end, 1), from_centre(end, 0));
    const long double ahead = clockwise ? from - to : to - from;
    return ahead <= 1e-12L ? ahead + kTurn : ahead;
  }
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

inline ChordFields fields_of(const driver::ArcChordCommand& arc) {
  ChordFields fields;
  fields.state = {arc.x, arc.y, arc.closing_x, arc.closing_y, arc.k, arc.m, arc.clockwise};
  fields.first = {arc.first_x, arc.first_y};
  fields.path_ticks = arc.path_ticks;
  return fields;
}

// The command as a host prepares it. `ticks_a_pulse` determines the number of path ticks.
inline driver::ArcChordCommand prepare_command(const ArcPoints& arc, const std::array<std::int64_t, 8>& further = {}) {
  driver::HelixGeometry helix;
  driver::ArcGeometry& geometry = helix.arc;
  geometry.centre_x = arc.centre[0] - arc.start[0] * 256;
  geometry.centre_y = arc.centre[1] - arc.start[1] * 256;
  geometry.end_x = static_cast<std::int32_t>(arc.end[0] - arc.start[0]);
  geometry.end_y = static_cast<std::int32_t>(arc.end[1] - arc.start[1]);
  geometry.clockwise = arc.clockwise;
  geometry.sweep = static_cast<double>(arc.sweep());
  geometry.turns = arc.turns;
  geometry.axis_x = arc.axis_x;
  geometry.axis_y = arc.axis_y;
  helix.further = further;
  const long double length = (arc.sweep() + kTurn * arc.turns) * arc.radii().mean();
  const auto ticks = static_cast<std::uint64_t>(length * 2 * arc.ticks_a_pulse);
  return driver::make_helix(helix, std::max(ticks, driver::least_chord_ticks(helix)));
}

inline ChordFields prepare_chords(const ArcPoints& arc) { return fields_of(prepare_command(arc)); }

// The path of an arc, computed from step to step, and its chords.
class ChordPath {
 public:
  explicit ChordPath(const ChordFields& fields) : left_(fields.path_ticks), rotation_{fields.state} {
    // These chords apply from the second tick on; the first tick has increments of its own.
    increment_[1] = rotation_.chord_y();
    increment_[0] = rotation_.chord_x();
    half_ = std::uint64_t{1} << (fields.state.m - 1);
    run(1, fields.first, [] {});
  }

  const std::array<std::int64_t, 2>& position() const { return position_; }  // pulses from the start
  std::uint64_t ticks() const { return ticks_; }                             // path ticks made so far

  // Calls `visit()` after each tick that makes a step, from the second tick on.
  template <class Visit>
  void finish(Visit visit) {
    while (left_ != 0) half(visit);
  }
  // Runs to the end of the current half chord or of the path.
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
  const std::array<std::int64_t, 2>& increment() const { return increment_; }  // increments of the next tick

 private:
  static constexpr std::int64_t kOne = std::int64_t{1} << 40;

  // Number of consecutive ticks without a step.
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
