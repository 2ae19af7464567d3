#include "trammel/driver/arc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "arc_refusal.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/trigonometry.hpp"

namespace trammel::driver {
namespace {

constexpr std::uint64_t kCountLimit =
    card_map::find_command(static_cast<std::uint8_t>(card_map::Opcode::Arc))->count_maximum + 1;  // also of path ticks
constexpr std::int64_t kMaxQuadrants = std::numeric_limits<decltype(ArcCommand::quadrants)>::max();

// A lattice point relative to the centre, in the units of its conic.
struct Point {
  std::int64_t x;
  std::int64_t y;
};

// F = a x^2 + b y^2 - n over the points start + step * integer.
struct Conic {
  std::int64_t a;
  std::int64_t b;
  Int128 n;
  std::int64_t step;  // units per pulse

  Int128 deviation(const Point& p) const { return Int128(a) * p.x * p.x + Int128(b) * p.y * p.y - n; }
};

std::int64_t square_root(Int128 value) {
  std::int64_t root = 0;
  for (std::int64_t bit = std::int64_t{1} << 62; bit != 0; bit >>= 1) {
    const std::int64_t trial = root | bit;
    if (Int128(trial) * trial <= value) root = trial;
  }
  return root;
}

Int128 radius_squared(const Point& p) { return Int128(p.x) * p.x + Int128(p.y) * p.y; }

// Quadrants: 0 right and up, 1 left and up, 2 left and down, 3 right and down. Zero counts as positive, as in the card.
int quadrant(const Point& p) {
  if (p.y >= 0) return p.x >= 0 ? 0 : 1;
  return p.x >= 0 ? 3 : 2;
}

// Direction from the centre in quarter turns, 0 .. 4; 0 for the centre itself. Computed by divisions alone, so that
// every host gets the same value: exact on the axes and their bisectors, elsewhere wrong by less than 1/16 of a quarter
// turn.
double direction_of(const Point& p) {
  const double x = std::abs(static_cast<double>(p.x));
  const double y = std::abs(static_cast<double>(p.y));
  if (x + y == 0) return 0;
  const int side = quadrant(p);
  return side + (side % 2 == 0 ? y : x) / (x + y);
}

// Number of quadrant changes from start to end. The direction between the rounded points is known up to full turns.
// Rounding moves it by less than half a turn from the commanded sweep (radius >= 1 pulse), so the nearest number of
// turns is the right one, and the last digits of the sweep do not matter. If rounding puts the end behind the start,
// the result would be -1 turn plus some changes; it becomes 0, and the card goes straight to the end.
std::int64_t quadrant_changes(const Point& start, const Point& end, bool clockwise, double sweep, std::uint32_t turns) {
  const int direction = clockwise ? -1 : 1;
  double ahead = direction * (direction_of(end) - direction_of(start));
  if (ahead < 0) ahead += 4;
  const std::int64_t more = std::llround((sweep / (kPi / 2) - ahead) / 4) + turns;
  std::int64_t changes = (direction * (quadrant(end) - quadrant(start)) + 4) % 4;
  if (changes == 0 && ahead > 2) changes = 4;  // end in the same quadrant, behind the start
  changes += 4 * more;
  if (changes > kMaxQuadrants) refuse_arc(fmt::format("{} quadrants, at most {} fit", changes, kMaxQuadrants));
  return changes > 0 ? changes : 0;
}

// The exact point at which the walk enters the next quadrant. In a quadrant one coordinate u moves towards zero, in
// steps taken while F >= 0; the other, v, moves away from zero, in steps taken while F < 0. The walk leaves the
// quadrant from the last column of u before the sign change, at the first v, from the present one on, with F >= 0
// there. Every earlier column is farther from zero and needs a smaller |v|, so in none of them has v gone beyond that
// point.
Point next_entry(const Conic& conic, const Point& from, bool clockwise) {
  const int side = quadrant(from);
  const bool x_inward = (side % 2 == 0) != clockwise;
  Point at = from;
  std::int64_t& u = x_inward ? at.x : at.y;
  std::int64_t& v = x_inward ? at.y : at.x;
  const std::int64_t step = conic.step;
  const std::int64_t phase = ((u % step) + step) % step;  // offset of the lattice, 0 .. step - 1
  const std::int64_t last = u >= 0 ? phase : phase - step;
  const std::int64_t entered = u >= 0 ? last - step : last + step;
  u = last;
  const std::int64_t outward = v >= 0 ? step : -step;
  const std::int64_t v_first = v;
  // Bisects the number of v steps; 2^35 pulses exceed every curve that the bounds admit.
  std::int64_t inside = -1;
  std::int64_t outside = std::int64_t{1} << 35;
  while (outside - inside > 1) {
    const std::int64_t middle = inside + (outside - inside) / 2;
    v = v_first + outward * middle;
    (conic.deviation(at) >= 0 ? outside : inside) = middle;
  }
  v = v_first + outward * outside;
  u = entered;
  return at;
}

std::uint64_t steps_between(const Conic& conic, const Point& p, const Point& q) {
  return static_cast<std::uint64_t>((std::llabs(p.x - q.x) + std::llabs(p.y - q.y)) / conic.step);
}

// The walk with 8 directions, as the card makes it: each step moves inward (the coordinate that approaches zero),
// outward, or both at once. Word must hold twice F and the changes of one step.
template <class Word>
class EightDirections {
 public:
  EightDirections(const Conic& conic, const Point& start, bool clockwise)
      : unit_(conic.step),
        clockwise_(clockwise),
        a_(Word(conic.a)),
        b_(Word(conic.b)),
        f_(Word(conic.deviation(start))),
        at_(start) {}

  const Point& at() const { return at_; }
  std::uint64_t steps() const { return steps_; }

  // Walks through the next change of quadrant; with `end`, to the point where either coordinate reaches or passes that
  // of the end.
  void walk_quadrant(const Point* end) {
    const int side = quadrant(at_);
    const bool x_inward = (side % 2 == 0) != clockwise_;
    Axis inward(x_inward ? at_.x : at_.y, x_inward ? a_ : b_, unit_, true);
    Axis outward(x_inward ? at_.y : at_.x, x_inward ? b_ : a_, unit_, false);
    const bool positive = inward.at >= 0;
    const auto over = [&] {
      if (end == nullptr) return (inward.at >= 0) != positive;
      return inward.reached(x_inward ? end->x : end->y) || outward.reached(x_inward ? end->y : end->x);
    };
    while (!over()) {
      const Word both = f_ + inward.change + outward.change;
      const bool inward_alone = f_ + inward.change + both >= Word(0);
      const bool outward_alone = !inward_alone && f_ + outward.change + both < Word(0);
      if (!outward_alone) f_ = f_ + inward.take();
      if (!inward_alone) f_ = f_ + outward.take();
      ++steps_;
    }
    at_ = x_inward ? Point{inward.at, outward.at} : Point{outward.at, inward.at};
  }

  // Walks straight to the end; both coordinates move at once while both differ.
  void walk_straight(const Point& end) {
    steps_ += static_cast<std::uint64_t>(std::max(std::llabs(end.x - at_.x), std::llabs(end.y - at_.y)) / unit_);
    at_ = end;
  }

  // Adds `times` further walks of `steps` each that return to their start.
  void repeat(std::uint64_t steps, std::uint64_t times) { steps_ += steps * times; }

 private:
  struct Axis {
    Axis(std::int64_t coordinate, const Word& weight, std::int64_t unit, bool inward)
        : at(coordinate),
          step((coordinate >= 0) == inward ? -unit : unit),
          change(weight * Word(step) * Word(2 * coordinate + step)),
          twice_half(weight * Word(2 * unit * unit)) {}

    // Makes the step, and returns its change of F.
    Word take() {
      const Word made = change;
      change = change + twice_half;
      at += step;
      return made;
    }
    bool reached(std::int64_t end) const { return step < 0 ? at <= end : at >= end; }

    std::int64_t at;
    std::int64_t step;
    Word change;
    Word twice_half;
  };

  std::int64_t unit_;
  bool clockwise_;
  Word a_;
  Word b_;
  Word f_;
  Point at_;
  std::uint64_t steps_ = 0;
};

template <class Word>
std::uint64_t walked_length(const Conic& conic, const Point& start, const Point& end, bool clockwise,
                            std::int64_t changes) {
  EightDirections<Word> walk(conic, start, clockwise);
  Point turn_ago = start;
  std::uint64_t steps_ago = 0;
  std::int64_t left = changes;
  while (left != 0) {
    // F depends on the point alone, so a turn that ends where the previous one did repeats itself.
    const bool turn_over = left != changes && (changes - left) % 4 == 0;
    if (turn_over && walk.at().x == turn_ago.x && walk.at().y == turn_ago.y) {
      walk.repeat(walk.steps() - steps_ago, static_cast<std::uint64_t>(left / 4));
      left %= 4;
      if (left == 0) break;
    }
    if (turn_over) {
      turn_ago = walk.at();
      steps_ago = walk.steps();
    }
    walk.walk_quadrant(nullptr);
    --left;
  }
  walk.walk_quadrant(&end);
  walk.walk_straight(end);
  return walk.steps();
}

// L with 4 directions. Within a quadrant, and from the last entry to the end, both coordinates are monotone, so the
// number of steps is the sum of the distances along the axes.
std::uint64_t summed_length(const Conic& conic, const Point& start, const Point& end, bool clockwise,
                            std::int64_t changes) {
  std::uint64_t length = 0;
  Point at = start;
  for (std::int64_t i = 0; i < changes; ++i) {
    const Point entry = next_entry(conic, at, clockwise);
    length += steps_between(conic, at, entry);
    at = entry;
  }
  return length + steps_between(conic, at, end);
}

// L; refuses 0 and a number beyond the card's count. F and its changes stay below 2^45 for a circle, below 2^64 for an
// ellipse.
std::uint64_t path_length(const Conic& conic, const Point& start, const Point& end, bool clockwise,
                          std::int64_t changes, StepRule rule) {
  const bool eight = rule == StepRule::kEightDirections;
  const std::uint64_t length = !eight            ? summed_length(conic, start, end, clockwise, changes)
                               : conic.step != 1 ? walked_length<std::int64_t>(conic, start, end, clockwise, changes)
                                                 : walked_length<Int128>(conic, start, end, clockwise, changes);
  if (length == 0) refuse_arc("start and end are the same point and the sweep is no full turn: no step to make");
  if (length >= kCountLimit) refuse_arc(fmt::format("{} steps, fewer than 2^40 fit", length));
  return length;
}

template <class Geometry>
void check_common(const Geometry& geometry) {
  if (geometry.axis_x >= card_map::kMaxAxes || geometry.axis_y >= card_map::kMaxAxes ||
      geometry.axis_x == geometry.axis_y) {
    refuse_arc(fmt::format("axes {} and {} span no plane", geometry.axis_x, geometry.axis_y));
  }
  // The upper bound keeps the conversion to turns within range; more than 65,535 quadrants are refused later.
  if (!(geometry.sweep >= 0 && geometry.sweep < 1e6)) refuse_arc(fmt::format("sweep of {} radians", geometry.sweep));
}

template <class Geometry>
ArcCommand fill(const Geometry& geometry, const Conic& conic, const Point& start, const Point& end, StepRule rule) {
  const std::int64_t changes = quadrant_changes(start, end, geometry.clockwise, geometry.sweep, geometry.turns);
  ArcCommand arc;
  arc.path_ticks = path_length(conic, start, end, geometry.clockwise, changes, rule);
  arc.eight_directions = rule == StepRule::kEightDirections;
  arc.clockwise = geometry.clockwise;
  arc.axis_x = geometry.axis_x;
  arc.axis_y = geometry.axis_y;
  arc.quadrants = static_cast<std::uint16_t>(changes);
  arc.end_x = geometry.end_x;
  arc.end_y = geometry.end_y;
  arc.deviation = conic.deviation(start);
  arc.gradient_x = Int128(2) * conic.a * start.x * conic.step;
  arc.gradient_y = Int128(2) * conic.b * start.y * conic.step;
  arc.half_x = static_cast<std::uint64_t>(conic.a * conic.step * conic.step);
  arc.half_y = static_cast<std::uint64_t>(conic.b * conic.step * conic.step);
  return arc;
}

// Square of the mean of start and end radius. The mean halves the distance that rounding puts between the radii, so
// that both ends are equally close to the curve.
Int128 mean_radius_squared(const Point& start, const Point& end) {
  const Int128 first = radius_squared(start);
  const Int128 second = radius_squared(end);
  if (first == second) return first;
  constexpr unsigned kFraction = 8;  // radii to 2^-16 pulses
  const Int128 sum = Int128(square_root(first << (2 * kFraction))) + square_root(second << (2 * kFraction));
  constexpr unsigned kShift = 2 * (kFraction + 1);
  return Int128((sum * sum + (Int128(1) << (kShift - 1))).bits() >> kShift);  // positive
}

// In centre units. With 4 directions a walk deviates inwards by up to 1 + 1/(4 R), which takes it across the centre for
// a radius R up to (1 + sqrt 2)/2 = 1.21; from 1.5 on it stays a third of a pulse away. With 8 directions a radius of
// one pulse suffices.
std::int64_t least_radius(StepRule rule) {
  return rule == StepRule::kEightDirections ? kCentreUnitsPerPulse : kCentreUnitsPerPulse * 3 / 2;
}

int directions(StepRule rule) { return rule == StepRule::kEightDirections ? 8 : 4; }

double pulses_of(std::int64_t centre_units) {
  return static_cast<double>(centre_units) / static_cast<double>(kCentreUnitsPerPulse);
}

bool within(const Point& p, std::int64_t limit) { return std::llabs(p.x) <= limit && std::llabs(p.y) <= limit; }

}  // namespace

ArcCommand prepare(const ArcGeometry& geometry, StepRule rule) {
  check_common(geometry);
  constexpr std::int64_t kUnit = kCentreUnitsPerPulse;
  // Checked before the negation, which would overflow for the most negative value.
  if (geometry.centre_x < -kMaxCentreDistance || geometry.centre_x > kMaxCentreDistance ||
      geometry.centre_y < -kMaxCentreDistance || geometry.centre_y > kMaxCentreDistance) {
    refuse_arc("the centre is farther than 2^24 pulses from the start");
  }
  const Point start{-geometry.centre_x, -geometry.centre_y};
  const Point end{geometry.end_x * kUnit - geometry.centre_x, geometry.end_y * kUnit - geometry.centre_y};
  if (!within(end, kMaxCentreDistance)) refuse_arc("the centre is farther than 2^24 pulses from the end");
  const Int128 mean = mean_radius_squared(start, end);
  const std::int64_t least = least_radius(rule);
  if (mean < least * least) {
    refuse_arc(fmt::format("radius of {:.4g} pulses, at least {:g} in {} directions: send lines",
                           pulses_of(square_root(mean)), pulses_of(least), directions(rule)));
  }
  // A sideways step adds up to 1/2 to R^2 (in pulses), while an inward step subtracts nothing from it. With R^2 reduced
  // by half a square pulse, errors outside and inside are equal, 1 + 1/(4 R). About a whole pulse F is then an integer
  // plus one half, so every sign is that of STEER's F. With 8 directions errors are equal without this.
  const std::int64_t less = rule == StepRule::kEightDirections ? 0 : kUnit * kUnit / 2;
  return fill(geometry, Conic{1, 1, mean - less, kUnit}, start, end, rule);
}

ArcCommand prepare(const EllipseGeometry& geometry, StepRule rule) {
  check_common(geometry);
  const std::int64_t a = geometry.semi_x;
  const std::int64_t b = geometry.semi_y;
  const std::int64_t least = (least_radius(rule) + kCentreUnitsPerPulse - 1) / kCentreUnitsPerPulse;
  if (a < least || b < least || a > kMaxSemiAxis || b > kMaxSemiAxis) {
    refuse_arc(fmt::format("semi-axes {} and {} are not within {} .. 2^20 pulses, in {} directions", a, b, least,
                           directions(rule)));
  }
  const Point start{geometry.start_x, geometry.start_y};
  // A point rounded from the curve is at most one pulse outside its bounding box. Checked before any arithmetic.
  const auto in_box = [&](const Point& p) { return -a - 1 <= p.x && p.x <= a + 1 && -b - 1 <= p.y && p.y <= b + 1; };
  if (!in_box(start)) refuse_arc("the start is outside the ellipse's bounding box");
  const Point end{start.x + geometry.end_x, start.y + geometry.end_y};
  if (!in_box(end)) refuse_arc("the end is outside the ellipse's bounding box");
  const Conic conic{b * b, a * a, Int128(a * a) * (b * b), 1};
  // Rounding moves a point by half a pulse in each coordinate, which changes F by at most ab(a+b) + (a^2+b^2)/4.
  const Int128 limit = Int128(4) * a * b * (a > b ? a : b);
  const auto on_curve = [&](const Point& p) { return -limit < conic.deviation(p) && conic.deviation(p) < limit; };
  if (!on_curve(start)) refuse_arc("the start is not on the ellipse");
  if (!on_curve(end)) refuse_arc("the end is not on the ellipse");
  return fill(geometry, conic, start, end, rule);
}

ArcCommand with_ticks(ArcCommand arc, std::uint64_t ticks) {
  if (ticks < arc.path_ticks) refuse_arc(fmt::format("{} feed ticks for {} steps", ticks, arc.path_ticks));
  if (ticks >= kCountLimit) refuse_arc(fmt::format("{} feed ticks, fewer than 2^40 fit", ticks));
  arc.ticks = ticks;
  arc.prescale = rounded_share(arc.path_ticks, ticks);
  return arc;
}

ArcCommand make_arc(const ArcGeometry& geometry, std::uint64_t ticks, StepRule rule) {
  return with_ticks(prepare(geometry, rule), ticks);
}

ArcCommand make_ellipse(const EllipseGeometry& geometry, std::uint64_t ticks, StepRule rule) {
  return with_ticks(prepare(geometry, rule), ticks);
}

}  // namespace trammel::driver
