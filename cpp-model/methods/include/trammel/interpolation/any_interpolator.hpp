// Any method on any curve that it supports, behind one type. A value: a copy is an independent walk. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "trammel/interpolation/conic_arc.hpp"
#include "trammel/interpolation/curve.hpp"
#include "trammel/interpolation/dda_arc.hpp"
#include "trammel/interpolation/method.hpp"
#include "trammel/interpolation/min_deviation_line.hpp"
#include "trammel/interpolation/pulse_train_line.hpp"
#include "trammel/interpolation/rotation_arc.hpp"
#include "trammel/interpolation/step_lines.hpp"

namespace trammel::interpolation {

class AnyInterpolator {
 public:
  using Walk = std::variant<SteerLine, PointByPointLine, MinFLine, MinDeviationLine, MinDeviationSpaceLine,
                            PulseTrainLine<2>, PulseTrainLine<kMaxAxes>, SteerCircle, SteerEllipse, MinDeviationCircle,
                            MinDeviationEllipse, DdaArc, RotationArc>;

  explicit AnyInterpolator(Walk walk) : walk_(std::move(walk)) {}

  bool done() const {
    return std::visit([](const auto& walk) { return walk.done(); }, walk_);
  }
  // The next step; not to be called when done.
  Step next() {
    return std::visit([](auto& walk) { return walk.next(); }, walk_);
  }
  // The position after the steps made so far.
  Position position() const {
    return std::visit([](const auto& walk) -> Position { return walk.position(); }, walk_);
  }
  // The F that chooses the next step; nothing if the method has none.
  std::optional<Deviation> deviation() const {
    return std::visit([](const auto& walk) { return deviation_of(walk); }, walk_);
  }
  // Time of the last step, in the method's own units (MethodInfo::time_unit); 0 before the first.
  std::uint64_t time() const {
    return std::visit([](const auto& walk) { return walk.time(); }, walk_);
  }
  // Time of the whole curve. Lines and rotation know it; for other arcs a copy walks to the end.
  std::uint64_t total_time() const {
    return std::visit([](const auto& walk) { return total_time_of(walk); }, walk_);
  }
  // Walks to the end: callback(step, walk) after each step, where walk is the method's own class, with position() and
  // time(). There is one dispatch for all steps: several times as fast as next().
  template <class Callback>
  void run(Callback&& callback) {
    std::visit(
        [&](auto& walk) {
          while (!walk.done()) {
            const Step step = walk.next();
            callback(step, std::as_const(walk));
          }
        },
        walk_);
  }

 private:
  template <class T, class = void>
  struct HasDeviation : std::false_type {};
  template <class T>
  struct HasDeviation<T, std::void_t<decltype(std::declval<const T&>().deviation())>> : std::true_type {};
  template <class T, class = void>
  struct HasTotalTime : std::false_type {};
  template <class T>
  struct HasTotalTime<T, std::void_t<decltype(std::declval<const T&>().total_time())>> : std::true_type {};

  template <class T>
  static std::optional<Deviation> deviation_of(const T& walk) {
    if constexpr (HasDeviation<T>::value) {
      return walk.deviation();
    } else {
      return std::nullopt;
    }
  }
  template <class T>
  static std::uint64_t total_time_of(const T& walk) {
    if constexpr (HasTotalTime<T>::value) {
      return walk.total_time();
    } else {
      T copy = walk;
      while (!copy.done()) copy.next();
      return copy.time();
    }
  }

  Walk walk_;
};

// Throws std::invalid_argument with the reason: a curve that the method does not support, values beyond the widths,
// radius 0, an end off the circle by more than rounding to whole pulses explains (0.7072 pulses along the radius),
// steer on a circle of radius 1 or an ellipse with a semi-axis of 1 (it passes the centre), a velocity of 0 or of
// more than one pulse per clock.
AnyInterpolator make_interpolator(Method method, const Curve& curve, const Options& options = {});

// The checks that make_interpolator makes before those of the method; throws std::invalid_argument too.
void check_curve(const Curve& curve);

}  // namespace trammel::interpolation
