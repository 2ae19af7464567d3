// Operations as G-code: digits that give the same double again, and the words of each kind of motion.
#include "trammel/linuxcnc/path_line.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "path_bench.hpp"
#include "trammel/gcode/reader.hpp"

namespace trammel::linuxcnc {
namespace {

double read_back(const std::string& number) {
  const machine::Machine machine = machine::default_machine();
  gcode::TextLines lines(number, "p.ngc");
  gcode::Reader reader(lines, machine);
  gcode::Motion motion;
  if (!reader.next(motion)) throw std::logic_error(number);
  return motion.target[0];
}

// The range covers all doubles that a coordinate may have, and the feeds in millimetres.
RC_GTEST_PROP(PathLine, TheReaderGetsTheSameDoubleBack, ()) {
  const double mantissa = static_cast<double>(*rc::gen::arbitrary<std::int64_t>());
  const int exponent = *rc::gen::inRange(-120, -44);
  const double value = std::ldexp(mantissa, exponent);
  RC_ASSERT(read_back("G0 X" + path_number(value) + "\n") == value);
}

RC_GTEST_PROP(PathLine, EveryFiniteNumberHasItsDigits, (double value)) {
  RC_PRE(std::isfinite(value));
  const std::string text = path_number(value);
  RC_ASSERT(text.find_first_not_of("-0123456789.") == std::string::npos);
  RC_ASSERT(std::strtod(text.c_str(), nullptr) == value);
}

TEST(PathLine, ExtremeNumbers) {
  for (const double value : {std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min(), 0.1 + 0.2,
                             5.3710937500000003e-09, -1.0 / 3}) {
    EXPECT_EQ(std::strtod(path_number(value).c_str(), nullptr), value);
  }
  EXPECT_THROW(path_number(std::nan("")), PathRefusal);
}

std::string first_line(const Operations& operations, const Pose& from = {}, PathUnits units = PathUnits::kMillimetres) {
  const trammel_operation& operation = operations.all.front();
  return path_modes(operation, units) + "|" + path_line(operation, from, machine::default_machine());
}

TEST(PathLine, Lines) {
  EXPECT_EQ(first_line(Operations().rapid({1, 2})), "G21 G64|G0 X1 Y2");
  EXPECT_EQ(first_line(Operations().feed({0, 0, -0.125}, 10)), "G21 G64|G1 Z-0.125 F600");
  EXPECT_EQ(first_line(Operations().control(TRAMMEL_BLEND, 0.05).feed({1}, 10)), "G21 G64 P0.05|G1 X1 F600");
  EXPECT_EQ(first_line(Operations().control(TRAMMEL_EXACT_PATH).feed({1}, 10)), "G21 G61|G1 X1 F600");
  EXPECT_EQ(first_line(Operations().control(TRAMMEL_EXACT_STOP).feed({1}, 10)), "G21 G61.1|G1 X1 F600");
  EXPECT_EQ(first_line(Operations().probe({0, 0, -5}, 2)), "G21 G64|G38.3 Z-5 F120");
  EXPECT_EQ(first_line(Operations().feed({1}, 10), {}, PathUnits::kInches), "G20 G64|G1 X1 F600");
  EXPECT_EQ(first_line(Operations().feed({1}, 10), {1}), "G21 G64|");
}

TEST(PathLine, Arcs) {
  EXPECT_EQ(first_line(Operations().arc({2, 0}, {1, 0, 0}, 2, -1, 10)), "G21 G64|G17 G2 X2 Y0 I1 J0 F600");
  EXPECT_EQ(first_line(Operations().arc({2, 0, 3}, {1, 0, 0}, 2, 0, 10)), "G21 G64|G17 G3 X2 Y0 Z3 I1 J0 F600");
  EXPECT_EQ(first_line(Operations().arc({2, 0}, {1, 0, 0}, 2, -3, 10)), "G21 G64|G17 G2 X2 Y0 I1 J0 P3 F600");
  EXPECT_EQ(first_line(Operations().arc({}, {1, 0, 0}, 2, 1, 10)), "G21 G64|G17 G3 X0 Y0 I1 J0 P2 F600");
  EXPECT_EQ(first_line(Operations().arc({0, 0, 2}, {0, 0, 1}, 1, 0, 10)), "G21 G64|G18 G3 X0 Z2 K1 I0 F600");
  EXPECT_EQ(first_line(Operations().arc({0, 2}, {0, 1, 0}, 0, 0, 10)), "G21 G64|G19 G3 Y2 Z0 J1 K0 F600");
  Operations below;
  below.arc({2, 0}, {1, 0, 0}, 2, -1, 10);
  below.all.front().normal[2] = -1;
  EXPECT_EQ(first_line(below), "G21 G64|G17 G3 X2 Y0 I1 J0 F600") << "seen from the other side";
}

TEST(PathLine, Refusals) {
  EXPECT_THROW(first_line(Operations().feed({1}, 0)), PathRefusal);
  EXPECT_THROW(first_line(Operations().feed({0, 0, 0, 90}, 10)), PathRefusal) << "no axis A";
  EXPECT_THROW(first_line(Operations().command(TRAMMEL_PAUSE)), PathRefusal);
  Operations tilted;
  tilted.arc({2, 0}, {1, 0, 0}, 2, -1, 10);
  tilted.all.front().normal[0] = 0.1;
  EXPECT_THROW(first_line(tilted), PathRefusal);
}

TEST(PathLine, OutputsThatTheMachineFileNames) {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "outputs.p1=3");
  machine::apply_override(machine, "outputs.p15=[4, 5]");
  trammel_operation operation = Operations().feed({1}, 10).all.front();
  operation.outputs = 0x8007;
  operation.levels = 2;
  EXPECT_EQ(output_lines(operation, machine), (std::vector<std::string>{"M62 P1", "M63 P15"}));
  operation.kind = TRAMMEL_SWITCH;
  EXPECT_EQ(output_lines(operation, machine), (std::vector<std::string>{"M64 P1", "M65 P15"}));
  EXPECT_EQ(path_line(operation, {}, machine), "");
}

}  // namespace
}  // namespace trammel::linuxcnc
