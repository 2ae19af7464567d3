// The interpolators, as trammel.interpolation.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "module.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::python {
namespace {

namespace ip = interpolation;

// A walk with the number of axes of its curve.
struct PythonWalk {
  ip::AnyInterpolator walk;
  unsigned axes;
  std::string method;

  nb::tuple point(const ip::Position& position) const {
    nb::list out;
    for (unsigned axis = 0; axis < axes; ++axis) out.append(position[axis]);
    return nb::tuple(out);
  }
};

// Converts 128 bits to a Python int, from two halves.
nb::object python_int(ip::Deviation value) {
  const auto high = static_cast<std::int64_t>(value >> 64);
  const auto low = static_cast<std::uint64_t>(value);
  return nb::int_(high) * nb::int_(std::uint64_t{1} << 32) * nb::int_(std::uint64_t{1} << 32) + nb::int_(low);
}

ip::Line line_curve(const std::vector<std::int64_t>& start, const std::vector<std::int64_t>& end) {
  if (start.size() != end.size() || start.size() < 2 || start.size() > ip::kMaxAxes) {
    throw driver::ArgumentError("a line goes between two points of 2 to 4 coordinates");
  }
  ip::Line out;
  out.axes = static_cast<unsigned>(start.size());
  std::copy(start.begin(), start.end(), out.start.begin());
  std::copy(end.begin(), end.end(), out.end.begin());
  return out;
}

std::unique_ptr<PythonWalk> walk(const std::string& method, const ip::Curve& curve, std::uint64_t clock_hz,
                                 std::uint64_t velocity) {
  const std::optional<ip::Method> named = ip::method_named(method);
  if (!named) throw driver::ArgumentError("no method is named " + method + " (methods() lists them)");
  ip::check_curve(curve);
  ip::Options options;
  options.clock_hz = clock_hz;
  options.velocity = velocity;
  const auto* line = std::get_if<ip::Line>(&curve);
  return std::make_unique<PythonWalk>(
      PythonWalk{ip::make_interpolator(*named, curve, options), line != nullptr ? line->axes : 2, method});
}

// Runs a whole walk: a list of (time, position) after each step.
nb::list path_of(const PythonWalk& of) {
  nb::list out;
  ip::AnyInterpolator copy = of.walk;
  copy.run([&](const ip::Step&, const auto& at) { out.append(nb::make_tuple(at.time(), of.point(at.position()))); });
  return out;
}

void bind_methods(nb::module_& m) {
  nb::class_<ip::MethodInfo>(m, "MethodInfo", "An interpolation method and its abilities.")
      .def_prop_ro(
          "name", [](const ip::MethodInfo& i) { return std::string(i.name); }, "Name for interpolate().")
      .def_prop_ro(
          "brief", [](const ip::MethodInfo& i) { return std::string(i.brief); }, "The method in a few words.")
      .def_ro("line_axes", &ip::MethodInfo::line_axes, "Most axes of a line; 0: no lines.")
      .def_ro("circles", &ip::MethodInfo::circles, "Whether it makes circles and their arcs.")
      .def_ro("ellipses", &ip::MethodInfo::ellipses, "Whether it makes ellipses and their arcs.")
      .def_prop_ro(
          "time_unit", [](const ip::MethodInfo& i) { return std::string(i.time_unit); },
          "Unit of its times: step, iteration, clock or tick.")
      .def_ro("deviation", &ip::MethodInfo::deviation, "Whether it has a deviation F.");
  m.def(
      "methods", [] { return std::vector<ip::MethodInfo>(ip::methods().begin(), ip::methods().end()); },
      "All methods: a list of MethodInfo.");
}

}  // namespace

void bind_interpolation(nb::module_ m) {
  bind_methods(m);
  nb::class_<ip::Curve>(m, "Curve",
                        "A line, or an arc of a circle or an ellipse; line(), circle() and arc() make them.");
  m.def(
      "line",
      [](const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) -> ip::Curve {
        return line_curve(a, b);
      },
      "start"_a, "end"_a, "A straight line between two points of 2 to 4 coordinates, in pulses.");
  m.def(
      "circle", [](std::int64_t radius, bool clockwise) -> ip::Curve { return ip::make_circle(radius, clockwise); },
      "radius"_a, "clockwise"_a = false, "A full circle about the origin, from (radius, 0).");
  m.def(
      "arc",
      [](std::array<std::int64_t, 2> centre, std::array<std::int64_t, 2> start, std::array<std::int64_t, 2> end,
         bool clockwise, std::array<std::int64_t, 2> semi) -> ip::Curve {
        return ip::Arc{{centre[0], centre[1]}, {start[0], start[1]}, {end[0], end[1]}, clockwise, semi[0], semi[1]};
      },
      "centre"_a, "start"_a, "end"_a, "clockwise"_a = false, "semi_axes"_a = std::array<std::int64_t, 2>{0, 0},
      "An arc of a circle, or with semi-axes of an ellipse; start == end is a full turn.");
  nb::class_<PythonWalk>(m, "Interpolator", "A walk along a curve; it iterates over (time, position) after each step.")
      .def("path", path_of, "The rest of the walk: [(time, position), ...]; the walk itself stays where it is.")
      .def_prop_ro(
          "position", [](const PythonWalk& w) { return w.point(w.walk.position()); }, "Where the walk is, pulses.")
      .def_prop_ro(
          "done", [](const PythonWalk& w) { return w.walk.done(); }, "Whether the walk is at the end.")
      .def_prop_ro(
          "time", [](const PythonWalk& w) { return w.walk.time(); }, "Time so far, in the method's unit.")
      .def_prop_ro(
          "total_time", [](const PythonWalk& w) { return w.walk.total_time(); },
          "Time of the whole curve, in the method's unit.")
      .def_prop_ro(
          "deviation",
          [](const PythonWalk& w) -> nb::object {
            const std::optional<ip::Deviation> f = w.walk.deviation();
            return f ? python_int(*f) : nb::none();
          },
          "The deviation F that chooses the next step; None for a method without one.")
      .def(
          "__iter__", [](nb::handle self) { return self; }, "The walk itself.")
      .def(
          "__next__",
          [](PythonWalk& w) {
            if (w.walk.done()) throw nb::stop_iteration();
            w.walk.next();
            return nb::make_tuple(w.walk.time(), w.point(w.walk.position()));
          },
          "Makes a step: (time, position) after it.");
  m.def("interpolate", walk, "method"_a, "curve"_a, "clock_hz"_a = ip::Options().clock_hz,
        "velocity"_a = ip::Options().velocity, "Begins a walk along a curve by the method of that name.");
}

}  // namespace trammel::python
