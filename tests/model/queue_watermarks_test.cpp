// The watermarks against their definition: a queue is low when it holds fewer halfwords than the watermark; the flag
// follows two clocks later.
#include "trammel/model/queue_watermarks.hpp"

#include <gtest/gtest.h>

#include "trammel/skip/commands.hpp"

namespace trammel::model {
namespace {

namespace reg = card_map::reg;

QueueWatermarks::Inputs rooms(std::uint32_t geometry, std::uint32_t feed) { return {{}, geometry, feed}; }

QueueWatermarks with_marks(std::uint32_t geometry, std::uint32_t feed) {
  QueueWatermarks marks(100, 60);
  marks.clock({{true, reg::kGeometryWatermark, geometry}, 100, 60});
  marks.clock({{true, reg::kFeedWatermark, feed}, 100, 60});
  return marks;
}

TEST(QueueWatermarks, LowIsFewerQueuedThanTheWatermark) {
  for (const std::uint32_t geometry : {0U, 1U, 50U, 100U, 101U, 0xFFFFU}) {
    for (const std::uint32_t feed : {0U, 1U, 60U, 61U, 0xFFFFU}) {
      QueueWatermarks marks = with_marks(geometry, feed);
      for (std::uint32_t queued = 0; queued <= 60; ++queued) {
        marks.clock(rooms(100 - queued, 60 - queued));
        marks.clock(rooms(100 - queued, 60 - queued));
        EXPECT_EQ(marks.outputs().geometry_low, queued < geometry) << queued << " of " << geometry;
        EXPECT_EQ(marks.outputs().feed_low, queued < feed) << queued << " of " << feed;
        EXPECT_EQ(skip::horizon(marks, rooms(100 - queued, 60 - queued)), skip::kForever);
      }
    }
  }
}

TEST(QueueWatermarks, ShowTwoClocksLater) {
  QueueWatermarks marks = with_marks(10, 0);
  for (int i = 0; i < 4; ++i) marks.clock(rooms(80, 60));
  EXPECT_FALSE(marks.outputs().geometry_low);
  EXPECT_EQ(skip::horizon(marks, rooms(91, 60)), 0U);
  marks.clock(rooms(91, 60));
  EXPECT_FALSE(marks.outputs().geometry_low);
  marks.clock(rooms(80, 60));
  EXPECT_TRUE(marks.outputs().geometry_low);
  marks.clock(rooms(80, 60));
  EXPECT_FALSE(marks.outputs().geometry_low);
}

}  // namespace
}  // namespace trammel::model
