// Arbitrary bytes for every interpolator. A curve is refused with a reason, or walked in unit steps to its exact end
// within a bound. Built with libFuzzer, ASan and UBSan (CMakeLists.txt). An aborted run saves the bytes that caused it.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "trammel/interpolation/any_interpolator.hpp"

namespace {

using namespace trammel::interpolation;

// Takes numbers from the bytes; zeros after their end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  template <class T>
  T take() {
    T value{};
    const std::size_t count = sizeof(T) < size_ ? sizeof(T) : size_;
    if (count != 0) std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }
  // `kind` 0: small numbers, for which arcs are short and often valid; 1: medium numbers; 2: any number.
  std::int64_t number(unsigned kind) {
    if (kind == 0) return take<std::int8_t>() / 4;
    if (kind == 1) return take<std::int16_t>() / 16;
    return take<std::int64_t>();
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "interpolation_fuzz: %s\n", what);
  std::abort();
}

// An end point on the circle of `start` or within 1 pulse of it, chosen by the bytes. Random points hardly ever lie on
// a circle.
Point on_circle(const Point& centre, const Point& start, Bytes& bytes) {
  const std::int64_t x = start.x - centre.x;
  const std::int64_t y = start.y - centre.y;
  const std::uint8_t turn = bytes.take<std::uint8_t>();
  const std::int64_t mirrored_x = (turn & 1u) != 0 ? -x : x;
  const std::int64_t mirrored_y = (turn & 2u) != 0 ? -y : y;
  Point end{centre.x + mirrored_x, centre.y + mirrored_y};
  if ((turn & 4u) != 0) end = {centre.x + mirrored_y, centre.y + mirrored_x};
  if ((turn & 8u) != 0) end.x += (turn & 16u) != 0 ? 1 : -1;
  if ((turn & 32u) != 0) end.y += (turn & 64u) != 0 ? 1 : -1;
  return end;
}

// Bounds the coordinates: differences of arbitrary 64-bit numbers would overflow in this file, not in the library.
Point bounded(Point p) { return {p.x % (kMaxCoordinate + 2), p.y % (kMaxCoordinate + 2)}; }

Curve take_curve(Bytes& bytes, unsigned kind) {
  const std::uint8_t shape = bytes.take<std::uint8_t>();
  if (shape % 3 == 0) {
    Line line;
    line.axes = kind == 2 ? bytes.take<std::uint8_t>() : 2 + shape / 3u % 3;
    for (unsigned a = 0; a < kMaxAxes && a < line.axes; ++a) {
      line.start[a] = bytes.number(kind);
      line.end[a] = bytes.number(kind);
    }
    return line;
  }
  Arc arc;
  arc.clockwise = (shape & 128u) != 0;
  arc.centre = {bytes.number(kind), bytes.number(kind)};
  arc.start = {bytes.number(kind), bytes.number(kind)};
  arc.end = {bytes.number(kind), bytes.number(kind)};
  if ((shape & 64u) != 0) arc.end = on_circle(bounded(arc.centre), bounded(arc.start), bytes);
  if (shape % 3 == 2) {
    arc.semi_x = bytes.number(kind);
    arc.semi_y = bytes.number(kind);
    if ((shape & 32u) != 0) {
      // A full ellipse from its vertex.
      arc.centre = {0, 0};
      arc.start = {arc.semi_x, 0};
      arc.end = arc.start;
    }
  }
  return arc;
}

Position start_of(const Curve& curve) {
  if (const auto* line = std::get_if<Line>(&curve)) return line->start;
  const Point& p = std::get<Arc>(curve).start;
  return {p.x, p.y, 0, 0};
}

Position end_of(const Curve& curve) {
  if (const auto* line = std::get_if<Line>(&curve)) return line->end;
  const Point& p = std::get<Arc>(curve).end;
  return {p.x, p.y, 0, 0};
}

// Upper bound of the steps of every method. A line makes each unit step once. An arc makes at most twice the bound that
// arc_end.hpp derives, for twice the extent if it is a circle.
std::uint64_t bound_of(const Curve& curve) {
  if (const auto* line = std::get_if<Line>(&curve)) return kMaxAxes * longest_axis(*line);
  const Arc& arc = std::get<Arc>(curve);
  if (!arc.is_circle()) return static_cast<std::uint64_t>(ArcEnd::step_bound(arc.semi_x + arc.semi_y)) * 2;
  const std::int64_t extent = std::abs(arc.start.x - arc.centre.x) + std::abs(arc.start.y - arc.centre.y);
  return static_cast<std::uint64_t>(ArcEnd::step_bound(2 * extent)) * 2;
}

void check_walk(AnyInterpolator walk, const Curve& curve) {
  // Long walks end here; their first steps already reach the widths of the registers.
  constexpr std::uint64_t kMaxSteps = 3000;
  const std::uint64_t bound = bound_of(curve);
  Position expected = start_of(curve);
  std::uint64_t last_time = 0;
  for (std::uint64_t steps = 0; !walk.done(); ++steps) {
    if (steps > bound) fail("more steps than the bound");
    if (steps == kMaxSteps) return;
    walk.deviation();
    const Step step = walk.next();
    if (step == Step{}) fail("a step of no axis");
    for (unsigned a = 0; a < kMaxAxes; ++a) {
      if (step.direction[a] < -1 || step.direction[a] > 1) fail("a step of more than one pulse");
      expected[a] += step.direction[a];
    }
    if (walk.position() != expected) fail("position is not the sum of the steps");
    if (walk.time() <= last_time) fail("time stands still");
    last_time = walk.time();
  }
  if (walk.position() != end_of(curve)) fail("wrong end");
  if (walk.total_time() < walk.time()) fail("total time before the last step");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const std::uint8_t choice = bytes.take<std::uint8_t>();
  const Method method = methods()[choice % kMethodCount].method;
  const unsigned kind = choice / kMethodCount % 3u;
  const Curve curve = take_curve(bytes, kind);
  Options options;
  if ((choice & 128u) != 0)
    options = {bytes.take<std::uint64_t>(), bytes.take<std::uint64_t>(), bytes.take<std::uint32_t>()};
  try {
    check_walk(make_interpolator(method, curve, options), curve);
  } catch (const std::invalid_argument& error) {
    if (std::strlen(error.what()) == 0) fail("refused without a reason");
  }
  return 0;
}
