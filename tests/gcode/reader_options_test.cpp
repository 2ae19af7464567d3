// Options of the reader that the operator sets, and must_reach(), a line that the program must contain.
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
  std::vector<Motion> motions;  // without the motion kEnd
  std::optional<Error> error;
};

Read read_from(const std::string& text, const ReaderOptions& options = {}, std::size_t must_reach = 0) {
  const machine::Machine machine = machine::default_machine();
  TextLines lines(text, "p.ngc");
  Reader reader(lines, machine, {}, options);
  Read result;
  reader.must_reach(must_reach);
  for (Motion motion; reader.next(motion);) {
    if (motion.kind != MotionKind::kEnd) result.motions.push_back(motion);
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
  const std::string text = "G1 X1 F60\n\n/X2\n / G4 P1\n//\n/\n/(X5\n";
  EXPECT_EQ(read_from(text).motions.size(), 1U);
  ReaderOptions options;
  options.block_delete = false;
  const Read made = read_from(text, options);
  ASSERT_EQ(made.motions.size(), 3U);
  EXPECT_EQ(made.motions[1].target[0], 2);
  EXPECT_EQ(made.motions[2].kind, MotionKind::kDwell);
  ASSERT_TRUE(made.error) << "what stands behind the '/' is read";
  EXPECT_EQ(made.error->line, 7U);
}

TEST(ReaderOptions, ALineBehindTheEndIsAnError) {
  for (const std::string text : {"X1 G1 F60\nX2\n", "X1 G1 F60\nM2\nX3\nX4\nX5\n", "%\nG1 X1 F60\n%\n\n\n"}) {
    for (const std::size_t line : {std::size_t{4}, std::size_t{50}}) {
      const Read made = read_from(text, {}, line);
      ASSERT_TRUE(made.error) << text;
      EXPECT_EQ(made.error->code, ErrorCode::kNoSuchLine);
      EXPECT_THAT(made.error->message, HasSubstr("before line " + std::to_string(line)));
    }
  }
  EXPECT_EQ(read_from("G1 X1 F60\nX2", {}, 2).motions.size(), 2U);
}

}  // namespace
}  // namespace trammel::gcode
