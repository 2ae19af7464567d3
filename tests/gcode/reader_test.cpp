#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {

using namespace machine;
namespace {

using ::testing::HasSubstr;

Reading read(const std::string& text) {
  Reading program = read_text(text);
  EXPECT_FALSE(program.error) << describe(*program.error);
  return program;
}

void expect_at(const Motion& motion, double x, double y, double z = 0, double e = 0) {
  EXPECT_NEAR(motion.target[0], x, 1e-9);
  EXPECT_NEAR(motion.target[1], y, 1e-9);
  EXPECT_NEAR(motion.target[2], z, 1e-9);
  EXPECT_NEAR(motion.target[3], e, 1e-9);
}

// Target of the last motion before the end.
void expect_end(const std::string& text, double x, double y, double z = 0, double e = 0) {
  SCOPED_TRACE(text);
  expect_at(read(text).motions.back(), x, y, z, e);
}

TEST(Gcode, ReadsWordsInAnyDress) {
  const Reading program = read("n10 g1x1Y-2.5 Z+.5F600\r\n\t X 3.(note)Y4;rest G99\n\n(only a note)\n");
  ASSERT_EQ(program.motions.size(), 3U);
  EXPECT_EQ(program.motions[0].kind, MotionKind::kLine);
  EXPECT_EQ(program.motions[0].line, 1U);
  EXPECT_EQ(program.motions[0].feed, 10);
  expect_at(program.motions[0], 1, -2.5, 0.5);
  expect_at(program.motions[1], 3, 4, 0.5);
  EXPECT_EQ(program.motions[1].line, 2U);
  EXPECT_EQ(program.motions[2].kind, MotionKind::kEnd);
}

TEST(Gcode, RefusesMalformedWords) {
  EXPECT_EQ(refusal("G0 X"), "1: malformed number in 'X'");
  EXPECT_EQ(refusal("G0 X1\nG0 X--5"), "2: malformed number in 'X--5'");
  EXPECT_EQ(refusal("G0 X1.2.3"), "1: malformed number in 'X1.2.3'");
  EXPECT_EQ(refusal("G0 X1 2"), "1: unexpected '2'");
  EXPECT_EQ(refusal("G0 X."), "1: malformed number in 'X.'");
  EXPECT_EQ(refusal("G0 Xnan"), "1: malformed number in 'X'");
  EXPECT_EQ(refusal("G0 Xinf"), "1: malformed number in 'X'");
  EXPECT_THAT(refusal("G0 X" + std::string(400, '9')), HasSubstr("1: number out of range"));
  EXPECT_EQ(refusal("G0 X1*71"), "1: malformed number in 'X1*71'");
  EXPECT_EQ(refusal("G0 (open"), "1: comment without ')'");
  EXPECT_EQ(refusal("G0 (a (b) )"), "1: '(' inside a comment");
  EXPECT_EQ(refusal("G0 )"), "1: unexpected ')'");
  EXPECT_EQ(refusal("G0 \x01"), "1: unexpected byte 0x01");
  EXPECT_EQ(refusal("G0 \xc3\xa4"), "1: unexpected byte 0xc3");
  EXPECT_EQ(refusal(std::string("G0\0X1", 5)), "1: unexpected byte 0x00");
  EXPECT_EQ(refusal("G0 *&X1"), "1: unexpected '*&'");
  EXPECT_EQ(refusal("G0 *\x01"), "1: unexpected '*'");
  EXPECT_EQ(refusal("G0 X-*\x01"), "1: malformed number in 'X-*'");
  EXPECT_EQ(refusal("G"), "1: malformed number in 'G'");
  EXPECT_EQ(refusal("GX1"), "1: malformed number in 'G'");
}

TEST(Gcode, RefusesExponents) {
  EXPECT_EQ(refusal("G0 X1.5e-05"),
            "1: malformed number in 'X1.5e-05': write it without exponent; before an axis e put a blank");
  for (const char* line : {"G0 X1e5", "G0 X1.e5", "g0x1e2", "G0 X-1.5e+3 Y1", "G1 F1e3"}) {
    EXPECT_THAT(refusal(line), HasSubstr("write it without exponent")) << line;
  }
  EXPECT_EQ(refusal("G0 X1E5"), "accepted");
  EXPECT_EQ(refusal("g0 x1 e5"), "accepted");
}

TEST(Gcode, RefusesTextBesideAndBehindPercent) {
  EXPECT_EQ(refusal("%\nG0 X1\n%\nG0 X2"), "4: 'G0 X2' beside or behind '%', where nothing is read");
  EXPECT_EQ(refusal("% G0 X1"), "1: 'G0 X1' beside or behind '%', where nothing is read");
  EXPECT_EQ(refusal("%G0 X1\n"), "1: 'G0 X1' beside or behind '%', where nothing is read");
  EXPECT_EQ(refusal("%\nG0 X1\n% G0 X2"), "3: 'G0 X2' beside or behind '%', where nothing is read");
  EXPECT_EQ(refusal("%\nG0 X1\n%\n%G0 X2"), "4: 'G0 X2' beside or behind '%', where nothing is read");
  EXPECT_EQ(refusal("%\nG0 X1\n%\nnot G-code"), "4: 'not G-code' beside or behind '%', where nothing is read");
  EXPECT_EQ(refusal("G0 X1 %"), "1: '%' beside other words: it needs a line of its own");
  EXPECT_EQ(refusal("G0 X1%"), "1: '%' beside other words: it needs a line of its own");
  EXPECT_EQ(refusal(" % (tape) ; start\nG0 X1\n % ;end\n\n(note)\n;note\n/G0 X1\n%\n"), "accepted");
}

TEST(Gcode, MessagesQuoteOneShortLine) {
  EXPECT_EQ(refusal("G0 X\t\x1b[1m"), "1: malformed number in 'X'");
  EXPECT_EQ(refusal("G0 X\t1\t*"), "1: unexpected '*'");
  EXPECT_EQ(refusal("D\t\t1"), "1: unsupported word 'D\\t\\t1'");
  EXPECT_EQ(refusal("%\x1b[2J\xff"), "1: '\\x1b[2J\\xff' beside or behind '%', where nothing is read");
  const std::string zeros(5000, '0');
  EXPECT_EQ(refusal("D" + zeros), "1: unsupported word 'D" + zeros.substr(0, 76) + "...'");
  EXPECT_EQ(refusal("*" + std::string(79, '*')), "1: unexpected '" + std::string(80, '*') + "'");
  EXPECT_EQ(refusal("*" + std::string(80, '*')), "1: unexpected '" + std::string(77, '*') + "...'");
  EXPECT_EQ(describe({ErrorCode::kCannotRead, "a\nb\x1b\xc3\xa4", 3, "message"}), "a\\nb\\x1b\xc3\xa4:3: message");
}

TEST(Gcode, RefusesNumbersBeyondReason) {
  EXPECT_EQ(refusal("G0 X1000000000000"), "accepted");
  EXPECT_EQ(refusal("G0 X1000000000001"), "1: number out of range in 'X1000000000001'");
  EXPECT_EQ(refusal("G1 X1 F0.06"), "accepted");
  EXPECT_EQ(refusal("G1 X1 F0.0599"), "1: feed is too small: 0.0599 mm/min, at least 0.06 are possible");
  EXPECT_EQ(refusal("G20 G1 X1 F0.0024"), "accepted");
  EXPECT_EQ(refusal("G20 G1 X1 F0.0023"), "1: feed is too small: 0.05842 mm/min, at least 0.06 are possible");
  EXPECT_EQ(refusal("G93 G1 X1 F0.001"), "accepted");
  EXPECT_EQ(refusal("G93 G1 X1 F0.00099"), "1: feed is too small: under G93 at least F0.001 (1,000 minutes)");
}

TEST(Gcode, RefusesWordsItDoesNotKnow) {
  for (const char* word : {"D1", "G-1", "G20000", "G1.05", "G1.06", "M3.04"}) {
    EXPECT_EQ(refusal(std::string("G21\n") + word), std::string("2: unsupported word '") + word + "'");
  }
  EXPECT_EQ(refusal("G0 A5"), "1: 'A5': the machine has no axis A; [axis.a] of its file would describe it");
  EXPECT_EQ(refusal("G5.2 X1"), "1: unsupported word 'G5.2': B-splines are not there; G5 and G5.1 are");
  EXPECT_EQ(refusal("G41 D1"), "1: unsupported word 'G41': cutter compensation: let the CAM program offset the path");
  for (const char* word : {"G33 K1", "G76", "G84", "G74", "G86", "G87", "G88", "G95", "G96", "M48", "M98", "G43.2"}) {
    EXPECT_THAT(refusal(word), HasSubstr("': ")) << word;
  }
  for (const char* line : {"O100 sub", "o<cut> call [1]", "G0 X1 O5", "N5 o#1 if [1]"}) {
    EXPECT_THAT(refusal(line), HasSubstr("1: O-word '")) << line;
  }
}

TEST(Gcode, RefusesTwoWordsOfAModalGroup) {
  for (const char* line : {"G0 G1 X1", "G1 G1 X1 F1", "G17 G18", "G20 G21", "G90 G91", "G90.1 G91.1", "G93 G94",
                           "G54 G55", "G61 G64", "G61 G61.1", "G4 G28 P1", "M3 M5", "M7 M9", "M0 M2", "M82 M83"}) {
    EXPECT_THAT(refusal(line), HasSubstr("beside another word of its modal group")) << line;
  }
  EXPECT_EQ(refusal("G0 X1 X2"), "1: 'X2': X stands twice");
  EXPECT_EQ(refusal("F1 F2"), "1: 'F2': F stands twice");
  EXPECT_EQ(refusal("G0 X1 N5"), "1: 'N5' must be the first word");
  EXPECT_EQ(refusal("N1.5 G0 X1"), "1: 'N1.5' must be a whole number");
  EXPECT_EQ(refusal("F-1"), "1: 'F-1' must not be negative");
}

TEST(Gcode, ListsWhatHasNoEffectYet) {
  const Reading program =
      read("M3 S100 T2\nM8\nG64 P0.1 Q0.01\nG40 G49 G61 G80\nM0\nM1\nM5 M9\nM3 S5\nM84\nM18\nM30\n");
  const std::map<std::string, std::size_t> expected = {{"M3", 2},    {"S", 2},   {"T", 1},  {"M8", 1},
                                                       {"G64 Q", 1}, {"M0", 1},  {"M1", 1}, {"M5", 1},
                                                       {"M9", 1},    {"M84", 1}, {"M18", 1}};
  EXPECT_EQ(program.accepted, expected);
  ASSERT_EQ(program.motions.size(), 3U) << "M0 and M1 stop";
  EXPECT_EQ(program.motions[0].kind, MotionKind::kDwell);
  EXPECT_EQ(program.motions[1].seconds, 0);
  EXPECT_EQ(program.motions[2].line, 11U);
}

TEST(Gcode, PathControlIsModal) {
  const Reading program = read("G1 X1 F60\nG61 X2\nG61.1\nX3\nG64 P0.05\nX4\nG20 G64 P0.1\nX1\nG21 G64\nG2 I1\n");
  const std::vector<std::pair<PathControl, double>> expected = {
      {PathControl::kContinuous, 0},    {PathControl::kExactPath, 0},     {PathControl::kExactStop, 0},
      {PathControl::kContinuous, 0.05}, {PathControl::kContinuous, 2.54}, {PathControl::kContinuous, 0}};
  ASSERT_EQ(program.motions.size(), expected.size() + 1);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(program.motions[i].path_control, expected[i].first) << i;
    EXPECT_DOUBLE_EQ(program.motions[i].tolerance, expected[i].second) << i;
  }
}

TEST(Gcode, EndsAtM2OrM30OrSecondPercent) {
  EXPECT_EQ(read("G0 X1\nM2\nnot G-code").motions.size(), 2U);
  EXPECT_EQ(read("G0 X1\nM30\nG0 X2").motions.size(), 2U);
  EXPECT_EQ(read("%\nG0 X1\n%\n").motions.size(), 2U);
  EXPECT_EQ(read("G0 X1\n%").motions.size(), 2U);
  EXPECT_EQ(read("G0 X1 M2").motions.size(), 2U);
  EXPECT_EQ(read("").motions.size(), 1U);
  EXPECT_EQ(read("\xEF\xBB\xBFG0 X1").motions.size(), 2U);
}

TEST(Gcode, TooLongALineBehindTheLastPercent) {
  const Reading program = read_text("%\nG0 X1\n%\n;" + std::string(kLongestLine, 'x') + "\n");
  EXPECT_EQ(program.refusal(), "4: a line of more than 65535 bytes");
  EXPECT_EQ(program.motions.size(), 1U) << "no end";
}

TEST(Gcode, SkipsDeletedBlocks) { expect_end("G0 X1\n/G0 X2\n / G0 X3\n", 1, 0); }

TEST(Gcode, InchesAndMillimetres) {
  const Reading program = read("G20 G1 X1 F60\nG21 X1\nG20 G91 Y2 F1\n");
  EXPECT_NEAR(program.motions[0].feed, 25.4, 1e-12);
  expect_at(program.motions[0], 25.4, 0);
  EXPECT_NEAR(program.motions[1].feed, 25.4, 1e-12);
  expect_at(program.motions[1], 1, 0);
  expect_at(program.motions[2], 1, 50.8);
}

TEST(Gcode, RotaryAxesAreInDegrees) {
  Machine machine = default_machine();
  machine.axes[2].letter = 'A';
  const Reading program = read_text("G20 G1 A90 F60\nX1 A0\n", machine);
  EXPECT_EQ(program.motions[0].target[2], 90);
  EXPECT_EQ(program.motions[0].feed, 1);
  EXPECT_NEAR(program.motions[1].feed, 25.4, 1e-12);
  EXPECT_EQ(read_text("G1 A90 F0.05", machine).refusal(),
            "1: feed is too small: 0.05 degrees/min, at least 0.06 are possible");
}

TEST(Gcode, RelativeDistances) { expect_end("G91 G0 X1 Y2\nX1\nG90 Y5\nG91 Y-1 Z1", 2, 4, 1); }

TEST(Gcode, ExtruderFollowsDistanceModeUntilM82OrM83) {
  expect_end("G91\nG0 E1\nE1\nG90\nE5", 0, 0, 0, 5);
  expect_end("G91\nG0 E1\nE1", 0, 0, 0, 2);
  expect_end("M83\nG0 X1 E1\nX1 E1", 1, 0, 0, 2);
  expect_end("M82\nG91\nG0 X1 E1\nX1 E1", 2, 0, 0, 1);
  expect_end("M83\nG90\nG0 X1 E1\nX1 E1", 1, 0, 0, 2);
}

TEST(Gcode, G92ShiftsTheOrigin) {
  expect_end("G0 X10\nG92 X2\nG0 X3 Y1", 11, 1);
  expect_end("G0 X10\nG92 X0\nG92.1\nG0 X3", 3, 0);
  expect_end("G0 E10\nG92 E0\nG0 E5", 0, 0, 0, 15);
  expect_end("G20 G0 X1\nG92 X0\nG0 X1", 50.8, 0);
  expect_end("G0 X10\nG92 X0\nG53 G0 X1", 1, 0);
  EXPECT_EQ(refusal("G92"), "1: G92 without an axis word");
  EXPECT_EQ(refusal("G92 G0 X1"), "1: G92 cannot share a line with a motion");
  expect_end("G0 X10\nG92 G80 X2\nG0 X3", 11, 0);
}

TEST(Gcode, CoordinateSystemsAndG53) {
  Machine machine = default_machine();
  machine.axes[0].offsets = {1, 2, 3, 4, 5, 6};
  const auto x_of = [&](const std::string& text) { return read_text(text, machine).motions.back().target[0]; };
  EXPECT_EQ(x_of("G0 X10"), 11);
  EXPECT_EQ(x_of("G55 G0 X10"), 12);
  EXPECT_EQ(x_of("G59 G0 X10"), 16);
  EXPECT_EQ(x_of("G59 G53 G0 X10"), 10);
  EXPECT_EQ(x_of("G53 G0 X10\nX10"), 11);
  EXPECT_EQ(x_of("G53 G1 X10 F60"), 10);
  EXPECT_EQ(x_of("G0 X10\nG92 X0\nG55 X0"), 12);
  EXPECT_EQ(refusal("G91 G53 G0 X1"), "1: G53 with relative distances");
  EXPECT_EQ(refusal("G53 X1"), "1: G53 needs G0 or G1");
}

TEST(Gcode, G28GoesHomeThroughThePoint) {
  Machine machine = default_machine();
  machine.axes[0].home = -5;
  machine.axes[2].home = 30;
  const Reading all = read_text("G0 X1 Y1 Z1 E1\nG28", machine);
  ASSERT_EQ(all.motions.size(), 3U);
  expect_at(all.motions[1], -5, 0, 30, 1);
  const Reading named = read_text("G0 X1 Y1 Z1\nG91 G28 Z4 X0", machine);
  ASSERT_EQ(named.motions.size(), 4U);
  EXPECT_EQ(named.motions[1].kind, MotionKind::kTraverse);
  expect_at(named.motions[1], 1, 1, 5);
  expect_at(named.motions[2], -5, 1, 30);
}

TEST(Gcode, DwellIsInSeconds) {
  const Reading program = read("G4 P0.5");
  EXPECT_EQ(program.motions[0].kind, MotionKind::kDwell);
  EXPECT_EQ(program.motions[0].seconds, 0.5);
  EXPECT_EQ(refusal("G4"), "1: G4 needs P or S, its seconds");
  EXPECT_EQ(refusal("G4 P-1"), "1: 'P-1' must not be negative");
  EXPECT_EQ(refusal("G0 P1"), "1: P without a word that takes it: G2, G3, G4, G5, G10, G64, G82, G89 or M62 to M65");
  EXPECT_EQ(refusal("P1"), refusal("G0 P1")) << "before all motions";
  EXPECT_EQ(refusal("G61 Q1"), "1: Q without G5, G64, G73 or G83");
  EXPECT_EQ(refusal("G1 X1 J5"), "1: J without G2, G3 or G5");
  EXPECT_EQ(refusal("G1 X1 K5"), "1: K without G2 or G3");
  EXPECT_EQ(refusal("G64 P1 Q-1"), "1: 'Q-1' must not be negative");
}

TEST(Gcode, FeedModes) {
  const Reading program = read("G93 G1 X1 F30\nG1 X2 F60\nG0 X5\n");
  EXPECT_EQ(program.motions[0].seconds, 2);
  EXPECT_EQ(program.motions[1].seconds, 1);
  EXPECT_EQ(program.motions[0].feed, 0);
  EXPECT_EQ(refusal("G93 G1 X1 F30\nX2"), "2: under G93 every motion needs an F word");
  EXPECT_EQ(refusal("G1 X1"), "1: motion with feed, but no F word before");
  EXPECT_EQ(refusal("G1 X1 F0"), "1: feed is 0");
  EXPECT_EQ(refusal("F5 G93\nG94 G1 X1"), "2: motion with feed, but no F word before");
  EXPECT_EQ(refusal("G0 X1"), "accepted");
}

TEST(Gcode, ModalMotionAndItsEnd) {
  expect_end("G1 F5\nX1\nF6\nY2", 1, 2);
  EXPECT_EQ(refusal("X1"), "1: axis words without a motion word (G0, G1, G2 or G3)");
  EXPECT_EQ(refusal("G0 X1\nG80 X2"), "2: axis words without a motion word (G0, G1, G2 or G3)");
}

TEST(Gcode, ReadersMove) {
  const Machine machine = default_machine();
  TextLines lines("G0 X1\nX2\nD1\n", "p.ngc");
  Reader first(lines, machine);
  Motion motion;
  ASSERT_TRUE(first.next(motion));
  Reader second(std::move(first));
  EXPECT_EQ(second.file(), "p.ngc");
  ASSERT_TRUE(second.next(motion));
  EXPECT_EQ(motion.target[0], 2) << "it goes on where the other one was";
  TextLines others("G0 X5\n", "other.ngc");
  Reader third(others, machine);
  third = std::move(second);
  for (int twice = 0; twice < 2; ++twice) {
    EXPECT_FALSE(third.next(motion));
    ASSERT_TRUE(third.error()) << "an error stays";
    EXPECT_EQ(describe(*third.error()), "p.ngc:3: unsupported word 'D1'");
  }
}

TEST(Gcode, ErrorsNameFileAndLine) {
  const Reading program = read_text("G0 X1\n\nG0 D1");
  EXPECT_EQ(program.motions.size(), 1U);
  ASSERT_TRUE(program.error);
  EXPECT_EQ(program.error->code, ErrorCode::kUnsupportedWord);
  EXPECT_EQ(program.error->file, "p.ngc");
  EXPECT_EQ(program.error->line, 3U);
  EXPECT_EQ(program.error->message, "unsupported word 'D1'");
  EXPECT_EQ(describe(*program.error), "p.ngc:3: unsupported word 'D1'");
}

TEST(Gcode, ALineGivesAllOfItsMotionsOrNone) {
  EXPECT_EQ(read_text("G4 P1 X1").motions.size(), 0U);  // the dwell alone would be valid
  EXPECT_EQ(read_text("G0\nG4 P1 X1").motions.size(), 3U);
}

TEST(Gcode, EveryKindOfErrorHasItsCode) {
  using Code = ErrorCode;
  const std::vector<std::pair<const char*, ErrorCode>> programs = {
      {"G0 X1 )", Code::kUnexpectedCharacter},
      {"(", Code::kCommentNotClosed},
      {"(()", Code::kCommentInComment},
      {"X", Code::kMalformedNumber},
      {"X9999999999999", Code::kNumberOutOfRange},
      {"X1e5", Code::kExponent},
      {"%X1", Code::kTextBesidePercent},
      {"G96", Code::kUnsupportedWord},
      {"#1=[", Code::kExpression},
      {"#0=1", Code::kParameter},
      {"G0 O1", Code::kOWord},
      {"M104 S1 G1", Code::kBesideLeftOut},
      {"G43 H1", Code::kNoSuchTool},
      {"G10 L2 P10 X1", Code::kCoordinateSystem},
      {"G93 G81 X1 Z-1 R1 F1", Code::kInverseTime},
      {"G81 X1 Z1 R0 F1", Code::kCycleLevels},
      {"G83 X1 Z-9999 R0 Q0.001 F1", Code::kTooManyMotions},
      {"G38.2 X1 F1", Code::kNoProbe},
      {"G0 G1", Code::kModalGroupTwice},
      {"G0 X1 X1", Code::kLetterTwice},
      {"F-1", Code::kNegative},
      {"N1.5", Code::kNotWhole},
      {"G0 N1", Code::kLineNumberNotFirst},
      {"G0 B1", Code::kNoSuchAxis},
      {"G28 G0 X1", Code::kTwoUsesOfAxisWords},
      {"G0 P1", Code::kUnusedWord},
      {"G4", Code::kMissingWord},
      {"G92", Code::kMissingWord},
      {"X1", Code::kNoMotionMode},
      {"G53 X1", Code::kMachineCoordinates},
      {"G1 X1", Code::kNoFeed},
      {"G1 X1 F0", Code::kFeedTooSmall},
      {"G2 I0 F1", Code::kArcRadiusZero},
      {"G2 X9 R1 F1", Code::kArcRadiusTooSmall},
      {"G2 R1 F1", Code::kArcRadiusFullCircle},
      {"G2 X1 R1 I1 F1", Code::kArcRadiusAndCentre},
      {"G2 X1 F1", Code::kArcNoCentre},
      {"G2 X1 I9 F1", Code::kArcOffCircle},
      {"G2 X1 K1 F1", Code::kArcOutsidePlane},
      {"G2 X2 I1 P1.5 F1", Code::kArcTurns},
      {"G2 X2 I1 P0 F1", Code::kArcTurns},
      {"G2 X2 I1 P10001 F1", Code::kArcTurns},
  };
  for (const auto& [text, code] : programs) {
    const Reading program = read_text(text);
    ASSERT_TRUE(program.error) << text;
    EXPECT_EQ(program.error->code, code) << text << ": " << program.error->message;
  }
}

TEST(Gcode, StartsWhereTheMachineStands) {
  const Reading program = read_text("G91 G0 X1", default_machine(), {10, 20});
  expect_at(program.motions[0], 11, 20);
}

TEST(Gcode, ReadsTheExamples) {
  for (const char* name : {"part", "inch", "relative", "extruder"}) {
    const Reading program = read_file(std::string(TRAMMEL_EXAMPLES_DIR "/") + name + ".ngc");
    EXPECT_GT(program.motions.size(), 8U) << name;
  }
}

#ifdef TRAMMEL_SHARED_GCODE_DIR
std::string shared(const std::string& name) { return TRAMMEL_SHARED_GCODE_DIR "/" + name + ".gcode"; }

TEST(GcodeShared, OctocatEndsWhereItSays) {
  const Reading program = read_file(shared("octocat"));
  expect_at(program.motions.back(), 5, 5, 37.4, 2644.55913);
  EXPECT_EQ(program.motions.size(), 25570U);
}

TEST(GcodeShared, AcceptsWhatLinuxcncAccepts) {
  for (const char* name : {"jsdc-laser", "tball", "arc-xz-plane", "arc-yz-plane", "g2-arc", "circle-inch"}) {
    EXPECT_FALSE(read_file(shared(name)).error) << name;
  }
}

TEST(GcodeShared, RefusesWhatLinuxcncRefuses) {
  const auto line_of = [](const char* name) {
    const Reading program = read_file(shared(name));
    return program.error ? program.error->line : 0;
  };
  EXPECT_EQ(line_of("circle-diamond-square"), 624U);
  EXPECT_EQ(line_of("full-circle-without-xyz"), 11U);
}
#endif

}  // namespace
}  // namespace trammel::gcode
