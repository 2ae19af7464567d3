// Offsets, homes and levels of cycles that depend on a probe, before the run.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "probing.hpp"

namespace trammel::gcode {
namespace {

constexpr unsigned kXLater = 1;
constexpr unsigned kZLater = 4;

struct LaterEnd {
  const char* text;
  unsigned later;
  double x;
  double z;
};

void expect_later(const std::vector<LaterEnd>& cases) {
  for (const LaterEnd& one : cases) {
    const ProbedReading read = read_assumed(one.text);
    EXPECT_EQ(read.message(), "accepted") << one.text;
    EXPECT_EQ(read.later(), one.later) << one.text;
    const ProbedReading met = read_met(one.text, -3);
    EXPECT_EQ(met.later(), 0U) << one.text;
    for (const ProbedReading& each : {read, met}) {
      EXPECT_NEAR(each.target(0), one.x, 1e-12) << one.text;
      EXPECT_NEAR(each.target(2), one.z, 1e-12) << one.text;
    }
  }
}

TEST(ProbeOffsets, AreNotKnownWhereTheyAreInForce) {
  expect_later({
      {"G92 Z0\nG0 Z1", kZLater, 0, -2},
      {"G92 Z0\nG53 G0 Z1", 0, 0, 1},
      {"G92 X#5063\nG0 X0 Z0", kXLater, 3, 0},
      {"G92 X#5063\nG92.1\nG0 X1 Z0", 0, 1, 0},
      {"G52 X#5063\nG0 X0 Z0", kXLater, -3, 0},
      {"G52 X#5063\nG92.2\nG0 X1 Z0", 0, 1, 0},
      {"G10 L2 P1 X#5063\nG0 X0 Z0", kXLater, -3, 0},
      {"G10 L2 P2 X#5063\nG0 X1 Z0", 0, 1, 0},
      {"G10 L20 P1 Z0\nG0 Z1", kZLater, 0, -2},
      {"G10 L20 P1 X#5063\nG0 X0 Z0", kXLater, 3, 0},
      {"G43.1 X#5063\nG0 X0 Z0", kXLater, -3, 0},
      {"G43.1 X#5063\nG49\nG0 X1 Z0", 0, 1, 0},
      {"G91 G0 Z1", kZLater, 0, -2},
      {"G91 G0 X1", kZLater, 1, -3},
      {"G28.1\nG0 Z0\nG28", kZLater, 0, -3},
      {"G30.1\nG0 Z0\nG30 X1", 0, 0, 0},
  });
}

// G10 L20 and G92 set an offset so that the present position gets a given coordinate. The offset then depends on the
// other offsets.
TEST(ProbeOffsets, PassOnWhatIsNotKnown) {
  expect_later({
      {"G43.1 X#5063\nG10 L20 P1 X0\nG49\nG0 X1 Z0", kXLater, 4, 0},
      {"G52 X#5063\nG10 L20 P1 X0\nG92.1\nG0 X1 Z0", kXLater, 4, 0},
      {"G52 X#5063\nG92.2\nG10 L20 P1 X0\nG0 X1 Z0", 0, 1, 0},
      {"G43.1 X#5063\nG92 X0\nG49\nG0 X1 Z0", kXLater, 4, 0},
      {"G10 L2 P1 X#5063\nG92 X0\nG55\nG0 X1 Z0", kXLater, 4, 0},
  });
}

TEST(ProbeOffsets, ParametersTellThatToo) {
  expect_later({
      {"G92 Z0\n#1=#5213\nG92.1\nG0 X#1 Z0", kXLater, -3, 0},
      {"G10 L2 P3 X#5063\n#1=#5261\nG0 X#1 Z0", kXLater, -3, 0},
      {"G28.1\nG0 X#5163 Z0", kXLater, -3, 0},
      {"F#5070\nG0 X#<_feed> Z0", kXLater, 1, 0},
  });
  const char* const tool = "G43.1 X[#5063+3]\n#1=#<_tool_offset>\nG49\nG0 X#1 Z0";
  EXPECT_EQ(read_assumed(tool).target(0), 1) << "one that is 0 may become another one";
  EXPECT_EQ(read_met(tool, -3).target(0), 0);
  EXPECT_EQ(read_met(tool, -2).target(0), 1);
}

TEST(ProbeOffsets, LevelsOfCyclesAreNotKnown) {
  expect_later({
      {"G81 X1 Z-6 R[#5063+5]", kZLater, 1, 2},
      {"G81 X1 Z[#5063-3] R2", kZLater, 1, 2},
      {"G83 X1 Z-6 R2 Q[#5063+7]", kZLater, 1, 2},
      {"G82 X1 Z-6 R2 P#5070", kZLater, 1, 2},
      {"G81 X1 Z-6 R[#5063+5]\nX2", kZLater, 2, 2},
      {"G81 X1 Z-6 R[#5063+5]\nX2 R1", kZLater, 2, 1},
      {"G81 X1 Z-6 R[#5063+5]\nG85 X2 Z-6 R1", 0, 2, 1},
      {"G81 X1 Z-6 R[#5063+5]\nG80\nG81 X2 Z-6 R1", 0, 2, 1},
      {"G43.1 Z#5063\nG81 X1 Z-6 R2", kZLater, 1, -1},
      {"G81 X#5063 Z-6 R2", kXLater, -3, 2},
  });
}

TEST(ProbeOffsets, LinesThatDependOnProbesAreCounted) {
  const auto count = [](const std::string& text) {
    const ProbedReading read = read_assumed(text);
    EXPECT_EQ(read.message(), "accepted") << text;
    return read.lines_on_probes;
  };
  EXPECT_EQ(count(""), 0U);
  EXPECT_EQ(count("G0 X1"), 1U) << "its way begins where the probe ended";
  EXPECT_EQ(count("G4 P1"), 0U);
  EXPECT_EQ(count("G0 Z0\nX1\nX2"), 1U);
  EXPECT_EQ(count("G0 Z0\nF[#5063+63]\nG1 X1\nX2\nF60 X3\nX4"), 4U) << "the feed, the two lines with it, the first one";
  EXPECT_EQ(count("G0 Z0\nG52 X#5063\nG0 Y1\nX1\nG53 X0\nY2"), 4U);
  EXPECT_EQ(count("G0 Z0\nG81 X1 Z-1 R[#5063+5]\nX2\nG80\nG0 Z0"), 4U);
  const ProbedReading met = read_met("G0 X#5063\nG92 Z0\nG0 Z1", -3);
  EXPECT_EQ(met.lines_on_probes, 0U) << "all is known";
}

}  // namespace
}  // namespace trammel::gcode
