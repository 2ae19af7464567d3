// The operator's switches of the reader, and a start in the middle of a program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;

struct Read {
  std::vector<Motion> motions;  // without the end
  Coordinates begin{};
  std::optional<Error> error;
};

Read read_from(const std::string& text, const ReaderOptions& options = {}, std::size_t first_line = 0) {
  const machine::Machine machine = machine::default_machine();
  TextLines lines(text, "p.ngc");
  Reader reader(lines, machine, {}, options);
  Read result;
  if (first_line == 0 || reader.skip_to(first_line)) {
    result.begin = reader.position();
    for (Motion motion; reader.next(motion);) {
      if (motion.kind != MotionKind::kEnd) result.motions.push_back(motion);
    }
  }
  result.error = reader.error();
  return result;
}

TEST(ReaderOptions, FeedScaleIsForFeedsAlone) {
  ReaderOptions options;
  options.feed_scale = 2.5;
  const Read made = read_from("F600\nG0 X1\nG1 X2\nG93 G1 X3 F30\nG4 P2\n", options);
  ASSERT_EQ(made.motions.size(), 4U);
  EXPECT_EQ(made.motions[0].feed, 0);
  EXPECT_DOUBLE_EQ(made.motions[1].feed, 25);
  EXPECT_DOUBLE_EQ(made.motions[2].seconds, 0.8);
  EXPECT_EQ(made.motions[3].seconds, 2) << "a dwell";
}

TEST(ReaderOptions, BlockDeleteOff) {
  const std::string text = "G1 X1 F60\n/X2\n / G4 P1\n//\n/\n/(X5\n";
  EXPECT_EQ(read_from(text).motions.size(), 1U);
  ReaderOptions options;
  options.block_delete = false;
  const Read made = read_from(text, options);
  ASSERT_EQ(made.motions.size(), 3U);
  EXPECT_EQ(made.motions[1].target[0], 2);
  EXPECT_EQ(made.motions[2].kind, MotionKind::kDwell);
  ASSERT_TRUE(made.error) << "what stands behind the '/' is read";
  EXPECT_EQ(made.error->line, 6U);
}

TEST(ReaderSkip, ModesAndPositionOfTheLinesBefore) {
  const std::string text = "G20 G91 F6\nG92 X5\nG1 X1 Y2\nG18\nG4 P9\nX1\nG2 X1 Z1 K1\n";
  const Read whole = read_from(text);
  const Read rest = read_from(text, {}, 6);
  ASSERT_EQ(rest.motions.size(), 2U);
  EXPECT_DOUBLE_EQ(rest.begin[0], 25.4);
  EXPECT_DOUBLE_EQ(rest.begin[1], 50.8);
  for (std::size_t i = 0; i < 2; ++i) {
    const Motion& a = rest.motions[i];
    const Motion& b = whole.motions[i + 2];
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.line, b.line);
    EXPECT_EQ(a.target, b.target);
    EXPECT_EQ(a.feed, b.feed);
    EXPECT_EQ(a.axis_x, b.axis_x);
    EXPECT_EQ(a.centre_x, b.centre_x);
  }
  EXPECT_EQ(read_from(text, {}, 1).motions.size(), whole.motions.size());
}

TEST(ReaderSkip, WhatIsWrongAboveIsAnError) {
  const Read made = read_from("G1 X1 F60\nG1 X\nX2\n", {}, 3);
  ASSERT_TRUE(made.error);
  EXPECT_EQ(made.error->line, 2U);
}

TEST(ReaderSkip, BehindTheEndIsAnError) {
  for (const std::string text : {"X1 G1 F60\nX2\n", "X1 G1 F60\nM2\nX3\nX4\nX5\n", "%\nG1 X1 F60\n%\n\n\n"}) {
    for (const std::size_t line : {std::size_t{4}, std::size_t{50}}) {
      const Read made = read_from(text, {}, line);
      ASSERT_TRUE(made.error) << text;
      EXPECT_EQ(made.error->code, ErrorCode::kNoSuchLine);
      EXPECT_THAT(made.error->message, HasSubstr("before line " + std::to_string(line)));
      EXPECT_TRUE(made.motions.empty());
    }
  }
  EXPECT_EQ(read_from("G1 X1 F60\nX2", {}, 2).motions.size(), 1U);
}

}  // namespace
}  // namespace trammel::gcode
