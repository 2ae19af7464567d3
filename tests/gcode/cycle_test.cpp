// Drilling cycles, motion by motion, from their definition.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;

struct Step {
  MotionKind kind;
  double x, y, z;
  double seconds = 0;
};

constexpr MotionKind kRapid = MotionKind::kTraverse;
constexpr MotionKind kFeed = MotionKind::kLine;
constexpr MotionKind kDwell = MotionKind::kDwell;

void expect_steps(const std::string& text, const std::vector<Step>& steps) {
  SCOPED_TRACE(text);
  const Reading program = read_text("G90 G21 F60\nG0 X0 Y0 Z10\n" + text);
  ASSERT_FALSE(program.error) << describe(*program.error);
  ASSERT_EQ(program.motions.size(), steps.size() + 2);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Motion& motion = program.motions[i + 1];
    EXPECT_EQ(motion.kind, steps[i].kind) << i;
    EXPECT_NEAR(motion.target[0], steps[i].x, 1e-12) << i;
    EXPECT_NEAR(motion.target[1], steps[i].y, 1e-12) << i;
    EXPECT_NEAR(motion.target[2], steps[i].z, 1e-12) << i;
    EXPECT_EQ(motion.seconds, steps[i].seconds) << i;
    EXPECT_EQ(motion.feed, motion.kind == kFeed ? 1 : 0) << i;
  }
}

std::string cycle_refusal(const std::string& text) { return read_text("G90 G21 F60\nG0 Z10\n" + text).refusal(); }

TEST(Cycle, DrillsAndRetractsToRByDefault) {
  expect_steps("G81 X1 Y2 Z-1 R2\nX5", {{kRapid, 1, 2, 10},
                                        {kRapid, 1, 2, 2},
                                        {kFeed, 1, 2, -1},
                                        {kRapid, 1, 2, 2},
                                        {kRapid, 5, 2, 2},
                                        {kFeed, 5, 2, -1},
                                        {kRapid, 5, 2, 2}});
}

TEST(Cycle, G98RetractsToWhereTheSeriesBegan) {
  // G82 continues the series that G81 began; it first rises to its own R.
  expect_steps("G99 G81 X1 Z-1 R2\nG98 G82 X3 Z-2 R3 P0.5", {{kRapid, 1, 0, 10},
                                                             {kRapid, 1, 0, 2},
                                                             {kFeed, 1, 0, -1},
                                                             {kRapid, 1, 0, 2},
                                                             {kRapid, 1, 0, 3},
                                                             {kRapid, 3, 0, 3},
                                                             {kFeed, 3, 0, -2},
                                                             {kDwell, 3, 0, -2, 0.5},
                                                             {kRapid, 3, 0, 10}});
}

TEST(Cycle, PecksAndBreaksChips) {
  expect_steps("G83 X1 Z-1 R2 Q1.3", {{kRapid, 1, 0, 10},
                                      {kRapid, 1, 0, 2},
                                      {kFeed, 1, 0, 0.7},
                                      {kRapid, 1, 0, 2},
                                      {kRapid, 1, 0, 0.954},
                                      {kFeed, 1, 0, -0.6},
                                      {kRapid, 1, 0, 2},
                                      {kRapid, 1, 0, -0.346},
                                      {kFeed, 1, 0, -1},
                                      {kRapid, 1, 0, 2}});
  expect_steps("G73 X1 Z-1 R2 Q1.5", {{kRapid, 1, 0, 10},
                                      {kRapid, 1, 0, 2},
                                      {kFeed, 1, 0, 0.5},
                                      {kRapid, 1, 0, 0.754},
                                      {kFeed, 1, 0, -1},
                                      {kRapid, 1, 0, 2}});
}

TEST(Cycle, BoresOutWithFeed) {
  expect_steps("G85 X1 Z-1 R2", {{kRapid, 1, 0, 10}, {kRapid, 1, 0, 2}, {kFeed, 1, 0, -1}, {kFeed, 1, 0, 2}});
  expect_steps("G98 G85 X1 Z-1 R2",
               {{kRapid, 1, 0, 10}, {kRapid, 1, 0, 2}, {kFeed, 1, 0, -1}, {kFeed, 1, 0, 2}, {kRapid, 1, 0, 10}});
  expect_steps("G98 G89 X1 Z-1 R2 P2",
               {{kRapid, 1, 0, 10}, {kRapid, 1, 0, 2}, {kFeed, 1, 0, -1}, {kDwell, 1, 0, -1, 2}, {kFeed, 1, 0, 10}});
  expect_steps("G89 X1 Z-1 R2 P2",
               {{kRapid, 1, 0, 10}, {kRapid, 1, 0, 2}, {kFeed, 1, 0, -1}, {kDwell, 1, 0, -1, 2}, {kFeed, 1, 0, 2}});
}

TEST(Cycle, RepeatsInIncrements) {
  std::vector<Step> steps;
  for (int i = 1; i <= 3; ++i) {
    const double x = i;
    const double y = 2.0 * i;
    for (const Step& step :
         {Step{kRapid, x, y, 10}, Step{kRapid, x, y, 7}, Step{kFeed, x, y, 1}, Step{kRapid, x, y, 10}}) {
      steps.push_back(step);
    }
  }
  expect_steps("G91 G98 G81 X1 Y2 Z-6 R-3 L3", steps);
}

// Adds the motions of a hole at `x`, starting at level `level`: rapid to the place, rapid to R, feed to the bottom,
// rapid out.
void add_hole(std::vector<Step>& steps, double x, double level, double retract, double bottom, double clear) {
  steps.push_back({kRapid, x, 0, level});
  if (level != retract) steps.push_back({kRapid, x, 0, retract});
  steps.push_back({kFeed, x, 0, bottom});
  steps.push_back({kRapid, x, 0, clear});
}

TEST(Cycle, UnderG91RCountsFromWhereTheSeriesBegan) {
  std::vector<Step> below;  // R 6, bottom 3
  add_hole(below, 1, 10, 6, 3, 6);
  add_hole(below, 2, 6, 6, 3, 6);
  add_hole(below, 3, 6, 6, 3, 6);
  add_hole(below, 4, 6, 6, 3, 6);
  expect_steps("G91 G81 X1 Z-3 R-4\nX1\nX1 L2", below);

  std::vector<Step> above{{kRapid, 0, 0, 12}};  // R 12, bottom 9
  for (int x = 1; x <= 3; ++x) add_hole(above, x, 12, 12, 9, 12);
  expect_steps("G91 G81 X1 Z-3 R2\nX1\nX1", above);
  expect_steps("G91 G98 G81 X1 Z-3 R2\nX1\nX1", above);
}

TEST(Cycle, UnderG91NewLevelsCountFromTheSameStart) {
  std::vector<Step> steps;
  add_hole(steps, 1, 10, 6, 3, 6);
  add_hole(steps, 2, 6, 5, 2, 5);
  add_hole(steps, 3, 5, 5, 4, 5);
  steps.push_back({kRapid, 3, 0, 8});  // the hole of G85
  steps.push_back({kRapid, 4, 0, 8});
  steps.push_back({kFeed, 4, 0, 6});
  steps.push_back({kFeed, 4, 0, 8});
  add_hole(steps, 5, 8, 7, 6, 7);  // a new series, from level 8
  expect_steps("G91 G81 X1 Z-3 R-4\nX1 R-5\nX1 Z-1\nG85 X1 Z-2 R-2\nG80\nG81 X1 Z-1 R-1", steps);
}

TEST(Cycle, TheLevelWhereASeriesBeganIsACoordinate) {
  // The tool gets longer by 2. In the program's coordinates the series began at Z10 and continues from Z8. In machine
  // coordinates these levels are 12 and 10.
  std::vector<Step> steps;
  add_hole(steps, 1, 10, 6, 3, 10);
  add_hole(steps, 2, 10, 8, 5, 12);
  add_hole(steps, 3, 12, 8, 5, 12);
  expect_steps("G91 G98 G81 X1 Z-3 R-4\nG43.1 Z2\nX1\nX1", steps);
}

TEST(Cycle, LevelsKeepTheirLengthWhenUnitsChange) {
  std::vector<Step> steps;
  add_hole(steps, 1, 10, 6, 3, 6);
  add_hole(steps, 1 + 25.4, 6, 6, 3, 6);
  expect_steps("G91 G81 X1 Z-3 R-4\nG20 F[60/25.4]\nX1", steps);
}

TEST(Cycle, AnotherPlaneBeginsAnotherSeries) {
  expect_steps("G91 G81 X1 Z-3 R-4\nG18 G81 X1 Y-3 R-4", {{kRapid, 1, 0, 10},
                                                          {kRapid, 1, 0, 6},
                                                          {kFeed, 1, 0, 3},
                                                          {kRapid, 1, 0, 6},
                                                          {kRapid, 2, 0, 6},
                                                          {kRapid, 2, -4, 6},
                                                          {kFeed, 2, -7, 6},
                                                          {kRapid, 2, -4, 6}});
  EXPECT_EQ(cycle_refusal("G81 X1 Z-1 R2\nG18 X2"), "4: G81 needs the bottom of its holes");
}

// Levels relative to the end of a probe are unknown before the run.
TEST(Cycle, LevelsBehindAProbeAreLater) {
  machine::Machine machine = machine::default_machine();
  machine.probe.input = 0;
  const auto later_at_the_end = [&](const std::string& text) {
    const std::string program = "G90 G21 F60\nG0 Z10\nG38.2 Z-3\n" + text;
    TextLines lines(program, "p.ngc");
    Reader reader(lines, machine);
    unsigned later = 0;
    for (Motion motion; reader.next(motion) && motion.kind != MotionKind::kEnd;) {
      later = motion.later;
      if (reader.awaits_probe()) reader.assume_probed();
    }
    if (reader.error()) ADD_FAILURE() << describe(*reader.error());
    return later;
  };
  constexpr unsigned kZ = 1U << 2;
  EXPECT_EQ(later_at_the_end("G81 X1 Z-6 R-4"), 0U);
  EXPECT_EQ(later_at_the_end("G98 G81 X1 Z-6 R-4"), kZ);
  EXPECT_EQ(later_at_the_end("G91 G81 X1 Z-6 R-4"), kZ);
  EXPECT_EQ(later_at_the_end("G81 X1 Z-6 R-4\nX2\nG91 X1"), kZ);
  EXPECT_EQ(later_at_the_end("G81 X1 Z-6 R-4\nG80\nG91 G98 G81 X1 Z-6 R-4"), 0U);
}

TEST(Cycle, RisesToRFirst) {
  expect_steps("G0 Z1\nG81 X1 Z-1 R3",
               {{kRapid, 0, 0, 1}, {kRapid, 0, 0, 3}, {kRapid, 1, 0, 3}, {kFeed, 1, 0, -1}, {kRapid, 1, 0, 3}});
}

TEST(Cycle, WorksInAllPlanes) {
  expect_steps("G18\nG0 Y10\nG98 G81 X1 Y2 Z-6 R3",
               {{kRapid, 0, 10, 10}, {kRapid, 1, 10, -6}, {kRapid, 1, 3, -6}, {kFeed, 1, 2, -6}, {kRapid, 1, 10, -6}});
  expect_steps("G19\nG81 X-4 Y3 Z3 R-1",
               {{kRapid, 0, 3, 3}, {kRapid, -1, 3, 3}, {kFeed, -4, 3, 3}, {kRapid, -1, 3, 3}});
}

TEST(Cycle, EndsWithAnotherMotionOrG80) {
  expect_steps("G81 X1 Z-1 R2\nG80\nG0 X2",
               {{kRapid, 1, 0, 10}, {kRapid, 1, 0, 2}, {kFeed, 1, 0, -1}, {kRapid, 1, 0, 2}, {kRapid, 2, 0, 2}});
  expect_steps("G80 G0 X1\nX2 G1 G80", {{kRapid, 1, 0, 10}, {kFeed, 2, 0, 10}});
  EXPECT_THAT(cycle_refusal("G81 X1 Z-1 R2\nG80\nX2"), HasSubstr("5: axis words without a motion word"));
  EXPECT_THAT(cycle_refusal("G81 X1 Z-1 R2\nG0 X2\nG81 X3"), HasSubstr("5: G81 needs the bottom of its holes"));
}

TEST(Cycle, RefusesWhatMakesNoHole) {
  EXPECT_EQ(cycle_refusal("G81 X1 Z-1"), "3: G81 needs R, the level above its holes");
  EXPECT_EQ(cycle_refusal("G81 X1 R2"), "3: G81 needs the bottom of its holes");
  EXPECT_EQ(cycle_refusal("G83 X1 Z-1 R2"), "3: G83 needs Q, the depth of a peck");
  EXPECT_EQ(cycle_refusal("G73 X1 Z-1 R2 Q0"), "3: Q of G73 must be above 0");
  EXPECT_EQ(cycle_refusal("G82 X1 Z-1 R2"), "3: G82 needs P, the seconds at the bottom");
  EXPECT_EQ(cycle_refusal("G81 X1 Z3 R2"), "3: R of G81 is below Z, the bottom of the hole");
  EXPECT_EQ(cycle_refusal("G81 X1 Z-1 R2 Q1"), "3: Q without G5, G64, G73 or G83");
  EXPECT_EQ(cycle_refusal("G81 X1 Z-1 R2 L0"), "3: L0: a cycle is repeated 1 to 65536 times");
  EXPECT_EQ(cycle_refusal("G81 X1 Z-1 R2 E1"), "3: G81 moves X, Y and Z alone");
  EXPECT_EQ(cycle_refusal("G81"), "3: G81 without an axis word");
  EXPECT_EQ(cycle_refusal("G93 G81 X1 Z-1 R2 F1"), "3: G81 needs a feed: G94, not G93");
  EXPECT_THAT(cycle_refusal("G83 X1 Z-100 R2 Q0.001"), HasSubstr("more than 65536 motions"));
  EXPECT_EQ(cycle_refusal("G81 X1 Z-1 R2 L65537"), "3: L65537: a cycle is repeated 1 to 65536 times");
  EXPECT_EQ(refusal("G0 Z10\nG81 X1 Z-1 R2"), "2: motion with feed, but no F word before");
}

TEST(Cycle, NeedsThreeAxes) {
  for (const std::size_t lacking : {0U, 1U, 2U}) {
    machine::Machine machine = machine::default_machine();
    const std::string letter(1, machine.axes[lacking].letter);
    machine.axes.erase(machine.axes.begin() + static_cast<std::ptrdiff_t>(lacking));
    EXPECT_EQ(read_text("F60\nG81 E1 R2", machine).refusal(),
              "2: a cycle in this plane needs an axis " + letter + ", which the machine lacks");
  }
}

TEST(Cycle, HolesKeepTheirCorners) {
  const Reading program = read_text("G64 P0.5 G81 X1 Y2 Z-1 R2 F60\nG0 X5");
  EXPECT_EQ(program.motions[0].path_control, PathControl::kExactPath);
  EXPECT_EQ(program.motions[0].tolerance, 0);
  EXPECT_EQ(program.motions[program.motions.size() - 2].tolerance, 0.5);
  for (const Motion& motion : read_text("G61.1 G81 X1 Z-1 R2 F60").motions) {
    if (motion.kind == MotionKind::kEnd) continue;
    EXPECT_EQ(motion.path_control, PathControl::kExactStop) << "stops that the program asks for stay";
  }
}

}  // namespace
}  // namespace trammel::gcode
