// Words, codes, programs and jogs: lines and Grbl 1.1h's answers.
#include "answers.hpp"

namespace trammel::grbl {
namespace {

TEST(Block, LettersWithoutACommand) {
  expect_answers({{"I1", 36}, {"J1 G0 X1", 36}, {"K1", 36}, {"P1", 36}, {"L1", 36}, {"R1", 36}});
}

TEST(Block, LineNumbersSpeedsAndTools) {
  expect_answers({{"N1", 0},
                  {"N10 G0 X1", 0},
                  {"N-1", 4},
                  {"N10000000", 0},
                  {"N10000001", 27},
                  {"N99999999", 27},
                  {"N1 N2", 25},
                  {"N1.5", 0},
                  {"S100", 0},
                  {"S-1", 4},
                  {"S100 S200", 25},
                  {"T1", 0},
                  {"T-1", 4},
                  {"T255", 0},
                  {"T256", 38},
                  {"T1.5", 0},
                  {"T1000", 38},
                  {"T1 T2", 25}});
}

TEST(Block, NumbersAndLetters) {
  expect_answers({{"X1 X2", 25},
                  {"G0 X1 X2", 25},
                  {"F1 F2", 25},
                  {"Z", 2},
                  {"G0 X", 2},
                  {"G0 X-", 2},
                  {"G0 X.", 2},
                  {"G0 X1.", 0},
                  {"G0 X.5", 0},
                  {"G0 X-.5", 0},
                  {"G0 X+1", 0},
                  {"G0 X--1", 2},
                  {"G0 X1.2.3", 1},
                  {"G0 X1E3", 20},
                  {"G0 X1e3", 20},
                  {"A1", 20},
                  {"G0 A1", 20},
                  {"B1", 20},
                  {"C1", 20},
                  {"D1", 20},
                  {"E1", 20},
                  {"G0 X1 E1", 20},
                  {"H1", 20},
                  {"O100", 20},
                  {"O100 G0 X1", 20},
                  {"Q1", 20},
                  {"U1", 20},
                  {"V1", 20},
                  {"W1", 20},
                  {"1", 1},
                  {"-1", 1},
                  {"#1=2", 1},
                  {"G0 X#1", 2},
                  {"G0 X[1]", 2},
                  {"=", 1},
                  {"*", 1},
                  {"G0 X1 * 50", 1},
                  {"\"", 1},
                  {"G0X1Y2Z3", 0},
                  {"g0 x1 y2", 0},
                  {"G0 X 1", 0},
                  {"G 0 X1", 0},
                  {"/G0 X1", 0},
                  {"G0 (comment) X1", 0},
                  {"(comment)", 0},
                  {";comment", 0},
                  {"G0 X1 ;comment", 0},
                  {"G0 X1 (unclosed", 0}});
}

TEST(Block, CodesThatGrblLacks) {
  expect_answers({{"G5 X1 Y1", 20},
                  {"G5", 20},
                  {"G5.1 X1", 20},
                  {"G6", 20},
                  {"G7", 20},
                  {"G8", 20},
                  {"G12", 20},
                  {"G33 Z1 K1", 20},
                  {"G50", 20},
                  {"G51", 20},
                  {"G52 X1", 20},
                  {"G59.5", 23},
                  {"G64 P0.1", 20},
                  {"G68", 20},
                  {"G73 X1", 20},
                  {"G76", 20},
                  {"G81 X1 Z-1 R1", 20},
                  {"G83", 20},
                  {"G95", 20},
                  {"G96", 20},
                  {"G97", 20},
                  {"G98", 20},
                  {"G99", 20},
                  {"G100", 20},
                  {"G255", 20},
                  {"G1000", 20},
                  {"G-1", 20},
                  {"G-1 X1", 20}});
}

TEST(Block, DecimalsInCodes) {
  expect_answers({{"G0.1 X1", 23},       {"G0.5", 23},          {"G1.5 X1 F100", 23},  {"G1.01 X1 F100", 23},
                  {"G1.001 X1 F100", 0}, {"G1.004 X1 F100", 0}, {"G1.005 X1 F100", 0}, {"G1.006 X1 F100", 23},
                  {"G4.1 P1", 23},       {"G17.1", 23},         {"G20.5", 23},         {"G40.1", 23},
                  {"G54.1", 23},         {"G54.1 P1", 23},      {"G55.2", 23},         {"G80.1", 23},
                  {"G90.2", 20},         {"G91.2", 20},         {"G93.1", 23},         {"G94.2", 23},
                  {"G53.1 X1", 23},      {"G00 X1", 0},         {"G01 X1 F100", 0},    {"G02 X2 I1 F100", 0},
                  {"G0000 X1", 0}});
}

TEST(Block, ProgramSpindleAndCoolant) {
  expect_answers({{"M0", 0},
                  {"M1", 0},
                  {"M2", 0},
                  {"M3", 0},
                  {"M3 S1000", 0},
                  {"M4", 0},
                  {"M5", 0},
                  {"M3 M5", 21},
                  {"M3 M4", 21},
                  {"M6", 20},
                  {"M6 T1", 20},
                  {"M7", 0},
                  {"M8", 0},
                  {"M7 M8", 0},  // error 21 in Grbl
                  {"M7 M8 M9", 21},
                  {"M7 M8 M7", 21},
                  {"M8 M9", 21},
                  {"M7 M9", 21},
                  {"M9", 0},
                  {"M8 M8", 21},
                  {"M10", 20},
                  {"M30", 0},
                  {"M30 M0", 21},
                  {"M0 M2", 21},
                  {"M0 M1", 21},
                  {"M2 G0 X1", 0},
                  {"M48", 20},
                  {"M49", 20},
                  {"M56", 20},
                  {"M56 P0", 20},
                  {"M60", 20},
                  {"M61", 20},
                  {"M82", 20},
                  {"M83", 20},
                  {"M84", 20},
                  {"M98 P1", 20},
                  {"M99", 20},
                  {"M104 S200", 20},
                  {"M106", 20},
                  {"M0.1", 23},
                  {"M3.5", 23},
                  {"M255", 20},
                  {"M3 S1000 G1 X1 F100", 0},
                  {"M3 S-1", 4},
                  {"M3 P1", 36},
                  {"M5 X1", 0}});
}

TEST(Block, UnusedWords) {
  expect_answers({{"G0 X1 P1", 36},
                  {"G0 X1 L1", 36},
                  {"G0 X1 R1", 36},
                  {"G0 X1 I1", 36},
                  {"G0 X1 J1 K1", 36},
                  {"G0 X1 T1 S1 F1 N1", 0},
                  {"G17 G2 X1 Y1 I1 F100", 0},
                  {"G17 G3 X1 Y1 J1 F100", 0},
                  {"G17 G3 X1 Y1 I0.5 J0.5 F100", 0},
                  {"G10 L2 P1 X1 I1", 36},
                  {"G10 L2 P1 X1 F100", 0},
                  {"G28 I1", 36},
                  {"G92 X1 P1", 36},
                  {"G92 X1 I1", 36}});
}

TEST(Block, SeveralCommandsOfALine) {
  expect_answers({{"G55 G10 L2 P0 X3", 0},
                  {"G0 X1 G55", 0},
                  {"G54 G55 G0 X1", 21},
                  {"G21 G90 G94 G17 G54 G40 G49", 0},
                  {"G21 G90 G94 G17 G54 G40 G49 G80", 0},
                  {"G21G90G40G49G80G94G17", 0},
                  {"G0 G21 G90 X1", 0},
                  {"G94 G93", 21}});
}

TEST(Block, Jogs) {
  expect_answers({{"$J=X1 F100", 0},
                  {"$J=X1", 22},
                  {"$J=G91 X1 F100", 0},
                  {"$J=G90 X1 F100", 0},
                  {"$J=G20 X1 F10", 0},
                  {"$J=G21 X1 F10", 0},
                  {"$J=G53 X1 F100", 0},
                  {"$J=G91 G53 X1 F100", 0},
                  {"$J=G1 X1 F100", 16},
                  {"$J=G0 X1 F100", 16},
                  {"$J=G2 X2 I1 F100", 16},
                  {"$J=G94 X1 F100", 16},
                  {"$J=G93 X1 F100", 16},
                  {"$J=G54 X1 F100", 16},
                  {"$J=G17 X1 F100", 16},
                  {"$J=M3 X1 F100", 16},
                  {"$J=M8 X1 F100", 16},
                  {"$J=X1 F100 S100", 36},
                  {"$J=X1 F100 T1", 36},
                  {"$J=X1 F100 N5", 0},
                  {"$J=X1 F100 P1", 36},
                  {"$J=X1 F100 I1", 36},
                  {"$J=X1 F100 R1", 36},
                  {"$J=X1 F100 L1", 36},
                  {"$J=X1 F0", 22},
                  {"$J=X1 F-1", 4},
                  {"$J=X1 X2 F100", 25},
                  {"$J=A1 F100", 20},
                  {"$J=G28 F100", 16},
                  {"$J=G28 X1 F100", 16},
                  {"$J=G4 P1 F100", 16},
                  {"$J=G4 P1 X1 F100", 16},
                  {"$J=G92 X1 F100", 16},
                  {"$J=G10 L2 P1 X1 F100", 16},
                  {"$J=G43.1 Z1 F100", 16},
                  {"$J=G49 X1 F100", 16},
                  {"$J=G80 X1 F100", 31},
                  {"$J=G40 X1 F100", 16},
                  {"$J=G61 X1 F100", 16},
                  {"$J=G91.1 X1 F100", 16},
                  {"$J=G38.2 X1 F100", 16},
                  {"$J=", 22},
                  {"$J=X F100", 2},
                  {"$J=G90 G91 X1 F100", 21},
                  {"$J=G91", 22},
                  {"$J=M0 X1 F100", 16},
                  {"$J=G92.1 X1 F100", 16},
                  {"$J=G28.1 X1 F100", 16},
                  {"G93|$J=X1 F100", 0},
                  {"G93|$J=X1", 22},
                  {"F100|$J=X1", 22},
                  {"G80|$J=X1 F100", 0},
                  {"G2 X2 I1 F100|$J=X1 F100", 0},
                  {"G20|$J=X1 F100", 0}});
}

// Deliberate differences from Grbl's answers.
TEST(Block, DiffersFromGrbl) {
  expect_answers({
      {"$J=F100", 26},           // Grbl accepts it and jogs to the machine's 0,0,0
      {"G93 G38.2 X1 F5", 22},   // a probing motion has a feed, not a time
      {"G2 X0 Z2 R1 F100", 33},  // Grbl divides by the distance in the plane, which is 0
      {"G256", 20},
      {"M256", 20},
      {"M1000", 20},  // Grbl stores codes in a byte
  });
}

TEST(Block, TakesTheLettersOfTheMachinesAxes) {
  machine::Machine machine = router();
  machine.axes.push_back(router_axis('A'));
  Interpreter interpreter(machine, router_card());
  EXPECT_EQ(answer_of(interpreter, "G0 X1 A90"), 0);
  EXPECT_EQ(interpreter.place()[3], 90);
  EXPECT_EQ(answer_of(interpreter, "G0 B1"), 20);
  EXPECT_EQ(answer_of(interpreter, "G92 A0"), 0);
  EXPECT_EQ(interpreter.work_offset()[3], 90);
  EXPECT_EQ(answer_of(interpreter, "$J=A10 F100"), 0);
  EXPECT_EQ(interpreter.place()[3], 100);
}

}  // namespace
}  // namespace trammel::grbl
