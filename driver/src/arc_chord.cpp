#include "trammel/driver/arc_chord.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "arc_refusal.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/trigonometry.hpp"

namespace trammel::driver {
namespace {

constexpr int kFractionBits = card_map::constant::kFractionBits;
constexpr std::uint64_t kChordCountLimit =
    card_map::find_command(static_cast<std::uint8_t>(card_map::Opcode::ArcChord))->count_maximum + 1;
constexpr double kPathTickLimit = 0x1p37;
constexpr unsigned kMinK = 1;
constexpr unsigned kMinM = 5;
constexpr unsigned kMaxM = 31;
constexpr double kMinRadius = 0.125;    // pulses
constexpr double kMaxToCircle = 0.375;  // pulses
constexpr double kMaxShift = 0x1p22;    // largest coordinate, pulses, in 2^-40 pulses of 63 bits, with margin

// A vector from the centre, pulses.
struct Ray {
  Ray(double from_x, double from_y)
      : x(from_x), y(from_y), radius(std::sqrt(x * x + y * y)), cosine(x / radius), sine(y / radius) {}
  double x;
  double y;
  double radius;
  double cosine;
  double sine;
};

Ray ray(std::int64_t x, std::int64_t y) {
  constexpr auto kUnit = static_cast<double>(kCentreUnitsPerPulse);
  return {static_cast<double>(x) / kUnit, static_cast<double>(y) / kUnit};
}

std::int64_t rounded(double value, int fraction_bits) { return std::llround(std::ldexp(value, fraction_bits)); }

// Distance from a point at `radius` to the circle `mean`, along the radius.
double to_circle(double radius, double mean) { return std::clamp(mean - radius, -kMaxToCircle, kMaxToCircle); }

// The circle on which the card rotates, and the start and end of the arc on it.
class Circle {
 public:
  explicit Circle(const ArcGeometry& arc)
      : start(ray(-arc.centre_x, -arc.centre_y)),
        end(ray(arc.end_x * kCentreUnitsPerPulse - arc.centre_x, arc.end_y * kCentreUnitsPerPulse - arc.centre_y)),
        radius((start.radius + end.radius) / 2),
        sense(arc.clockwise ? -1 : 1) {
    check_radii();
    // The sagitta of a chord stays below 1/32 pulse.
    while (std::ldexp(radius, -static_cast<int>(k)) > std::min(std::sqrt(radius) / 2, 16.0)) ++k;
    turn = 2 * arc_sine(std::ldexp(1.0, -static_cast<int>(k) - 1));
    sweep = swept(arc);
  }

  // Number of path ticks at 2^m per chord; below 2^53.
  double path_ticks(unsigned m) const { return std::round(std::ldexp(sweep / turn, static_cast<int>(m))); }
  // The smallest m for which X and Y fit their fields.
  unsigned least_m() const {
    unsigned m = kMinM;
    while (std::ldexp(radius, -static_cast<int>(m)) >= kMaxShift) ++m;
    return m;
  }

  Ray start;
  Ray end;
  double radius;
  int sense;  // 1: counter-clockwise
  unsigned k = kMinK;
  double turn = 0;   // rotation of a chord, radians
  double sweep = 0;  // angle between the rounded ends, including turns

 private:
  void check_radii() const {
    for (const Ray& at : {start, end}) {
      if (!(at.radius >= kMinRadius)) refuse_arc(fmt::format("radius of {:.4g} pulses: send a line", at.radius));
      if (!(at.radius <= kMaxChordRadius)) refuse_arc(fmt::format("radius of {:.4g} pulses", at.radius));
    }
    // Rounding makes the radii differ by at most three pulses; a program's own rounding may be coarser than the pulses.
    if (std::abs(start.radius - end.radius) > std::max(3.0, radius / 2)) {
      refuse_arc(fmt::format("radius {:.4f} pulses at the start, {:.4f} at the end", start.radius, end.radius));
    }
  }

  // The angle between the points is known up to full turns; the value nearest to the commanded sweep is the right one.
  double swept(const ArcGeometry& arc) const {
    double ahead = 0;
    if (arc.end_x != 0 || arc.end_y != 0) {
      ahead = sense * (arc_tangent(end.y, end.x) - arc_tangent(start.y, start.x));
    }
    const double nearest = ahead + 2 * kPi * std::round((arc.sweep - ahead) / (2 * kPi));
    // Each end is within about a pulse of the point for which the sweep was computed.
    constexpr double kMaxApart = 4;  // pulses
    if (std::abs(nearest - arc.sweep) * std::min(start.radius, end.radius) > kMaxApart) {
      refuse_arc(fmt::format("a sweep of {:.6f} radians, but {:.6f} between the points", arc.sweep, nearest));
    }
    const double total = nearest + 2 * kPi * arc.turns;
    if (!(total > 0)) refuse_arc("the end is not ahead of the start: send a line");
    return total;
  }
};

// The chords as the card makes them: vertices at whole chord times for x, at half ones for y.
class Polygon {
 public:
  Polygon(const Circle& circle, unsigned m) : circle_(circle), chord_(std::int64_t{1} << m) {}

  double x(std::int64_t ticks) const {
    return between(ticks, 0, [this](double chords) {
      const SineCosine at = turned(chords);
      return circle_.start.cosine * at.cosine - circle_.start.sine * at.sine;
    });
  }
  double y(std::int64_t ticks) const {
    return between(ticks, chord_ / 2, [this](double chords) {
      const SineCosine at = turned(chords);
      return circle_.start.sine * at.cosine + circle_.start.cosine * at.sine;
    });
  }

 private:
  SineCosine turned(double chords) const { return sine_cosine(circle_.sense * circle_.turn * chords); }

  // Interpolates on the straight line between the adjacent vertices, which lie `late` ticks after whole chords.
  template <class At>
  double between(std::int64_t ticks, std::int64_t late, At at) const {
    const std::int64_t since = ticks - late;
    const std::int64_t whole = (since < 0 ? since - (chord_ - 1) : since) / chord_;
    const auto length = static_cast<double>(chord_);
    const double part = static_cast<double>(since - whole * chord_) / length;
    const double vertex = static_cast<double>(whole) + static_cast<double>(late) / length;
    const double before = at(vertex);
    return circle_.radius * (before + part * (at(vertex + 1) - before));
  }

  const Circle& circle_;
  std::int64_t chord_;  // path ticks
};

// value / 2^k, rounded as the card does.
std::int64_t shifted(std::int64_t value, unsigned k) { return (value >> k) + (value >> (k - 1) & 1); }

// Increments of both axes, 2^-40 pulses per path tick.
struct Increments {
  std::int64_t first_x, first_y, closing_x, closing_y;
  bool fit;  // every increment is at most a pulse per tick
};

// Sets the initial state as the card uses it.
void set_state(ArcChordCommand& arc, const Circle& circle) {
  const int bits = kFractionBits - arc.m;
  const double half_sine = std::ldexp(1.0, -static_cast<int>(circle.k) - 1);
  const double half_cosine = std::sqrt((1 - half_sine) * (1 + half_sine));
  const Ray& start = circle.start;
  arc.x = rounded(circle.radius * start.cosine, bits);
  arc.y = rounded(circle.radius * (start.sine * half_cosine - circle.sense * start.cosine * half_sine), bits);
}

Increments increments(const ArcChordCommand& arc, const Circle& circle, const ArcGeometry& geometry) {
  const auto path_ticks = static_cast<std::int64_t>(arc.path_ticks);
  const Polygon polygon(circle, arc.m);
  const double onto = to_circle(circle.start.radius, circle.radius);
  const double off = to_circle(circle.end.radius, circle.radius);
  const double preset_x = onto * circle.start.cosine;
  const double preset_y = onto * circle.start.sine;
  const double left_x = geometry.end_x + off * circle.end.cosine - preset_x - (polygon.x(path_ticks) - polygon.x(0));
  const double left_y = geometry.end_y + off * circle.end.sine - preset_y - (polygon.y(path_ticks) - polygon.y(0));
  Increments made{};
  const auto length = static_cast<double>(path_ticks);
  made.closing_x = rounded(left_x / length, kFractionBits);
  made.closing_y = rounded(left_y / length, kFractionBits);
  const std::int64_t dy = circle.sense * shifted(arc.x, circle.k);
  const std::int64_t dx = -circle.sense * shifted(arc.y + dy, circle.k);
  made.first_y = dy + made.closing_y + rounded(preset_y, kFractionBits);
  made.first_x = dx + made.closing_x + rounded(preset_x, kFractionBits);
  const double chord = std::ldexp(circle.radius, -static_cast<int>(circle.k) - arc.m);
  const double most_closing = std::max(std::abs(left_x), std::abs(left_y)) / length;
  made.fit = chord + most_closing + std::max(std::abs(preset_x), std::abs(preset_y)) <= 1;
  return made;
}

void check(const HelixGeometry& geometry) {
  const ArcGeometry& arc = geometry.arc;
  if (arc.axis_x >= card_map::kMaxAxes || arc.axis_y >= card_map::kMaxAxes || arc.axis_x == arc.axis_y) {
    refuse_arc(fmt::format("axes {} and {} span no plane", arc.axis_x, arc.axis_y));
  }
  if (geometry.further[arc.axis_x] != 0 || geometry.further[arc.axis_y] != 0) {
    refuse_arc("an axis of the plane cannot go along a line beside it");
  }
  if (!(arc.sweep >= 0 && arc.sweep / (2 * kPi) + arc.turns <= kMaxChordTurns)) {
    refuse_arc(fmt::format("sweep of {} radians and {} turns", arc.sweep, arc.turns));
  }
  constexpr auto kMax = static_cast<std::int64_t>(kMaxChordRadius) * kCentreUnitsPerPulse;
  if (arc.centre_x < -kMax || arc.centre_x > kMax || arc.centre_y < -kMax || arc.centre_y > kMax) {
    refuse_arc("the centre is farther than 2^31 pulses from the start");
  }
  for (const std::int64_t pulses : geometry.further) {
    constexpr std::int64_t kRange = std::int64_t{1} << 32;  // the range of the position counter
    if (pulses < -kRange || pulses > kRange) refuse_arc(fmt::format("{} pulses of a further axis", pulses));
  }
}

std::uint64_t most_further(const HelixGeometry& geometry) {
  std::int64_t most = 0;
  for (const std::int64_t pulses : geometry.further) most = std::max(most, std::abs(pulses));
  return static_cast<std::uint64_t>(most);
}

// The command without the ticks and the fields that depend on them.
ArcChordCommand on_plane(const HelixGeometry& geometry, const Circle& circle) {
  ArcChordCommand arc;
  arc.clockwise = geometry.arc.clockwise;
  arc.axis_x = geometry.arc.axis_x;
  arc.axis_y = geometry.arc.axis_y;
  unsigned mask = 1U << arc.axis_x | 1U << arc.axis_y;
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) mask |= (geometry.further[axis] != 0 ? 1U : 0U) << axis;
  arc.mask = static_cast<std::uint8_t>(mask);
  arc.k = static_cast<std::uint8_t>(circle.k);
  return arc;
}

// Computes the arc with 2^m path ticks per chord; false if an axis would make more than a pulse per tick.
bool at_density(ArcChordCommand& arc, unsigned m, const Circle& circle, const HelixGeometry& geometry) {
  arc.m = static_cast<std::uint8_t>(m);
  arc.path_ticks = static_cast<std::uint64_t>(circle.path_ticks(m));
  if (arc.path_ticks == 0 || arc.path_ticks < most_further(geometry)) return false;
  set_state(arc, circle);
  const Increments made = increments(arc, circle, geometry.arc);
  arc.first_x = made.first_x;
  arc.first_y = made.first_y;
  arc.closing_x = made.closing_x;
  arc.closing_y = made.closing_y;
  return made.fit;
}

}  // namespace

std::uint64_t least_chord_ticks(const HelixGeometry& geometry) {
  check(geometry);
  const Circle circle(geometry.arc);
  ArcChordCommand arc = on_plane(geometry, circle);
  for (unsigned m = circle.least_m(); m <= kMaxM && circle.path_ticks(m) < kPathTickLimit; ++m) {
    if (at_density(arc, m, circle, geometry)) return arc.path_ticks;
  }
  refuse_arc("too long, or too short for what its ends or further axes ask for");
}

ArcChordCommand make_helix(const HelixGeometry& geometry, std::uint64_t ticks) {
  check(geometry);
  if (ticks >= kChordCountLimit) refuse_arc(fmt::format("{} feed ticks, fewer than 2^40 fit", ticks));
  const Circle circle(geometry.arc);
  ArcChordCommand arc = on_plane(geometry, circle);
  const double most = std::min(static_cast<double>(ticks), kPathTickLimit - 1);
  unsigned m = circle.least_m();
  while (m < kMaxM && circle.path_ticks(m + 1) <= most) ++m;
  if (circle.path_ticks(m) > most || !at_density(arc, m, circle, geometry)) {
    refuse_arc(fmt::format("{} feed ticks are too few", ticks));
  }
  arc.ticks = ticks;
  arc.prescale = rounded_share(arc.path_ticks, ticks);
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const std::int64_t pulses = geometry.further[axis];
    if (pulses != 0) arc.increment[axis] = rounded_increment(pulses, arc.path_ticks);
  }
  return arc;
}

}  // namespace trammel::driver
