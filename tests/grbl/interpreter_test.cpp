// Effects of a program's lines: offsets, places, the state that a reset keeps, and soft limits.
#include "trammel/grbl/interpreter.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "router.hpp"
#include "trammel/grbl/input_buffer.hpp"

namespace trammel::grbl {
namespace {

using testing::ElementsAre;

class GrblInterpreter : public testing::Test {
 protected:
  explicit GrblInterpreter(machine::Machine machine = router()) : machine_(std::move(machine)) {}

  Status read(const std::string& line) { return interpreter_.read(cleaned(line), block_); }
  Status jog(const std::string& line) { return interpreter_.read_jog(cleaned(line), block_); }
  // Reads lines, all of which must be accepted.
  void read_all(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) EXPECT_EQ(read(line), Status::kOk) << line;
  }
  static std::vector<double> xyz(const gcode::Coordinates& at) {
    std::vector<double> values;
    for (std::size_t n = 0; n < 3; ++n) values.push_back(std::round(at[n] * 1e6) / 1e6);
    return values;
  }
  std::vector<double> place() const { return xyz(interpreter_.place()); }
  std::vector<double> work() const {
    gcode::Coordinates at = interpreter_.place();
    const gcode::Coordinates offset = interpreter_.work_offset();
    for (std::size_t n = 0; n < at.size(); ++n) at[n] -= offset[n];
    return xyz(at);
  }
  std::vector<double> offset(int kind) const { return xyz(interpreter_.offset(kind)); }
  std::string modes() const { return parser_state(interpreter_.modal(), false); }

  machine::Machine machine_;
  Interpreter interpreter_{machine_, router_card()};
  Block block_;
};

class FencedInterpreter : public GrblInterpreter {
 protected:
  FencedInterpreter() : GrblInterpreter(fenced_router()) {}
};

TEST_F(GrblInterpreter, BeginsWithGrblsModes) {
  EXPECT_EQ(modes(), "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]");
  EXPECT_THAT(place(), ElementsAre(0, 0, 0));
  EXPECT_THAT(work(), ElementsAre(0, 0, 0));
}

TEST_F(GrblInterpreter, ShowsAllModes) {
  read_all({"G59 G18 G20 G91 M4 M7 T7 F10 S12000 G38.3 Z-1"});
  EXPECT_EQ(modes(), "[GC:G38.3 G59 G18 G20 G91 G94 M4 M7 T7 F254 S12000]");
  EXPECT_EQ(parser_state(interpreter_.modal(), true), "[GC:G38.3 G59 G18 G20 G91 G94 M4 M7 T7 F10.0 S12000]");
  read_all({"M8 G93 G80"});
  EXPECT_EQ(modes(), "[GC:G80 G59 G18 G20 G91 G93 M4 M7 M8 T7 F0 S12000]");
  read_all({"M9"});
  EXPECT_EQ(modes(), "[GC:G80 G59 G18 G20 G91 G93 M4 M9 T7 F0 S12000]");
}

TEST_F(GrblInterpreter, MovesInEachCoordinateSystem) {
  for (int n = 1; n <= 6; ++n) {
    read_all({fmt::format("G10 L2 P{} X{} Z{}", n, 10 * n, -n), fmt::format("G{} G0 X1 Z1", 53 + n)});
    EXPECT_THAT(offset(53 + n), ElementsAre(10 * n, 0, -n));
    EXPECT_THAT(place(), ElementsAre(10 * n + 1, 0, 1 - n));
    EXPECT_THAT(work(), ElementsAre(1, 0, 1));
  }
}

TEST_F(GrblInterpreter, SetsAnotherSystemWithoutTouchingTheOneInForce) {
  read_all({"G0 X5", "G10 L2 P2 X3", "G10 L20 P3 X1 Y2"});
  EXPECT_THAT(work(), ElementsAre(5, 0, 0));
  EXPECT_THAT(offset(55), ElementsAre(3, 0, 0));
  EXPECT_THAT(offset(56), ElementsAre(4, -2, 0));
  read_all({"G56"});
  EXPECT_THAT(work(), ElementsAre(1, 2, 0));
}

TEST_F(GrblInterpreter, SetsTheSystemInForceByP0) {
  read_all({"G0 X5 Y5", "G55", "G10 L20 P0 X1"});
  EXPECT_THAT(offset(55), ElementsAre(4, 0, 0));
  EXPECT_THAT(offset(54), ElementsAre(0, 0, 0));
  read_all({"G10 L2 P0 Y2"});
  EXPECT_THAT(offset(55), ElementsAre(4, 2, 0)) << "X stays";
}

// Grbl: WPos = MPos - WCS - G92 - TLO.
TEST_F(GrblInterpreter, SetsASystemBeneathG92AndTheToolLength) {
  read_all({"G0 X10 Z10", "G92 X3", "G43.1 Z2", "G10 L20 P1 X1 Z1"});
  EXPECT_THAT(work(), ElementsAre(1, 0, 1));
  EXPECT_THAT(offset(92), ElementsAre(7, 0, 0));
  EXPECT_THAT(offset(54), ElementsAre(2, 0, 7));
}

TEST_F(GrblInterpreter, ShiftsByG92) {
  read_all({"G10 L2 P1 X100", "G0 X10", "G92 X0 Y5"});
  EXPECT_THAT(work(), ElementsAre(0, 5, 0));
  EXPECT_THAT(place(), ElementsAre(110, 0, 0));
  EXPECT_THAT(offset(92), ElementsAre(10, -5, 0));
  read_all({"G92 Z1"});
  EXPECT_THAT(offset(92), ElementsAre(10, -5, -1)) << "axes that are not named keep theirs";
  read_all({"G55"});
  EXPECT_THAT(work(), ElementsAre(100, 5, 1)) << "in every system";
  read_all({"G92.1"});
  EXPECT_THAT(work(), ElementsAre(110, 0, 0));
  EXPECT_THAT(offset(92), ElementsAre(0, 0, 0));
}

TEST_F(GrblInterpreter, HasTheToolLengthInItsMoves) {
  read_all({"G43.1 Z5", "G0 Z1"});
  EXPECT_THAT(place(), ElementsAre(0, 0, 6));
  EXPECT_THAT(work(), ElementsAre(0, 0, 1));
  read_all({"G20 G43.1 Z1"});
  EXPECT_NEAR(interpreter_.modal().tool_length, 25.4, 1e-9);
  read_all({"G21 G49"});
  EXPECT_THAT(work(), ElementsAre(0, 0, 6));
}

TEST_F(GrblInterpreter, GoesToPredefinedPlaces) {
  read_all({"G0 X1 Y2 Z3", "G28.1", "G0 X-1 Y-2 Z-3", "G30.1", "G0 X7 Y7 Z7"});
  EXPECT_THAT(offset(28), ElementsAre(1, 2, 3));
  EXPECT_THAT(offset(30), ElementsAre(-1, -2, -3));
  read_all({"G28"});
  EXPECT_THAT(place(), ElementsAre(1, 2, 3));
  read_all({"G30 Z5"});
  EXPECT_THAT(place(), ElementsAre(1, 2, -3)) << "the named axis alone";
  EXPECT_NE(block_.text.find("G30"), std::string::npos);
  read_all({"G0 X0 Y0 Z0", "G91 G28 Y0"});
  EXPECT_THAT(place(), ElementsAre(0, 2, 0));
}

// Places are kept in machine coordinates, independent of offsets. G28.1 keeps the place before the line's own motion.
TEST_F(GrblInterpreter, KeepsPredefinedPlacesInMachineCoordinates) {
  read_all({"G10 L2 P1 X50", "G92 Y3", "G0 X1", "G28.1 X9"});
  EXPECT_THAT(offset(28), ElementsAre(51, 0, 0));
  EXPECT_THAT(place(), ElementsAre(59, 0, 0));
}

TEST_F(GrblInterpreter, MovesInMachineCoordinatesByG53) {
  read_all({"G10 L2 P1 X50 Z5", "G43.1 Z1", "G92 Y3", "G53 G0 X1 Y1 Z1"});
  EXPECT_THAT(place(), ElementsAre(1, 1, 1));
  read_all({"G91 G53 X2", "G0 X1"});
  EXPECT_THAT(place(), ElementsAre(3, 1, 1)) << "under G91, too";
  EXPECT_FALSE(interpreter_.modal().absolute);
}

TEST_F(GrblInterpreter, ReadsInches) {
  read_all({"G20 G0 X1 Y-0.5", "G1 F10"});
  EXPECT_THAT(place(), ElementsAre(25.4, -12.7, 0));
  EXPECT_NEAR(interpreter_.modal().feed, 254, 1e-9);
  read_all({"G91 X1", "G21 X1", "G20 G10 L2 P1 X1"});
  EXPECT_THAT(place(), ElementsAre(51.8, -12.7, 0));
  EXPECT_THAT(offset(54), ElementsAre(25.4, 0, 0));
}

TEST_F(GrblInterpreter, JogsWithoutChangingModes) {
  read_all({"G91 G20 F5 G2 X1 I0.5"});
  const std::string before = modes();
  EXPECT_EQ(jog("G90 G21 X1 Y2 F1000"), Status::kOk);
  EXPECT_THAT(place(), ElementsAre(1, 2, 0));
  EXPECT_EQ(jog("X1 F10"), Status::kOk);
  EXPECT_THAT(place(), ElementsAre(26.4, 2, 0)) << "in inches, relative";
  EXPECT_EQ(jog("G21 G53 X3 F1000"), Status::kOk);
  EXPECT_THAT(place(), ElementsAre(3, 2, 0)) << "G53 is absolute";
  EXPECT_EQ(modes(), before);
}

TEST_F(GrblInterpreter, ResetForgetsWhatGrblForgets) {
  read_all({"G10 L2 P2 X5", "G0 X1 Y2 Z3", "G28.1", "G92 X100", "G43.1 Z4", "G55 G20 G91 G18 M3 M8 S100 F10 T3"});
  const gcode::Coordinates stands = interpreter_.place();
  interpreter_.reset();
  EXPECT_EQ(modes(), "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]");
  EXPECT_THAT(offset(92), ElementsAre(0, 0, 0));
  EXPECT_EQ(interpreter_.modal().tool_length, 0);
  EXPECT_THAT(offset(55), ElementsAre(5, 0, 0)) << "kept";
  EXPECT_THAT(offset(28), ElementsAre(1, 2, 3)) << "kept";
  EXPECT_EQ(interpreter_.place(), stands);
  EXPECT_THAT(work(), ElementsAre(1, 2, 3));
}

TEST_F(GrblInterpreter, ProgramEndBringsBackSomeModes) {
  read_all({"G55 G20 G91 G93 G19 M4 M7 S100 T3 G0 X1", "G92 X0", "G43.1 Z1", "M30"});
  EXPECT_EQ(modes(), "[GC:G1 G54 G17 G20 G90 G94 M5 M9 T3 F0 S100]");
  EXPECT_THAT(offset(92), ElementsAre(25.4, 0, 0)) << "kept";
  EXPECT_NEAR(interpreter_.modal().tool_length, 25.4, 1e-9) << "kept";
  read_all({"G1 F1 X0", "M2"});
  EXPECT_NEAR(interpreter_.modal().feed, 25.4, 1e-9) << "kept";
}

TEST_F(GrblInterpreter, ChangesNothingByALineThatItRefuses) {
  read_all({"G0 X1 F100"});
  const std::string before = modes();
  for (const char* const line : {"G55 G91 M3 S500 F7 G1 X5 X6", "G20 G2 X3 I9 F5", "G10 L2 P9 X1", "M3 G18 P1"}) {
    EXPECT_NE(read(line), Status::kOk) << line;
    EXPECT_EQ(modes(), before) << line;
    EXPECT_THAT(place(), ElementsAre(1, 0, 0)) << line;
  }
  EXPECT_NE(jog("X5"), Status::kOk);
  EXPECT_THAT(place(), ElementsAre(1, 0, 0));
}

TEST_F(GrblInterpreter, StandsWhereTheMachineStands) {
  read_all({"G10 L2 P1 X10", "G0 X5"});
  interpreter_.stand({7, 8, 9});
  EXPECT_THAT(work(), ElementsAre(-3, 8, 9));
  read_all({"G91 G0 X1"});
  EXPECT_THAT(place(), ElementsAre(8, 8, 9));
}

TEST_F(GrblInterpreter, TakesKeptOffsets) {
  interpreter_.set_parameters({{5221, 3}, {5242, 4}, {5161, 5}, {31, 9}});
  EXPECT_THAT(offset(54), ElementsAre(3, 0, 0));
  EXPECT_THAT(offset(55), ElementsAre(0, 4, 0));
  EXPECT_THAT(offset(28), ElementsAre(5, 0, 0));
  EXPECT_EQ(interpreter_.parameters().count(31), 0U) << "no parameter of Grbl's";
}

TEST(GrblInterpreterOffsets, BeginWithThoseOfTheMachineFile) {
  machine::Machine machine = router();
  machine.axes[0].offsets[1] = 12;
  machine.axes[2].home = -3;
  const Interpreter interpreter(machine, router_card());
  EXPECT_EQ(interpreter.offset(55)[0], 12);
  EXPECT_EQ(interpreter.offset(28)[2], -3);
}

TEST_F(FencedInterpreter, RefusesWhatLeavesTheSoftLimits) {
  read_all({"G0 X-10 F100", "G1 X0", "G1 X-200 Y-200", "G55"});
  const std::string before = modes();
  for (const char* const line :
       {"G0 X0.1", "G1 X-200.1 G54", "G53 G0 Z1", "G91 G0 Y-1", "G2 X-200 Y-180 J10", "G4 P0 X1", "G38.2 Z3 G91"}) {
    EXPECT_EQ(read(line), Status::kTravelExceeded) << line;
    EXPECT_EQ(modes(), before) << line;
    EXPECT_THAT(place(), ElementsAre(-200, -200, 0)) << line;
  }
  EXPECT_EQ(jog("X1 F100"), Status::kTravelExceeded);
  EXPECT_THAT(place(), ElementsAre(-200, -200, 0));
}

TEST_F(FencedInterpreter, ChecksTheMachinesCoordinates) {
  read_all({"G10 L2 P1 X-100"});
  EXPECT_EQ(read("G0 X50"), Status::kOk);
  EXPECT_EQ(read("G0 X101"), Status::kTravelExceeded);
  EXPECT_EQ(read("G0 X-101"), Status::kTravelExceeded);
  EXPECT_THAT(place(), ElementsAre(-50, 0, 0));
}

}  // namespace
}  // namespace trammel::grbl
