// Arcs and helices that the planner sends to the arc generator: ends, limits and speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "chord_arc.hpp"
#include "plan.hpp"
#include "trammel/driver/trigonometry.hpp"

namespace trammel::planner {
namespace {

using driver::ArcChordCommand;
using driver::FeedCommand;
using driver::kPi;

// The last block before the end; it must be one arc in chords.
Planned last_arc(const std::string& text, const machine::Machine& machine = machine::default_machine()) {
  const Plan plan = plan_text(text, machine, {kClock, 4});
  if (plan.error) throw std::runtime_error(plan.error->message);
  return plan.blocks.at(plan.blocks.size() - 2);
}

ArcChordCommand command_of(const Planned& arc) { return commands<ArcChordCommand>(arc).at(0); }

// Highest rate of all pieces, ticks/s.
double top_rate(const Plan& plan) {
  double top = 0;
  for (const Planned& block : plan.blocks) {
    for (const FeedCommand& piece : commands<FeedCommand>(block)) {
      top = std::max(top, std::ldexp(static_cast<double>(piece.rate), -64));
    }
  }
  return top * kClock;
}

// Lowest and highest mean speed along the path over a whole chord, at a feed rate of `rate` ticks/s, mm/s.
std::pair<double, double> chord_speeds(const ArcChordCommand& arc, double rate, double steps_per_mm) {
  model::ChordPath path(model::fields_of(arc));
  const double path_ticks = rate * static_cast<double>(arc.path_ticks) / static_cast<double>(arc.ticks);
  std::pair<double, double> speeds{1e9, 0};
  while (path.left() >= std::uint64_t{2} << arc.m) {
    double x = 0;
    double y = 0;
    for (int half = 0; half < 2; ++half) {
      x += std::ldexp(static_cast<double>(path.increment()[0]), -41);
      y += std::ldexp(static_cast<double>(path.increment()[1]), -41);
      path.half([] {});
    }
    const double speed = std::sqrt(x * x + y * y) * path_ticks / steps_per_mm;
    speeds = {std::min(speeds.first, speed), std::max(speeds.second, speed)};
  }
  return speeds;
}

// At F1200 and radii from 17 pulses, the speed over whole chords is within 0.1 % of the feed.
TEST(GeneratorArcs, KeepTheFeed) {
  const machine::Machine machine = machine_with({"axis.x.max_acceleration=100000", "axis.y.max_acceleration=100000"});
  double worst = 0;
  for (const int radius : {17, 18, 23, 31, 32, 50, 63, 64, 65, 100, 257, 800, 1023, 4000, 16'000, 100'000}) {
    const std::string mm = std::to_string(radius / 80.0);
    for (const char* arc : {"G2 I", "G3 I-"}) {
      const Plan plan = plan_text("G1 F1200 X20\n" + (arc + mm) + " P3\n", machine, {kClock, 4});
      const Planned& circle = plan.blocks.at(1);
      ASSERT_NEAR(circle.planned.speed, 20, 0.002) << radius;
      const auto [least, most] = chord_speeds(command_of(circle), top_rate(plan), 80);
      worst = std::max({worst, std::abs(least / 20 - 1), std::abs(most / 20 - 1)});
    }
  }
  EXPECT_LE(worst, 0.001);
  EXPECT_GT(worst, 0.0001) << "chords are a little shorter than their arcs";
  RecordProperty("worst", std::to_string(worst));
}

TEST(GeneratorArcs, EvenStepsWhereTheClockAllowsThem) {
  for (const char* text : {"G2 I1 F1200\n", "G2 I10 F1200\n", "G2 I300 F1200\n"}) {
    const Planned arc = last_arc(text);
    const double pulses = arc->length * 80;
    EXPECT_NEAR(static_cast<double>(command_of(arc).ticks), 128 * pulses, 2) << text;
    EXPECT_GE(static_cast<double>(command_of(arc).path_ticks), 63.9 * pulses) << text;
  }
}

// The length of a helix is that of X, Y and Z, to which F applies; E moves along.
TEST(GeneratorArcs, Helices) {
  const Planned helix = last_arc("G1 X10 F600\nG3 X0 Y10 I-10 J0 Z-3 E2 P3\n");
  const double way = 2.25 * 2 * kPi * 10;
  EXPECT_NEAR(helix->exact.sweep, 2.25 * 2 * kPi, 1e-9);
  EXPECT_NEAR(helix->length, std::sqrt(way * way + 9), 1e-6);
  EXPECT_NEAR(helix->feed, 10, 1e-9);
  EXPECT_NEAR(helix->entry[1], way / helix->length, 1e-9) << "up, from the right of the centre";
  EXPECT_NEAR(helix->exit[0], -way / helix->length, 1e-9);
  EXPECT_NEAR(helix->entry[2], -3 / helix->length, 1e-9);
  EXPECT_NEAR(helix->exit[3], 2 / helix->length, 1e-9);
  const ArcChordCommand command = command_of(helix);
  EXPECT_EQ(command.mask, 0b1111);
  const auto made = [&](unsigned axis) {
    return std::llround(std::ldexp(static_cast<double>(command.increment[axis]), -40) *
                        static_cast<double>(command.path_ticks));
  };
  EXPECT_EQ(made(2), -240);
  EXPECT_EQ(made(3), 160);
  model::ChordPath path(model::fields_of(command));
  path.finish([] {});
  EXPECT_EQ(path.position(), (std::array<std::int64_t, 2>{-800, 800}));
}

TEST(GeneratorArcs, InOtherPlanes) {
  const ArcChordCommand zx = command_of(last_arc("G18 G2 Z10 X10 I10 Y5 F600\n"));
  EXPECT_EQ(zx.axis_x, 2);
  EXPECT_EQ(zx.axis_y, 0);
  EXPECT_NE(zx.increment[1], 0);
  const ArcChordCommand yz = command_of(last_arc("G19 G3 Y10 Z10 K10 F600\n"));
  EXPECT_EQ(yz.axis_x, 1);
  EXPECT_EQ(yz.axis_y, 2);
}

// Limits of centripetal acceleration and jerk apply in the plane; axes outside it have their own limits.
TEST(GeneratorArcs, AreLimited) {
  const Planned circle = last_arc("G2 I1 F60000\n");
  EXPECT_LE(circle.planned.speed * circle.planned.speed, 1000 * 1.001);
  EXPECT_GE(circle.planned.speed * circle.planned.speed, 1000 * 0.85);
  const machine::Machine jerky = machine_with({"axis.x.max_jerk=1000", "axis.y.max_jerk=1000"});
  EXPECT_LE(std::pow(last_arc("G2 I1 F60000\n", jerky).planned.speed, 3), 1000 * 1.001);
  // A helix so steep that Z limits it, to 10 mm/s of Z.
  const machine::Machine slow = machine_with({"axis.z.max_velocity=10"});
  const Planned steep = last_arc("G2 I10 Z100 F60000\n", slow);
  EXPECT_LE(steep.planned.speed * std::abs(steep->entry[2]), 10.001);
  EXPECT_GE(steep.planned.speed * std::abs(steep->entry[2]), 9.9);
  EXPECT_EQ(steep.planned.limit, SpeedLimit::kAxisVelocity);
  // The arc limits a flat helix, as it limits the circle.
  const Planned flat = last_arc("G2 I1 Z0.1 F60000\n");
  EXPECT_NEAR(flat.planned.speed, circle.planned.speed, 0.1);
}

// An arc with more turns than the path ticks of a command allow becomes several commands, one after the other.
TEST(GeneratorArcs, LongOnesAreSplit) {
  const Plan plan = plan_text("G2 I2000 Z5 P2000 F6000\n", machine::default_machine(), {kClock, 4});
  ASSERT_FALSE(plan.error);
  const auto parts = commands<ArcChordCommand>(plan.blocks.at(0));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(plan.blocks.at(0).planned.geometry, 2U);
  std::int64_t z = 0;
  for (const ArcChordCommand& part : parts) {
    EXPECT_LT(part.path_ticks, std::uint64_t{1} << 37U);
    z += std::llround(std::ldexp(static_cast<double>(part.increment[2]), -40) * static_cast<double>(part.path_ticks));
  }
  EXPECT_EQ(z, 400);
  EXPECT_NEAR(static_cast<double>(parts[0].ticks), static_cast<double>(parts[1].ticks), 1);
}

}  // namespace
}  // namespace trammel::planner
