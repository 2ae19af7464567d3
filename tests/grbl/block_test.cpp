// Lines and the number that Grbl 1.1h answers them with, 0 for ok.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <sstream>
#include <string>

#include "router.hpp"
#include "trammel/grbl/input_buffer.hpp"
#include "trammel/grbl/interpreter.hpp"

namespace trammel::grbl {
namespace {

// `lines`: with '|' between them. All but the last are accepted and make the state that the last one meets.
struct Answer {
  const char* lines;
  int error;
};

int answer_of(Interpreter& interpreter, const std::string& line) {
  const std::string text = cleaned(line);
  Block block;
  if (text.empty()) return 0;
  const bool jog = text.rfind("$J=", 0) == 0;
  return static_cast<int>(jog ? interpreter.read_jog(text.substr(3), block) : interpreter.read(text, block));
}

void expect_answers(std::initializer_list<Answer> answers) {
  const machine::Machine machine = router();
  for (const auto& [lines, error] : answers) {
    SCOPED_TRACE(lines);
    Interpreter interpreter(machine, router_card());
    std::istringstream parts(lines);
    std::string line;
    std::getline(parts, line, '|');
    for (std::string next; std::getline(parts, next, '|'); line = next) {
      EXPECT_EQ(answer_of(interpreter, line), 0) << line;
    }
    EXPECT_EQ(answer_of(interpreter, line), error);
  }
}

TEST(Block, MotionAndItsAxisWords) {
  expect_answers({{"G0 X1", 0},
                  {"G1 X1", 22},
                  {"G1 X1 F100", 0},
                  {"G1 F100", 0},
                  {"G1", 22},
                  {"G2", 22},
                  {"G0", 0},
                  {"F100|X1", 0},
                  {"X1", 0},
                  {"G80|X1", 31},
                  {"G80 X1", 31},
                  {"G80", 0},
                  {"G80|G92 X1", 31},
                  {"G80|G43.1 Z1", 31},
                  {"G80|G10 L2 P1 X1", 31},
                  {"G80|G28 X1", 31},
                  {"G80|G28", 0},
                  {"G80|G92.1", 0}});
}

TEST(Block, ModalGroups) {
  expect_answers({{"G0 G1 X1", 24},
                  {"G0 G1", 24},
                  {"G0 G80", 21},
                  {"G17 G18", 21},
                  {"G20 G21", 21},
                  {"G90 G91", 21},
                  {"G90 G91.1", 0},
                  {"G91.1", 0},
                  {"G90.1", 20},
                  {"G93 G94", 21},
                  {"G40 G40", 21},
                  {"G40", 0},
                  {"G41", 20},
                  {"G42", 20}});
}

TEST(Block, ToolLength) {
  expect_answers({{"G43", 20},
                  {"G43 Z1", 20},
                  {"G43.1 Z1", 0},
                  {"G43.1", 37},
                  {"G43.1 X1", 37},
                  {"G43.1 X1 Z1", 37},
                  {"G43.1 Y1", 37},
                  {"G43.2 Z1", 20},
                  {"G49", 0},
                  {"G49 Z1", 0},
                  {"G49 X1", 0},
                  {"G49.1", 0},
                  {"G43.1 Z1 G49", 24},
                  {"G49 G0 X1", 24},
                  {"G43.1 Z1 G0", 24},
                  {"G0 G43.1 Z1", 24},
                  {"G43.1 Z1 G92 X1", 24}});
}

TEST(Block, CoordinateSystemsAndPathControl) {
  expect_answers({{"G54 G55", 21},
                  {"G54", 0},
                  {"G59", 0},
                  {"G59.1", 23},
                  {"G59.3", 23},
                  {"G60", 20},
                  {"G61", 0},
                  {"G61.1", 20},
                  {"G64", 20},
                  {"G61 G61", 21}});
}

TEST(Block, Dwells) {
  expect_answers({{"G4", 28},
                  {"G4 P0", 0},
                  {"G4 P0.1", 0},
                  {"G4 P-1", 4},
                  {"G4 X1 P0", 0},
                  {"G4 S1", 28},
                  {"G4 P1 G0 X1", 0},
                  {"G4 G53 P1", 21},
                  {"G4 P0 F100", 0}});
}

TEST(Block, OffsetData) {
  expect_answers({{"G10", 26},
                  {"G10 L2", 26},
                  {"G10 L2 P1", 26},
                  {"G10 L2 X1", 0},
                  {"G10 P1 X1", 20},
                  {"G10 L2 P1 X1", 0},
                  {"G10 L20 P1 X1", 0},
                  {"G10 L20 P0 X1", 0},
                  {"G10 L2 P0 X1", 0},
                  {"G10 L2 P6 X1", 0},
                  {"G10 L2 P7 X1", 29},
                  {"G10 L2 P6.5 X1", 0},
                  {"G10 L2 P-1 X1", 4},
                  {"G10 L1 P1 X1", 20},
                  {"G10 L20 P7 X1", 29},
                  {"G10 L2 P1 R1 X1", 20},
                  {"G10 L20 P1 R1 X1", 36},
                  {"G10 L2 P1 X1 G0", 24},
                  {"G10 L2.5 P1 X1", 0},
                  {"G10 X1", 28},
                  {"G10.1 L2 P1 X1", 23}});
}

TEST(Block, PredefinedPlaces) {
  expect_answers({{"G28", 0},
                  {"G28 X1", 0},
                  {"G28.1", 0},
                  {"G28.2", 20},
                  {"G28 G30", 24},
                  {"G28 G0 X1", 24},
                  {"G28.1 X1", 0},
                  {"F100 G1|G28.1 X1", 0},
                  {"G28 G92 X1", 24},
                  {"G30", 0},
                  {"G30.1", 0},
                  {"G30.5", 20},
                  {"G30 Z1", 0}});
}

TEST(Block, Probes) {
  expect_answers({{"G38", 20},
                  {"G38.1 X1", 20},
                  {"G38.2 X1", 22},
                  {"G38.2 X1 F100", 0},
                  {"G38.2 F100", 26},
                  {"G38.3 X1 F100", 0},
                  {"G38.4 Z-1 F100", 0},
                  {"G38.5 Z-1 F100", 0},
                  {"G38.6 Z-1 F100", 20},
                  {"G38.2 X0 F100", 33},
                  {"G38.2 G0 X1 F100", 24},
                  {"G93 G38.2 X1", 22},
                  {"F100 G38.2 X5|Z1", 0}});
}

TEST(Block, MachineCoordinates) {
  expect_answers({{"G53", 0},
                  {"G53 X1", 0},
                  {"G53 G0 X1", 0},
                  {"G53 G1 X1 F100", 0},
                  {"G53 G2 X1 I1 F100", 30},
                  {"F100 G2 X2 I1|G53 X1", 30},
                  {"G80|G53", 30},
                  {"G80|G53 X1", 30},
                  {"G53 G80", 30},
                  {"G53 G28", 21},
                  {"G53 G92 X1", 21},
                  {"G53 G38.2 X1 F100", 30}});
}

TEST(Block, Shifts) {
  expect_answers({{"G92", 26},
                  {"G92 X1", 0},
                  {"G92 G0 X1", 24},
                  {"G92.1", 0},
                  {"G92.2", 20},
                  {"G92.3", 20},
                  {"G92.1 X1", 0},
                  {"G92 G92.1 X1", 21},
                  {"G92 G92.1", 21}});
}

TEST(Block, InverseTime) {
  expect_answers({{"G93", 0},
                  {"G93 G1 X1", 22},
                  {"G93 G1 X1 F2", 0},
                  {"G93 G1", 22},
                  {"G93 G1 F2", 0},
                  {"G93 G0 X1", 0},
                  {"F100 G1 X1|G93|X2", 22},
                  {"F100 G93 G1 X1|X2", 22},
                  {"F100 G93 G1 X1|G94 X2", 22},
                  {"F100 G93 G1 X1|G94 X2 F100", 0},
                  {"F100 G93 G1 X1|G94|G1 X2", 22},
                  {"G93 F100|G94|G1 X1", 22},
                  {"G93|M5", 0},
                  {"F100|G93|G94|G1 X1", 22},
                  {"G93 G1 X1 F0", 22},
                  {"G1 X1 F0", 22},
                  {"F0", 0},
                  {"F-1", 4},
                  {"F", 2},
                  {"FX", 2}});
}

TEST(Block, Arcs) {
  expect_answers({{"G2 X1 F100", 35},
                  {"G2 F100", 26},
                  {"G2 X2 F100", 35},
                  {"G2 X2 I1 F100", 0},
                  {"G2 X2 J1 F100", 33},
                  {"G2 X2 K1 F100", 35},
                  {"G2 X2 I1", 22},
                  {"G2 Z1 F100", 32},
                  {"G2 Z1 I1 F100", 32},
                  {"G2 X2 I1 Z1 F100", 0},
                  {"G2 X0 I1 F100", 0},
                  {"G2 X0 Y0 I1 F100", 0},
                  {"G2 I1 F100", 26},
                  {"G2 X2 I2 F100", 33},
                  {"G2 X2 I1.0001 F100", 0},
                  {"G2 X2 I1.002 F100", 0},
                  {"G2 X2 I1.0024 F100", 0},
                  {"G2 X2 I1.0026 F100", 33},
                  {"G2 X10 I5.0026 F100", 33},
                  {"G2 X100 I50.02 F100", 0},
                  {"G2 X100 I50.03 F100", 33},
                  {"G2 X1000 I500.1 F100", 0},
                  {"G2 X1000 I500.3 F100", 33},
                  {"G2 X2 R1 F100", 0},
                  {"G2 X2 R0.5 F100", 34},
                  {"G2 X2 R1 I1 F100", 36},
                  {"G2 X2 R-1 F100", 0},
                  {"G2 X0 R1 F100", 33},
                  {"G2 X0 Y0 R1 F100", 33},
                  {"G2 X2 R0 F100", 34},
                  {"G2 Z2 R1 F100", 32},
                  {"G3 X2 I1 F100", 0},
                  {"G3 X2 I1 K1 F100", 0},
                  {"G3 X2 I1 J0 K0 F100", 0},
                  {"G3 X2 I1 P1 F100", 36},
                  {"G3 X2 I1 L1 F100", 36},
                  {"G2 X2 I1 F100|X4", 35},
                  {"G2 X2 I1 F100|X4 I1", 0},
                  {"G2 X2 I1 F100|I1", 36},
                  {"G2 X2 I1 F100|G0 I1", 36},
                  {"G2 X2 I1 F100|G28", 0},
                  {"G2 X2 I1 F100|M3", 0},
                  {"G2 X2 I1 F100|G4 P0", 0},
                  {"G2 X2 I1 F100|G92 X0", 0},
                  {"G2 X2 I1 F100|G10 L2 P1 X0", 0},
                  {"G2 X2 I1 F100|G43.1 Z1", 0},
                  {"G2 X2 I1 F100|F200", 0}});
}

TEST(Block, ArcsInOtherPlanesAndUnits) {
  expect_answers({{"G18 G2 X2 I1 F100", 0},
                  {"G18 G2 X2 K1 F100", 33},
                  {"G18 G2 Y2 K1 F100", 32},
                  {"G18 G2 Z2 K1 F100", 0},
                  {"G18 G2 X2 J1 F100", 35},
                  {"G18 G2 Z2 X0 R1 F100", 0},
                  {"G19 G2 Y2 J1 F100", 0},
                  {"G19 G2 X2 J1 F100", 32},
                  {"G19 G2 Y2 I1 F100", 35},
                  {"G19 G2 Z2 Y0 R1 F100", 0},
                  {"G20 G2 X2 I1 F10", 0},
                  {"G20 G2 X2 I1.01 F10", 33},
                  {"G20 G1 X1 F10", 0},
                  {"G91 G2 X2 I1 F100", 0},
                  {"G91 G2 X2 R1 F100", 0},
                  {"G91 G38.2 Z-1 F100", 0},
                  {"G91 G1 X1 F100", 0}});
}

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
                  {"M7 M8", 0},  // in Grbl 21
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

// Where this server answers otherwise than Grbl, on purpose.
TEST(Block, DiffersFromGrbl) {
  expect_answers({
      {"$J=F100", 26},           // Grbl accepts it and jogs to the machine's 0,0,0
      {"G93 G38.2 X1 F5", 22},   // a probe has a feed, not a time
      {"G2 X0 Z2 R1 F100", 33},  // Grbl divides by the way's length, which is 0 in the plane
      {"G256", 20},
      {"M256", 20},
      {"M1000", 20},  // Grbl keeps codes in a byte
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
