// The same programs in LinuxCNC's own interpreter, if it is installed.
#include "linuxcnc.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

namespace trammel::gcode::linuxcnc {
namespace {

std::string program_text(const std::string& name) {
  std::ifstream file(TRAMMEL_GCODE_PROGRAMS "/" + name);
  EXPECT_TRUE(file) << name;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

class LinuxcncProgram : public LinuxcncTest, public ::testing::WithParamInterface<const char*> {};
class Linuxcnc : public LinuxcncTest {};

TEST_P(LinuxcncProgram, HasTheSameMotions) { expect_same(program_text(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Programs, LinuxcncProgram,
                         ::testing::Values("cycles.ngc", "offsets.ngc", "parameters.ngc", "fusion.ngc", "freecad.ngc",
                                           "inkscape.ngc", "vectric.ngc", "lightburn.gcode"),
                         [](const auto& test) {
                           const std::string name = test.param;
                           return name.substr(0, name.find('.'));
                         });

TEST_F(Linuxcnc, ProbesAlike) {
  expect_same("G21 G90 F50\nG0 X1 Y2 Z5\nG38.2 Z-3\nG0 Z[#5063+2]\nX[#5061*2] Y#5062\nM2\n");
}

TEST_F(Linuxcnc, CountsTurnsAlike) {
  expect_same("G21 G90 F60\nG2 X0 Y0 I5 P4\nG61 G2 X0 Y0 I5 P3\nG61.1 G3 X10 Y0 I5 P2\nM2\n");
}

TEST_F(Linuxcnc, LocalOriginsAreTheOffsetOfG92) {
  expect_same(
      "G21 G90\nG0 X10\nG92 X3\nG52 X5\nG0 X1\nG52 Y1\nG0 X1 Y0\nG92.2\nG0 X2 Y0\nG92.3\nG0 X1 Y0\n"
      "G55 G0 X4\nG20 G52 X1 Z2\nG0 X0 Z0\nG52 X0 Y0 Z0\nG0 X1 Y1\nM2\n");
}

// Both interpreters refuse the same lines and accept the same lines.
TEST_F(Linuxcnc, RefusesAlike) {
  const std::vector<const char*> lines = {
      "G81 X1 Z-1", "G81 X1 R1", "G81 X1 Z3 R2", "G83 X1 Z-1 R2", "G83 X1 Z-1 R2 Q0", "G82 X1 Z-1 R2",
      "G81 X1 Z-1 R2 L0", "G81 X1 Z-1 R2 Q1", "G43 H9", "G10 L2 P10 X1", "G10 L2 X1", "G5 X1 Y1 I1 J1", "G5.1 X1 Y1",
      "G38.2 X0 Y0 Z0", "G0 X#<nope>", "G0 X[1/0]", "G0 X[1+]", "G0 Xsqrt[-1]", "G0 X#5603", "#5420=1", "G0 X1 H1",
      "G0 X1 P1", "G92", "G0 G28 X1", "G93 G81 X1 Z-1 R2", "G80 X1", "G0 Xasin[2]", "G0 X[2 MOD 0]", "G0 X#0", "G52",
      "G52 G0 X1", "G0 G53 X",
      // accepted by both
      "G0 X[2**3]", "G0 X-#1", "G0 X##7", "G43 H1", "G43.1 Z1", "G10 L20 P0 X1", "G28.1", "G92.3", "G81 X1 Z-1 R2 L2",
      "G8", "G97", "G52 X1"};
  for (const char* line : lines) {
    const std::string text = fmt::format("G21 G90 F60\n#7=1\n{}\nM2\n", line);
    bool ended = false;
    std::string error;
    read_by_linuxcnc(text, ended);
    read_by_trammel(text, error);
    EXPECT_EQ(error.empty(), ended) << line << ": " << error;
  }
}

}  // namespace
}  // namespace trammel::gcode::linuxcnc
