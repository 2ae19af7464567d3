#include "trammel/run/deviation_meter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "trammel/driver/arc.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::run {
namespace {

driver::LineCommand line(std::int64_t x, std::int64_t y, std::uint64_t ticks) {
  driver::LineCommand result;
  result.ticks = ticks;
  result.mask = 3;
  result.increment[0] = driver::rounded_increment(x, ticks);
  result.increment[1] = driver::rounded_increment(y, ticks);
  return result;
}

TEST(DeviationMeter, MeasuresALineAfterAllStepsOfATick) {
  DeviationMeter meter;
  meter.command(0, driver::FeedCommand{});
  meter.command(1, line(2, 2, 10));
  meter.step(1, 3, 0, 1);
  meter.step(1, 3, 1, 1);  // in the same tick: on the line
  meter.step(1, 7, 0, 1);  // at (2, 1): off by half the diagonal of a pulse
  meter.step(1, 8, 1, 1);
  meter.finish();
  EXPECT_NEAR(meter.largest_line(), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(meter.largest_arc(), 0);
}

TEST(DeviationMeter, BeginsEveryPathAtItsStart) {
  DeviationMeter meter;
  meter.command(0, line(-3, 0, 30));
  meter.command(1, line(0, 2, 30));
  for (const std::uint64_t tick : {1U, 2U, 3U}) meter.step(0, tick, 0, -1);
  for (const std::uint64_t tick : {1U, 2U}) meter.step(1, tick, 1, 1);
  meter.finish();
  EXPECT_EQ(meter.largest_line(), 0);
}

TEST(DeviationMeter, MeasuresAnArcOutsideItsAnnulus) {
  driver::ArcGeometry geometry;
  geometry.centre_x = -100 * driver::kCentreUnitsPerPulse;
  geometry.end_x = -200;
  geometry.sweep = 3.141592653589793;
  DeviationMeter meter;
  meter.command(0, driver::make_arc(geometry, 1000));
  meter.step(0, 1, 1, 1);  // (100, 1) about the centre
  meter.finish();
  EXPECT_NEAR(meter.largest_arc(), std::hypot(100, 1) - 100, 1e-9);
  meter.step(0, 2, 0, -1);
  meter.step(0, 2, 0, -1);  // (98, 1)
  meter.finish();
  EXPECT_NEAR(meter.largest_arc(), 100 - std::hypot(98, 1), 1e-9);
}

// The centre comes from the block, in machine coordinates, and not from the command.
TEST(DeviationMeter, MeasuresAnArcInChordsByItsBlock) {
  planner::Block block;
  block.start = {7, 5, 300, 0};
  block.end = {0, 5, 500, 0};
  block.axis_x = 2;
  block.axis_y = 1;
  block.joint_x = 2;
  block.joint_y = 1;
  block.centre_x = 400 * driver::kCentreUnitsPerPulse;
  block.centre_y = 5 * driver::kCentreUnitsPerPulse;
  DeviationMeter meter;
  meter.sending(block);
  meter.command(0, driver::ArcChordCommand{});
  meter.command(1, driver::ArcChordCommand{});
  meter.step(0, 1, 1, -1);  // (-100, -1) about the centre
  meter.step(0, 2, 0, -1);  // outside the plane
  meter.finish();
  EXPECT_NEAR(meter.largest_arc(), std::hypot(100, 1) - 100, 1e-9);
  meter.step(1, 1, 2, 1);
  meter.step(1, 1, 2, 1);  // (-98, -1): the second part continues where the first one ended
  meter.finish();
  EXPECT_NEAR(meter.largest_arc(), 100 - std::hypot(98, 1), 1e-9);
}

TEST(DeviationMeter, RefusesStepsOfCommandsThatWereNeverSent) {
  DeviationMeter meter;
  meter.command(4, line(1, 1, 30));
  EXPECT_THROW(meter.step(5, 1, 0, 1), std::logic_error);
}

}  // namespace
}  // namespace trammel::run
