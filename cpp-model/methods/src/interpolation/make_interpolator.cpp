#include <cmath>
#include <stdexcept>
#include <string>

#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::interpolation {
namespace {

// Rounding a point of a circle to whole pulses moves it by at most sqrt(1/2) along the radius.
constexpr long double kRounding = 0.7072L;

[[noreturn]] void refuse(const std::string& reason) { throw std::invalid_argument(reason); }

bool within(std::int64_t value, std::int64_t limit) { return -limit <= value && value <= limit; }

void check(const Line& line) {
  if (line.axes < 2 || line.axes > kMaxAxes) refuse("a line has 2 to 4 axes");
  for (unsigned a = 0; a < line.axes; ++a) {
    if (!within(line.start[a], kMaxCoordinate) || !within(line.end[a], kMaxCoordinate)) {
      refuse("a coordinate beyond 2^40 pulses");
    }
    if (!within(line.end[a] - line.start[a], kMaxLine)) refuse("a line of more than 2^30 pulses on an axis");
  }
}

void check_coordinates(const Arc& arc) {
  for (const Point& p : {arc.centre, arc.start, arc.end}) {
    if (!within(p.x, kMaxCoordinate) || !within(p.y, kMaxCoordinate)) refuse("a coordinate beyond 2^40 pulses");
  }
}

Point relative(const Point& p, const Point& centre) { return {p.x - centre.x, p.y - centre.y}; }

long double distance(const Point& p) {
  return std::hypot(static_cast<long double>(p.x), static_cast<long double>(p.y));
}

void check_circle(const Point& start, const Point& end) {
  if (start == Point{}) refuse("a circle of radius 0");
  // Checks the box first, so that the distance below cannot be too large for its type.
  const bool inside = within(start.x, kMaxRadius) && within(start.y, kMaxRadius) && distance(start) <= kMaxRadius;
  if (!inside) refuse("a radius of more than 2^30 pulses");
  const long double apart = std::fabs(distance(end) - distance(start));
  if (apart > kRounding) {
    refuse("start and end are not on one circle: their radii differ by " + std::to_string(static_cast<double>(apart)) +
           " pulses, rounding explains 0.7072");
  }
}

// Rounding moves a point of the ellipse by at most half a pulse in each coordinate, which changes F by at most
// a b (a + b) + (a^2 + b^2) / 4 < 4 a b max(a, b).
bool on_ellipse(const Arc& arc, const Point& p) {
  const std::int64_t a = arc.semi_x;
  const std::int64_t b = arc.semi_y;
  if (!within(p.x, a + 1) || !within(p.y, b + 1)) return false;
  const Deviation limit = static_cast<Deviation>(4) * a * b * (a > b ? a : b);
  const Deviation f = conic_of<Deviation>(arc).deviation(p);
  return -limit < f && f < limit;
}

void check_ellipse(const Arc& arc, const Point& start, const Point& end) {
  if (arc.semi_x < 1 || arc.semi_y < 1) refuse("a semi-axis below 1 pulse");
  if (arc.semi_x > kMaxSemiAxis || arc.semi_y > kMaxSemiAxis) refuse("a semi-axis of more than 2^30 pulses");
  if (!on_ellipse(arc, start)) refuse("the start is off the ellipse");
  if (!on_ellipse(arc, end)) refuse("the end is off the ellipse");
}

void check(const Arc& arc) {
  check_coordinates(arc);
  const Point start = relative(arc.start, arc.centre);
  const Point end = relative(arc.end, arc.centre);
  if (arc.is_circle()) {
    check_circle(start, end);
  } else {
    check_ellipse(arc, start, end);
  }
}

// Keeps both products of pulse_train_line.hpp below 2^62, and every axis at one pulse per clock or less.
void check_velocity(const Line& line, const Options& options) {
  if (options.clock_hz == 0) refuse("a clock of 0 Hz");
  if (options.velocity == 0 || options.velocity_divisor == 0) refuse("a velocity of 0, or a divisor of 0");
  constexpr std::uint64_t kLimit = std::uint64_t{1} << 61;
  if (options.clock_hz >= kLimit || options.velocity_divisor >= kLimit) refuse("a line of more than 2^61 clocks");
  const Deviation clocks = static_cast<Deviation>(options.clock_hz) * options.velocity_divisor;
  const Deviation pulses = static_cast<Deviation>(longest_axis(line)) * options.velocity;
  if (options.velocity > static_cast<std::uint64_t>(kMaxLine)) refuse("a velocity of more than 2^30 lines");
  if (clocks >= kLimit) refuse("a line of more than 2^61 clocks");
  if (pulses > clocks) refuse("more than one pulse a clock: lower the velocity or raise the clock");
}

[[noreturn]] void refuse(Method method, const std::string& what) {
  refuse(std::string(info(method).name) + " cannot do " + what);
}

// Found by walking all such arcs: from some starts the walk never comes back, or turns the wrong way.
const char* const kThroughCentre =
    "steer passes the centre at a radius or semi-axis of 1 pulse, where its table has no direction";

template <class Timing>
AnyInterpolator pulse_trains(const Line& line, const Timing& timing) {
  if (line.axes == 2) return AnyInterpolator(PulseTrainLine<2>(line, timing));
  return AnyInterpolator(PulseTrainLine<kMaxAxes>(line, timing));
}

AnyInterpolator one_shot(const Line& line, const Options& options, PulseTiming::Kind kind) {
  check_velocity(line, options);
  return pulse_trains(line, one_shot_timing(options, kind));
}

AnyInterpolator make(Method method, const Line& line, const Options& options) {
  const unsigned most = info(method).line_axes;
  if (most == 0) refuse(method, "lines");
  if (line.axes > most) refuse(method, "a line on " + std::to_string(line.axes) + " axes");
  switch (method) {
    case Method::kSteer:
      return AnyInterpolator(SteerLine(line));
    case Method::kPointByPoint:
      return AnyInterpolator(PointByPointLine(line));
    case Method::kMinF4:
      return AnyInterpolator(MinFLine(line));
    case Method::kMinDeviation8:
      if (line.axes == 2) return AnyInterpolator(MinDeviationLine(line));
      return AnyInterpolator(MinDeviationSpaceLine(line));
    case Method::kDda:
    case Method::kDdaHalf:
      return pulse_trains(line, dda_timing(line, method == Method::kDdaHalf));
    case Method::kOneShot:
      return one_shot(line, options, PulseTiming::Kind::kAccumulatorHalf);
    case Method::kOneShotZero:
      return one_shot(line, options, PulseTiming::Kind::kAccumulatorZero);
    case Method::kDivider:
      return one_shot(line, options, PulseTiming::Kind::kDivider);
    case Method::kRotation:
      break;
  }
  refuse(method, "lines");
}

AnyInterpolator make_circle_walk(Method method, const Arc& arc) {
  const Point start = relative(arc.start, arc.centre);
  const bool unit = start.x * start.x + start.y * start.y == 1;
  switch (method) {
    case Method::kSteer:
      if (unit) refuse(kThroughCentre);
      return AnyInterpolator(SteerCircle(arc));
    case Method::kMinDeviation8:
      return AnyInterpolator(MinDeviationCircle(arc));
    case Method::kDda:
    case Method::kDdaHalf:
      return AnyInterpolator(DdaArc(arc, method == Method::kDdaHalf));
    case Method::kRotation:
      return AnyInterpolator(RotationArc(arc));
    default:
      refuse(method, "circles");
  }
}

AnyInterpolator make(Method method, const Arc& arc) {
  if (arc.is_circle()) return make_circle_walk(method, arc);
  switch (method) {
    case Method::kSteer:
      if (arc.semi_x == 1 || arc.semi_y == 1) refuse(kThroughCentre);
      return AnyInterpolator(SteerEllipse(arc));
    case Method::kMinDeviation8:
      return AnyInterpolator(MinDeviationEllipse(arc));
    default:
      refuse(method, "ellipses");
  }
}

}  // namespace

void check_curve(const Curve& curve) {
  std::visit([](const auto& shape) { check(shape); }, curve);
}

AnyInterpolator make_interpolator(Method method, const Curve& curve, const Options& options) {
  check_curve(curve);
  if (const auto* line = std::get_if<Line>(&curve)) return make(method, *line, options);
  return make(method, std::get<Arc>(curve));
}

}  // namespace trammel::interpolation
