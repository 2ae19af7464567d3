// Results of a probe, and their use by a program before the run and during it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "probing.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;

constexpr unsigned kX = 1;
constexpr unsigned kY = 2;
constexpr unsigned kZ = 4;

TEST(Probe, ItsWordSaysHowItEnds) {
  const auto probe = [](const std::string& word) { return read_probing(word + " X1 Z-2 F90").motions.at(0); };
  const std::vector<std::pair<const char*, std::pair<bool, bool>>> words = {{"G38.2", {false, true}},
                                                                            {"G38.3", {false, false}},
                                                                            {"G38.4", {true, true}},
                                                                            {"G38.5", {true, false}},
                                                                            {"G31", {false, false}}};
  for (const auto& [word, flags] : words) {
    const Motion motion = probe(word);
    EXPECT_EQ(motion.kind, MotionKind::kProbe) << word;
    EXPECT_EQ(motion.probe_away, flags.first) << word;
    EXPECT_EQ(motion.probe_must_trip, flags.second) << word;
    EXPECT_EQ(motion.feed, 1.5) << word;
    EXPECT_EQ(motion.target, (Coordinates{1, 0, -2})) << word;
  }
}

TEST(Probe, NothingComesBeforeItsEndIsTold) {
  const machine::Machine machine = machine_with_probe();
  TextLines lines("G38.3 Z-3 F60\nG0 X1\n", "p.ngc");
  Reader reader(lines, machine);
  Motion motion;
  ASSERT_TRUE(reader.next(motion));
  for (int twice = 0; twice < 2; ++twice) {
    EXPECT_FALSE(reader.next(motion));
    EXPECT_TRUE(reader.awaits_probe());
    EXPECT_FALSE(reader.error());
  }
  reader.probed({0, 0, -1}, {0, 0, -1.5}, true);
  EXPECT_FALSE(reader.awaits_probe());
  ASSERT_TRUE(reader.next(motion));
  EXPECT_EQ(motion.target, (Coordinates{1, 0, -1.5})) << "it goes on from where the machine stands";
  ASSERT_TRUE(reader.next(motion));
  EXPECT_EQ(motion.kind, MotionKind::kEnd);
  for (int twice = 0; twice < 2; ++twice) EXPECT_FALSE(reader.next(motion));
}

TEST(Probe, ResultsAreProgramCoordinatesOfTheEdge) {
  machine::Machine machine = machine_with_probe();
  machine.axes[0].offsets[0] = 1;
  machine.axes[2].offsets[0] = 2;
  const std::vector<ProbeEnd> ends = {{{26.4, 0, -10.7}, {26.4, 0, -12}}};
  const auto result = [&](const std::string& value) {
    const ProbedReading read = read_probing("G20 G38.2 Z-1 F60\nG21 G53 G0 X" + value, ends, machine);
    EXPECT_EQ(read.message(), "accepted") << value;
    EXPECT_EQ(read.later(), 0U) << value;
    EXPECT_EQ(read.target(2), -12) << value;
    return read.target(0);
  };
  EXPECT_NEAR(result("#5061"), 1, 1e-12) << "in the units of the probe's line";
  EXPECT_NEAR(result("#5063"), -0.5, 1e-12);
  EXPECT_EQ(result("#5064"), 0) << "there is no A";
  EXPECT_EQ(result("#5070"), 1);
  EXPECT_NEAR(result("#5422"), -14 / 25.4, 1e-12) << "where the machine is";
}

TEST(Probe, SaysWhetherItTripped) {
  const auto success = [](bool tripped) {
    return read_probing("G38.3 Z-3 F60\nG0 X#5070 Y1", {{{0, 0, -3}, {0, 0, -3}, tripped}}).target(0);
  };
  EXPECT_EQ(success(true), 1);
  EXPECT_EQ(success(false), 0);
}

TEST(Probe, BeforeTheRunItsValuesAreNotKnown) {
  struct Case {
    const char* text;
    unsigned later;
    double x;
  };
  const std::vector<Case> cases = {
      {"G0 X#5063", kX | kZ, -3},
      {"G0 X1", kZ, 1},
      {"G0 X#5063 Z0", kX, -3},
      {"G0 X#5061 Z0", 0, 0},  // the probe does not move X
      {"G0 X#5070 Z0", kX, 1},
      {"G0 X[#5063+1] Z0", kX, -2},
      {"G0 X[1+#5063] Z0", kX, -2},
      {"G0 X-#5063 Z0", kX, 3},
      {"G0 Xabs[#5063] Z0", kX, 3},
      {"G0 Xatan[#5063]/[3] Z0", kX, -45},
      {"G0 Xatan[3]/[#5063] Z0", kX, 135},
      {"#1=7\nG0 X#[#5063+4] Z0", kX, 7},
      {"G0 Xexists[#[#5063+4]] Z0", kX, 1},
      {"G0 X#5422 Z0", kX, -3},
      {"G0 X#<_z> Z0", kX, -3},
      {"G0 X#<_x> Z0", 0, 0},
      {"#1=#5063\nG0 X#1 Z0", kX, -3},
      {"#<edge>=#5063\nG0 X#<edge> Z0", kX, -3},
      {"#1=#5063\n#1=5\nG0 X#1 Z0", 0, 5},
  };
  for (const Case& one : cases) {
    const ProbedReading read = read_assumed(one.text);
    EXPECT_EQ(read.message(), "accepted") << one.text;
    EXPECT_EQ(read.later(), one.later) << one.text;
    EXPECT_NEAR(read.target(0), one.x, 1e-12) << one.text;
    const ProbedReading met = read_met(one.text, -3);
    EXPECT_EQ(met.later(), 0U) << one.text;
    EXPECT_NEAR(met.target(0), one.x, 1e-12) << one.text;
  }
}

// Values that are invalid if the probe trips at its target, -3, and valid if it trips at -2.
TEST(Probe, ValuesThatMayBeWrongAreToldWhenTheyAre) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"[1/[#5063+3]]", "division by 0"},
      {"[1 mod [#5063+3]]", "division by 0"},
      {"[[#5063+3]**-1]", "a power that is no number"},
      {"sqrt[#5063+2.5]", "SQRT of a number below 0"},
      {"ln[#5063+3]", "LN of a number that is not above 0"},
      {"asin[#5063*.4]", "ASIN of a number beyond -1 to 1"},
      {"exp[[#5063+2]*-800]", "EXP is out of range"},
      {"[[#5063+2]*-2*10**12]", "an expression's value of 2e+12 is out of range"},
      {"[[#5063+2]*-10**99*100]", "an expression's value is out of range"},
      {"#[#5063+3]", "#0: parameters have the numbers 1 to 5602, or names"},
  };
  for (const auto& [value, message] : cases) {
    const std::string line = std::string("G0 Z0 X") + value;
    const ProbedReading read = read_assumed(line);
    EXPECT_EQ(read.message(), "accepted") << value;
    EXPECT_EQ(read.later(), kX) << value;
    EXPECT_EQ(read.target(0), 0) << value;
    EXPECT_EQ(read_met(line, -3).refusal(), std::string("2: ") + message);
    EXPECT_EQ(read_met(line, -2).message(), "accepted") << value;
  }
}

TEST(Probe, WordsThatHaveToBeKnownBeforeTheRun) {
  machine::Machine machine = machine_with_probe();
  machine.tools.push_back({1, {0, 0, 12.5}});
  machine::apply_override(machine, "outputs.p1=4");
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"G[#5070] X1", "'G[#5070]' cannot depend on a probe"},
      {"M[#5070*5]", "'M[#5070*5]' cannot depend on a probe"},
      {"T#5070", "'T#5070' cannot depend on a probe"},
      {"N#5070 G0 X1", "'N#5070' cannot depend on a probe"},
      {"G43 H#5070", "'H#5070' cannot depend on a probe"},
      {"G10 L[#5070*2] P1 X1", "'L[#5070*2]' cannot depend on a probe"},
      {"G10 L2 P#5070 X1", "G10: P cannot depend on a probe"},
      {"M62 P#5070", "M62: P cannot depend on a probe"},
      {"#[#5070]=5", "the number of a parameter that is set cannot depend on a probe"},
  };
  for (const auto& [line, message] : cases) {
    const ProbedReading read = read_assumed(line, machine);
    EXPECT_EQ(read.refusal(), std::string("2: ") + message);
    ASSERT_TRUE(read.error);
    EXPECT_EQ(read.error->code, ErrorCode::kDependsOnProbe) << line;
    EXPECT_EQ(read_met(line, -3, machine).message(), "accepted") << line;
  }
}

TEST(Probe, NegativeValuesAreToldWhenTheyAreKnown) {
  const ProbedReading read = read_assumed("G1 X5 F#5063\nG0 Y1 Z0");
  EXPECT_EQ(read.message(), "accepted");
  ASSERT_EQ(read.motions.size(), 3U) << "no feed, no motion";
  EXPECT_EQ(read.later(), kX);
  EXPECT_EQ(read_met("G1 X5 F#5063", -3).refusal(), "2: 'F#5063' must not be negative");
  EXPECT_EQ(read_met("G1 X5 F#5063", 90).motions.at(1).feed, 1.5);

  for (const char* letter : {"P", "S"}) {
    const std::string line = std::string("G4 ") + letter + "#5063";
    const ProbedReading dwell = read_assumed(line);
    EXPECT_EQ(dwell.message(), "accepted");
    EXPECT_EQ(dwell.motions.at(1).kind, MotionKind::kDwell);
    EXPECT_EQ(dwell.motions.at(1).seconds, 0) << letter;
    EXPECT_THAT(read_met(line, -3).refusal(), HasSubstr("must not be negative")) << letter;
    EXPECT_EQ(read_met(line, 2).motions.at(1).seconds, 2) << letter;
  }

  const std::string blend = "G64 P#5063\nG1 X5 Z0";
  EXPECT_EQ(read_assumed(blend).motions.at(1).tolerance, 0);
  EXPECT_EQ(read_met(blend, -3).refusal(), "2: 'P-3' must not be negative");
  EXPECT_EQ(read_met(blend, 0.5).motions.at(1).tolerance, 0.5);
}

TEST(Probe, RefusesWhatIsNoProbe) {
  const auto refused = [](const std::string& text) { return read_probing(text).refusal(); };
  EXPECT_EQ(refused("G93 G38.2 Z-1 F1"), "1: G38.2 needs a feed: G94, not G93");
  EXPECT_EQ(refused("G38.3 Z-1"), "1: motion with feed, but no F word before");
  EXPECT_EQ(refused("F60\nG38.2"), "2: G38.2 without an axis word");
  EXPECT_EQ(refused("F60\nG38.5"), "2: G38.5 without an axis word");
  EXPECT_EQ(refused("F60 G38.4 Z0"), "1: G38.4 ends where it begins");
  EXPECT_EQ(refused("F60 G53 G38.2 Z-1"), "1: G53 needs G0 or G1");
  EXPECT_EQ(read_text("F60 G38.2 Z-1").refusal(),
            "1: G38.2: the machine file has no probe: --set probe.input=N or [probe] of the file names its input");
}

// Before the run the line makes no motion, and its end point is unknown.
TEST(Probe, LinesThatMayBeWrongAreCheckedWhenTheyAreReached) {
  struct Case {
    const char* line;
    unsigned axes;
    ErrorCode code;
    const char* message;  // if the probe trips at its target
  };
  const std::vector<Case> cases = {
      {"G1 X5 F[#5063+3]", kX, ErrorCode::kFeedTooSmall, "feed is 0"},
      {"G2 X5 R[#5063+3]", kX, ErrorCode::kArcRadiusZero, "arc of radius 0"},
      {"G2 X5 R[#5063+4]", kX, ErrorCode::kArcRadiusTooSmall, "R is too small: the end point is 5.0000 mm away"},
      {"G2 X[#5063+3] R5", kX, ErrorCode::kArcRadiusFullCircle,
       "an arc with R needs an end point other than its start; a full circle takes I, J or K"},
      {"G2 X5 Y5 I[#5063+4]", kX | kY, ErrorCode::kArcOffCircle,
       "the arc's end is not on its circle: radius 1.000 mm at the start, 6.403 mm at the end"},
      {"G2 X4 I2 P[#5063+3.5]", kX, ErrorCode::kArcTurns, "P0.5: an arc makes a whole number of turns, 1 to 10000"},
      {"G81 X1 Z-1 R#5063", kX | kZ, ErrorCode::kCycleLevels, "R of G81 is below Z, the bottom of the hole"},
      {"G83 X1 Z-5 R1 Q[#5063+3]", kX | kZ, ErrorCode::kCycleLevels, "Q of G83 must be above 0"},
      {"G83 X1 Z-5 R1 Q[#5063+3.00001]", kX | kZ, ErrorCode::kTooManyMotions,
       "a cycle of more than 65536 motions on one line"},
      {"G38.2 X[#5063+3]", kX, ErrorCode::kProbeWay, "G38.2 ends where it begins"},
  };
  for (const Case& one : cases) {
    const std::string text = std::string(one.line) + "\nG80\nG0 E1";
    const ProbedReading read = read_assumed(text);
    EXPECT_EQ(read.message(), "accepted") << one.line;
    ASSERT_EQ(read.motions.size(), 3U) << one.line;
    EXPECT_EQ(read.later(), one.axes | kZ) << one.line;
    EXPECT_EQ(read.target(0), 0) << one.line;
    const ProbedReading met = read_met(text, -3);
    EXPECT_EQ(met.refusal(), std::string("2: ") + one.message);
    ASSERT_TRUE(met.error);
    EXPECT_EQ(met.error->code, one.code);
  }
  // These errors do not depend on values.
  EXPECT_EQ(read_assumed("G2 X#5063 I1 K1").refusal(), "2: K in the plane XY (G17)");
  EXPECT_EQ(read_assumed("G93\nG1 X#5063").refusal(), "3: under G93 every motion needs an F word");
  EXPECT_EQ(read_assumed("G0 X1 Z0\nG1 X5 F0").refusal(), "3: feed is 0") << "nothing depends on the probe there";
}

// If the first probe decides whether the line of the second one is valid, the results of the second are unknown, as if
// it had run.
TEST(Probe, AProbeThatMayBeWrongHasNoKnownResults) {
  for (const char* probe : {"G38.2 X[#5063+3]", "G38.3 X1 F[#5063+3]", "G31 X1 F[#5063+3]"}) {
    const ProbedReading read = read_assumed(std::string(probe) + "\nG0 Y[1/#5061] X0 Z0");
    EXPECT_EQ(read.message(), "accepted") << probe;
    EXPECT_EQ(read.later(), kY) << probe;
  }
  EXPECT_EQ(read_assumed("G31 X1 F[#5063+3]\nX2").refusal(), "3: axis words without a motion word (G0, G1, G2 or G3)");
}

}  // namespace
}  // namespace trammel::gcode
