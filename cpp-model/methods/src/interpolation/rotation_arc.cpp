#include "trammel/interpolation/rotation_arc.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::interpolation {
namespace {

// Radii up to 2^30 with 32 fraction bits need 62 bits: more than a double has.
using Real = long double;

const Real kTurn = 2 * std::acos(static_cast<Real>(-1));

std::int64_t fixed(Real value, int fraction) { return std::llround(std::ldexp(value, fraction)); }

// The geometry of an arc, relative to its centre.
struct Geometry {
  Real start_radius;
  Real end_radius;
  Real start_angle;
  Real end_angle;
  Real sign;   // 1 counter-clockwise, -1 clockwise
  Real sweep;  // > 0

  explicit Geometry(const Arc& arc) {
    const auto x0 = static_cast<Real>(arc.start.x - arc.centre.x);
    const auto y0 = static_cast<Real>(arc.start.y - arc.centre.y);
    const auto x1 = static_cast<Real>(arc.end.x - arc.centre.x);
    const auto y1 = static_cast<Real>(arc.end.y - arc.centre.y);
    start_radius = std::hypot(x0, y0);
    end_radius = std::hypot(x1, y1);
    start_angle = std::atan2(y0, x0);
    end_angle = std::atan2(y1, x1);
    sign = arc.clockwise ? -1 : 1;
    sweep = sign * (end_angle - start_angle);
    if (arc.is_full() || sweep < 0) sweep += kTurn;
  }
  // The mean, which halves the difference that rounding made between the two.
  Real radius() const { return (start_radius + end_radius) / 2; }
};

// The distance along the radius from a point of radius `from` to the circle. It is clamped so that the phase, preset
// to one half plus this, keeps an eighth of a pulse of room on either side.
Real phase_offset(Real from, Real radius) {
  constexpr Real kLimit = 0.375L;
  return std::clamp(radius - from, -kLimit, kLimit);
}

// A point on the chain of chords, `time` chords after a corner.
struct ChordPoint {
  Real whole;
  Real part;
  explicit ChordPoint(Real time) : whole(std::floor(time)), part(time - whole) {}
  template <class Function>
  Real at(Function function) const {
    return (1 - part) * function(whole) + part * function(whole + 1);
  }
};

}  // namespace

RotationArc::RotationArc(const Arc& circle)
    : position_{circle.start.x, circle.start.y, 0, 0}, sign_(circle.clockwise ? -1 : 1) {
  const Geometry arc(circle);
  const Real radius = arc.radius();
  const Real largest = std::max(arc.start_radius, arc.end_radius);
  // Chords of at most 16 pulses, and so short that the sagitta stays below 1/32 pulse.
  while (std::ldexp(largest, -shift_) > std::min(std::sqrt(largest) / 2, Real{16})) ++shift_;
  const Real chord = std::ldexp(Real{1}, -shift_);  // relative to the radius
  const Real angle = 2 * std::asin(chord / 2);
  chord_bits_ = kSparse;
  while (std::ldexp(Real{1}, chord_bits_) < kDense * chord * largest) ++chord_bits_;
  ticks_ = static_cast<std::uint64_t>(std::max<long long>(1, std::llround(std::ldexp(arc.sweep / angle, chord_bits_))));

  const Real turn = arc.sign * angle;
  const auto x_corner = [&](Real j) { return radius * std::cos(arc.start_angle + turn * j); };
  const auto y_corner = [&](Real j) { return radius * std::sin(arc.start_angle + turn * (j + 0.5L)); };
  x_ = fixed(x_corner(0), kFraction);
  y_ = fixed(y_corner(0), kFraction);
  chord_x_ = -sign_ * turned(y_);
  chord_y_ = sign_ * turned(x_);

  const Real start_offset = phase_offset(arc.start_radius, radius);
  const Real end_offset = phase_offset(arc.end_radius, radius);
  const Real from_x = std::cos(arc.start_angle) * start_offset;
  const Real from_y = std::sin(arc.start_angle) * start_offset;
  phase_x_ = fixed(0.5L + from_x, kPhase);
  phase_y_ = fixed(0.5L + from_y, kPhase);
  // The difference between the end of the chords and the end's phase, spread over the ticks.
  const Real chords = std::ldexp(static_cast<Real>(ticks_), -chord_bits_);
  const Real made_x = ChordPoint(chords).at(x_corner) - x_corner(0);
  const Real made_y = ChordPoint(chords - 0.5L).at(y_corner) - ChordPoint(-0.5L).at(y_corner);
  const auto wanted_x = static_cast<Real>(circle.end.x - circle.start.x) + std::cos(arc.end_angle) * end_offset;
  const auto wanted_y = static_cast<Real>(circle.end.y - circle.start.y) + std::sin(arc.end_angle) * end_offset;
  const auto ticks = static_cast<Real>(ticks_);
  closing_x_ = fixed((wanted_x - from_x - made_x) / ticks, kPhase);
  closing_y_ = fixed((wanted_y - from_y - made_y) / ticks, kPhase);
  increment_x_ = increment(chord_x_) + closing_x_;
  increment_y_ = increment(chord_y_) + closing_y_;
  corner_ = std::uint64_t{1} << (chord_bits_ - 1);
  advance();
}

std::int64_t RotationArc::turned(std::int64_t value) const {
  return shift_ == 0 ? value : (value + (std::int64_t{1} << (shift_ - 1))) >> shift_;
}

void RotationArc::rotate() {
  const std::uint64_t half = std::uint64_t{1} << (chord_bits_ - 1);
  if ((corner_ & half) != 0) {
    // Y's chord ends halfway through X's chord, when X's next corner is already known.
    chord_y_ = sign_ * turned(x_ + chord_x_);
    y_ += chord_y_;
  } else {
    x_ += chord_x_;
    chord_x_ = -sign_ * turned(y_);
  }
  increment_x_ = increment(chord_x_) + closing_x_;
  increment_y_ = increment(chord_y_) + closing_y_;
  corner_ += half;
}

void RotationArc::advance() {
  constexpr std::int64_t kOne = std::int64_t{1} << kPhase;
  // A carry or a borrow leaves bits at kPhase and above.
  const auto carries = [&] { return (static_cast<std::uint64_t>(phase_x_ | phase_y_) >> kPhase) != 0; };
  pending_ = false;
  while (tick_ != ticks_ && !pending_) {
    if (tick_ == corner_) rotate();
    const std::uint64_t stop = std::min(corner_, ticks_);
    do {
      phase_x_ += increment_x_;
      phase_y_ += increment_y_;
      ++tick_;
    } while (tick_ != stop && !carries());
    pending_ = carries();
  }
  step_.direction[0] = static_cast<std::int8_t>(phase_x_ >> kPhase);
  step_.direction[1] = static_cast<std::int8_t>(phase_y_ >> kPhase);
  phase_x_ &= kOne - 1;
  phase_y_ &= kOne - 1;
}

Step RotationArc::next() {
  const Step step = step_;
  position_[0] += step.direction[0];
  position_[1] += step.direction[1];
  time_ = tick_;
  advance();
  return step;
}

}  // namespace trammel::interpolation
