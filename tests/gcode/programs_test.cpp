// Programs in the style of CAM post-processors and slicers: their lengths, times and holes against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

constexpr double kPi = 3.14159265358979323846;

Reading read_program(const std::string& name) {
  machine::Machine machine = machine::default_machine();
  machine.tools.push_back({1, {0, 0, 12.5}});
  machine.tools.push_back({2, {0, 0, 20}});
  FileLines lines(TRAMMEL_GCODE_PROGRAMS "/" + name);
  Reading reading = read_all(lines, machine);
  EXPECT_FALSE(reading.error) << describe(*reading.error);
  return reading;
}

struct Lengths {
  double feed = 0;      // length of feeds in X, Y and Z, mm
  double extruded = 0;  // forward motion of E, alone or with other axes, mm
  double seconds = 0;   // duration of feeds and dwells
};

double arc_length(const Motion& motion, const Coordinates& from) {
  const auto angle = [&](const Coordinates& at) {
    return std::atan2(at[motion.axis_y] - motion.centre_y, at[motion.axis_x] - motion.centre_x);
  };
  const double radius = std::hypot(from[motion.axis_x] - motion.centre_x, from[motion.axis_y] - motion.centre_y);
  double turn = (angle(motion.target) - angle(from)) * (motion.clockwise ? -1 : 1);
  while (turn <= 1e-9) turn += 2 * kPi;
  return std::hypot(radius * turn, motion.target[2] - from[2]);
}

Lengths lengths_of(const std::vector<Motion>& motions) {
  Lengths sum;
  Coordinates here{};
  for (const Motion& motion : motions) {
    const double straight =
        std::sqrt(std::pow(motion.target[0] - here[0], 2) + std::pow(motion.target[1] - here[1], 2) +
                  std::pow(motion.target[2] - here[2], 2));
    double length = 0;
    if (motion.kind == MotionKind::kLine) length = straight;
    if (motion.kind == MotionKind::kArc) length = arc_length(motion, here);
    sum.feed += length;
    sum.extruded += std::max(0.0, motion.target[3] - here[3]);
    if (length > 0) sum.seconds += length / motion.feed;
    if (motion.kind == MotionKind::kDwell) sum.seconds += motion.seconds;
    here = motion.target;
  }
  return sum;
}

std::size_t count(const Reading& reading, MotionKind kind) {
  return static_cast<std::size_t>(std::count_if(reading.motions.begin(), reading.motions.end(),
                                                [&](const Motion& motion) { return motion.kind == kind; }));
}

// X, Y and Z of the ends of lines at feed with a Z below `below` and above `above`, in machine coordinates.
std::vector<std::array<double, 3>> bottoms(const Reading& reading, double below, double above = -1e9) {
  std::vector<std::array<double, 3>> found;
  for (const Motion& motion : reading.motions) {
    if (motion.kind == MotionKind::kLine && motion.target[2] < below && motion.target[2] > above) {
      found.push_back({motion.target[0], motion.target[1], motion.target[2]});
    }
  }
  return found;
}

// A bracket of 50 x 25 mm with corner radii of 5 mm, a lead-in of 10 mm and a lead-out of a half circle of 5 mm; four
// holes of 8 mm depth, in pecks of 3 mm.
TEST(Programs, FusionBracket) {
  const Reading reading = read_program("fusion.ngc");
  double cut = 0;
  Coordinates here{};
  for (const Motion& motion : reading.motions) {
    const bool at_depth = std::abs(motion.target[2] - (12.5 - 4)) < 1e-9 && std::abs(here[2] - (12.5 - 4)) < 1e-9;
    if (at_depth && motion.kind == MotionKind::kArc) cut += arc_length(motion, here);
    if (at_depth && motion.kind == MotionKind::kLine) {
      cut += std::hypot(motion.target[0] - here[0], motion.target[1] - here[1]);
    }
    here = motion.target;
  }
  // Lead-in of 10, sides of 40, 20, 40 and 20 (the corner at the lead-in is an arc, too), four quarters, half circle.
  const double expected = 10 + 40 + 20 + 40 + 20 + 4 * 5 * kPi / 2 + 5 * kPi;
  EXPECT_NEAR(cut, expected, 1e-9);
  EXPECT_EQ(reading.accepted.at("M6"), 2U);
  const auto holes = bottoms(reading, 20 - 7.5, 20 - 8.5);
  const std::vector<std::array<double, 3>> wanted = {{10, -5, 12}, {40, -5, 12}, {40, -20, 12}, {10, -20, 12}};
  ASSERT_EQ(holes.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_EQ(holes[i], wanted[i]) << i;
}

TEST(Programs, FreecadHoles) {
  const Reading reading = read_program("freecad.ngc");
  const auto holes = bottoms(reading, 20 - 5.5);
  const std::vector<std::array<double, 3>> wanted = {{10, 10, 14}, {30, 10, 14}, {30, 30, 13}, {10, 30, 14}};
  EXPECT_EQ(holes, wanted);
  EXPECT_EQ(count(reading, MotionKind::kArc), 2U);
  // Two half circles of radius 5 mm, each 1 mm down.
  const Lengths lengths = lengths_of(reading.motions);
  // Four holes from R down; G73 backs off by 0.254 mm three times and feeds over that distance again.
  EXPECT_NEAR(lengths.feed, 9 + 9 + 10 + 9 + 3 * 0.254 + 2 * std::hypot(5 * kPi, 1), 1e-9);
}

TEST(Programs, InkscapePath) {
  const Lengths lengths = lengths_of(read_program("inkscape.ngc").motions);
  EXPECT_NEAR(lengths.feed, 5.125 + 2 * 7.5 * kPi / 2 + 30.25 + 7.5 * kPi + 30.25, 1e-9);
}

TEST(Programs, VectricTray) {
  const Lengths lengths = lengths_of(read_program("vectric.ngc").motions);
  EXPECT_NEAR(lengths.feed, 9 + 2 * 60 + 2 * 20 + 4 * 10 * kPi / 2, 1e-9);
  EXPECT_NEAR(lengths.seconds, 9 / (500 / 60.0) + (160 + 20 * kPi) / (1000 / 60.0), 1e-9);
}

TEST(Programs, LightburnFrame) {
  const Reading reading = read_program("lightburn.gcode");
  EXPECT_NEAR(lengths_of(reading.motions).feed, 2 * 40 + 2 * 20, 1e-12);
  EXPECT_EQ(reading.motions.back().target[0], 0);
}

// Layers with a perimeter of 80 mm.
TEST(Programs, PrusaslicerSquare) {
  const Reading reading = read_program("prusaslicer.gcode");
  // E: 5 sides. The extruded length also has two returns of 0.8 mm after retractions.
  EXPECT_NEAR(reading.motions.back().target[3], 5 * 0.6651, 1e-9);
  EXPECT_NEAR(lengths_of(reading.motions).extruded, 5 * 0.6651 + 2 * 0.8, 1e-9);
  EXPECT_EQ(reading.accepted.at("M104"), 2U);
  EXPECT_EQ(reading.accepted.at("M201"), 1U);
  EXPECT_EQ(reading.accepted.at("G29"), 1U);
}

TEST(Programs, CuraSquare) {
  const Reading reading = read_program("cura.gcode");
  // Absolute E, set to 0 by G92 twice: 3 primed, 6.5 retracted and returned, four sides, 6.5 retracted.
  EXPECT_NEAR(reading.motions.back().target[3], 3 + 4 * 0.6651 - 6.5, 1e-9);
  EXPECT_EQ(reading.motions.back().target[0], 0);
  EXPECT_NEAR(reading.motions.back().target[2], 10.3, 1e-12);
}

TEST(Programs, ParametersMakeSixHolesOnACircle) {
  const auto holes = bottoms(read_program("parameters.ngc"), -4.9);
  ASSERT_EQ(holes.size(), 6U);
  for (std::size_t i = 0; i < holes.size(); ++i) {
    EXPECT_NEAR(holes[i][0], 20 * std::cos(static_cast<double>(i) * kPi / 3), 1e-9) << i;
    EXPECT_NEAR(holes[i][1], 20 * std::sin(static_cast<double>(i) * kPi / 3), 1e-9) << i;
    EXPECT_EQ(holes[i][2], -5) << i;
  }
}

}  // namespace
}  // namespace trammel::gcode
