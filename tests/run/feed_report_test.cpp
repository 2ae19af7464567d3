#include "trammel/run/feed_report.hpp"

#include <gtest/gtest.h>

namespace trammel::run {
namespace {

using planner::SpeedLimit;

// A block of 10 mm and 800 path pulses at F600 that reaches `speed` mm/s.
planner::PlannedBlock block(std::size_t line, SpeedLimit limit, double speed) {
  planner::PlannedBlock planned;
  planned.block.line = line;
  planned.block.length = 10;
  planned.block.wanted = 10;  // mm/s
  planned.block.feed = 10;    // mm/s
  planned.limit = limit;
  planned.speed = speed;
  return planned;
}

TEST(FeedReport, HasOneEntryACauseWithCountAndWorstLine) {
  FeedReport report;
  report.add(block(1, SpeedLimit::kNone, 10));
  report.add(block(2, SpeedLimit::kAxisVelocity, 8));
  report.add(block(3, SpeedLimit::kAcceleration, 5));
  report.add(block(4, SpeedLimit::kAcceleration, 2));
  report.add(block(5, SpeedLimit::kAcceleration, 2));
  const std::vector<FeedNotReached> entries = report.entries();
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].cause, SpeedLimit::kAcceleration);
  EXPECT_EQ(entries[0].count, 3U);
  EXPECT_EQ(entries[0].line, 4U) << "the first of the slowest";
  EXPECT_DOUBLE_EQ(entries[0].wanted, 600);
  EXPECT_DOUBLE_EQ(entries[0].reached, 120);
  EXPECT_EQ(entries[1].cause, SpeedLimit::kAxisVelocity);
  EXPECT_EQ(entries[1].count, 1U);
  EXPECT_DOUBLE_EQ(entries[1].reached, 480);
}

TEST(FeedReport, OfAProgramThatReachesItsFeedsIsEmpty) {
  FeedReport report;
  report.add(block(1, SpeedLimit::kNone, 10));
  EXPECT_TRUE(report.entries().empty());
}

}  // namespace
}  // namespace trammel::run
