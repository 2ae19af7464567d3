// Curves that make_interpolator refuses, each with its reason, and curves that it accepts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::interpolation {
namespace {

using ::testing::HasSubstr;

std::string reason(Method method, const Curve& curve, const Options& options = {}) {
  try {
    make_interpolator(method, curve, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

Arc arc(Point start, Point end, bool clockwise = false) { return {{0, 0}, start, end, clockwise, 0, 0}; }

TEST(Refusal, Circles) {
  EXPECT_THAT(reason(Method::kSteer, make_circle(0)), HasSubstr("radius 0"));
  EXPECT_THAT(reason(Method::kSteer, make_circle(1)), HasSubstr("passes the centre"));
  EXPECT_THAT(reason(Method::kSteer, make_circle(1, true)), HasSubstr("passes the centre"));
  EXPECT_THAT(reason(Method::kSteer, arc({0, 1}, {1, 0})), HasSubstr("passes the centre"));
  EXPECT_THAT(reason(Method::kSteer, make_ellipse(5, 1)), HasSubstr("passes the centre"));
  EXPECT_THAT(reason(Method::kSteer, make_ellipse(1, 5)), HasSubstr("passes the centre"));
  EXPECT_EQ(reason(Method::kSteer, make_circle(2)), "accepted");
  EXPECT_EQ(reason(Method::kSteer, arc({1, 1}, {1, 1})), "accepted");
  EXPECT_EQ(reason(Method::kSteer, make_ellipse(5, 2)), "accepted");
  EXPECT_EQ(reason(Method::kMinDeviation8, make_circle(1)), "accepted");
  EXPECT_EQ(reason(Method::kRotation, make_circle(kMaxRadius)), "accepted");
  EXPECT_THAT(reason(Method::kRotation, make_circle(kMaxRadius + 1)), HasSubstr("2^30"));
  EXPECT_THAT(reason(Method::kDda, make_circle(std::numeric_limits<std::int64_t>::max())), HasSubstr("2^40"));
  EXPECT_THAT(reason(Method::kDda, make_circle(std::numeric_limits<std::int64_t>::min())), HasSubstr("2^40"));
}

TEST(Refusal, EndsOffTheCircle) {
  EXPECT_THAT(reason(Method::kDda, arc({10, 0}, {0, 11})), HasSubstr("not on one circle"));
  EXPECT_THAT(reason(Method::kDda, arc({10, 0}, {0, 9})), HasSubstr("not on one circle"));
  // (7, 7) lies 0.1005 inside: a rounded point.
  EXPECT_EQ(reason(Method::kDda, arc({10, 0}, {7, 7})), "accepted");
  // sqrt(9^2 + 5^2) - 10 = 0.296, sqrt(10^2 + 4^2) - 10 = 0.770.
  EXPECT_EQ(reason(Method::kDda, arc({10, 0}, {9, 5})), "accepted");
  EXPECT_THAT(reason(Method::kDda, arc({10, 0}, {10, 4})), HasSubstr("not on one circle"));
}

TEST(Refusal, Ellipses) {
  EXPECT_THAT(reason(Method::kSteer, make_ellipse(0, 5)), HasSubstr("below 1"));
  EXPECT_THAT(reason(Method::kSteer, make_ellipse(5, -1)), HasSubstr("below 1"));
  EXPECT_THAT(reason(Method::kSteer, make_ellipse(kMaxSemiAxis + 1, 5)), HasSubstr("2^30"));
  const Arc inside{{0, 0}, {1, 0}, {0, 5}, false, 9, 5};
  EXPECT_THAT(reason(Method::kSteer, inside), HasSubstr("start is off"));
  const Arc outside{{0, 0}, {9, 0}, {0, 8}, false, 9, 5};
  EXPECT_THAT(reason(Method::kMinDeviation8, outside), HasSubstr("end is off"));
}

TEST(Refusal, Lines) {
  const std::int64_t far = kMaxCoordinate + 1;
  EXPECT_THAT(reason(Method::kSteer, make_line({0, 0}, {0, far})), HasSubstr("2^40"));
  EXPECT_THAT(reason(Method::kSteer, make_line({std::numeric_limits<std::int64_t>::min(), 0},
                                               {std::numeric_limits<std::int64_t>::max(), 0})),
              HasSubstr("2^40"));
  EXPECT_THAT(reason(Method::kSteer, make_line({0, 0}, {kMaxLine + 1, 0})), HasSubstr("2^30"));
  EXPECT_EQ(reason(Method::kSteer, make_line({kMaxCoordinate - 5, 0}, {kMaxCoordinate, 1})), "accepted");
  Line line;
  line.axes = 5;
  EXPECT_THAT(reason(Method::kDda, line), HasSubstr("2 to 4"));
  line.axes = 3;
  EXPECT_THAT(reason(Method::kSteer, line), HasSubstr("3 axes"));
  EXPECT_EQ(reason(Method::kOneShot, line), "accepted");
}

TEST(Refusal, WhatAMethodCannotDo) {
  for (const MethodInfo& method : methods()) {
    const std::string cannot = std::string(method.name) + " cannot do ";
    EXPECT_EQ(reason(method.method, make_line({0, 0}, {3, 4})), method.line_axes != 0 ? "accepted" : cannot + "lines");
    EXPECT_EQ(reason(method.method, make_circle(9)), method.circles ? "accepted" : cannot + "circles");
    EXPECT_EQ(reason(method.method, make_ellipse(9, 5)), method.ellipses ? "accepted" : cannot + "ellipses");
    EXPECT_EQ(method_named(method.name), method.method);
    EXPECT_EQ(info(method.method).name, method.name);
    if (method.line_axes == 0) continue;
    const auto walk = make_interpolator(method.method, make_line({0, 0}, {3, 4}));
    EXPECT_EQ(walk.deviation().has_value(), method.deviation) << method.name;
  }
  EXPECT_FALSE(method_named("steered"));
}

TEST(Refusal, Velocities) {
  const Line line = make_line({0, 0}, {2000, 7});
  EXPECT_EQ(reason(Method::kOneShot, line), "accepted");
  EXPECT_THAT(reason(Method::kOneShot, make_line({0, 0}, {2001, 7})), HasSubstr("one pulse a clock"));
  EXPECT_THAT(reason(Method::kDivider, line, {0, 1, 1}), HasSubstr("0 Hz"));
  EXPECT_THAT(reason(Method::kOneShotZero, line, {1'000'000, 0, 1}), HasSubstr("velocity of 0"));
  EXPECT_THAT(reason(Method::kOneShotZero, line, {1'000'000, 1, 0}), HasSubstr("velocity of 0"));
  constexpr std::uint64_t kHuge = std::numeric_limits<std::uint64_t>::max();
  EXPECT_THAT(reason(Method::kOneShot, line, {kHuge, 1, 1}), HasSubstr("2^61"));
  EXPECT_THAT(reason(Method::kOneShot, line, {1u << 31, 1, std::uint64_t{1} << 40}), HasSubstr("2^61"));
  EXPECT_THAT(reason(Method::kOneShot, line, {1'000'000, kHuge, 1}), HasSubstr("2^30"));
  // A line may last longer than a second, and a fraction of a clock longer than a whole number of clocks.
  EXPECT_EQ(make_interpolator(Method::kOneShot, line, {1'000'000, 2, 3}).total_time(), 1'500'000u);
  EXPECT_EQ(make_interpolator(Method::kOneShot, line, {1'000'000, 3, 1}).total_time(), 333'334u);
}

}  // namespace
}  // namespace trammel::interpolation
