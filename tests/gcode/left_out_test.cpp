// Lines of slicers for hardware that the card does not have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;
using Words = std::map<std::string, std::size_t>;

Reading read_leaving_out(const std::string& text, const std::vector<CodeWord>& more = {}) {
  ReaderOptions options;
  options.left_out = more;
  TextLines lines(text, "p.gcode");
  return read_all(lines, machine::default_machine(), {}, options);
}

TEST(LeftOut, LinesAreListedAndMoveNothing) {
  const Reading program = read_leaving_out(
      "M104 S210 T0\nM105\nM106 S255\nm107\nM109 R170 ; wait (for it)\nM110 N0\nM117 G1 X5 (hello; 100%\n"
      "M140 S60\nM190 S60\nM73 P0 R12\nM201 X9000 Y9000 Z500 E10000\nM202 X1\nM203 X200\nM204 P1250 R1250 T1250\n"
      "M205 X8.00 Y8.00 Z0.40 E1.50\nG29\nG29 A X1 Y2\nN7 M106 S0\nM 104 S0\nM104S0\nG0 X1\n");
  ASSERT_FALSE(program.error) << describe(*program.error);
  ASSERT_EQ(program.motions.size(), 2U);
  EXPECT_EQ(program.motions[0].target[0], 1);
  EXPECT_EQ(program.accepted, (Words{{"M104", 3},
                                     {"M105", 1},
                                     {"M106", 2},
                                     {"M107", 1},
                                     {"M109", 1},
                                     {"M110", 1},
                                     {"M117", 1},
                                     {"M140", 1},
                                     {"M190", 1},
                                     {"M73", 1},
                                     {"M201", 1},
                                     {"M202", 1},
                                     {"M203", 1},
                                     {"M204", 1},
                                     {"M205", 1},
                                     {"G29", 2}}));
}

TEST(LeftOut, MoreAreAskedForByName) {
  EXPECT_TRUE(read_leaving_out("M909 K0.05").error);
  const Reading program = read_leaving_out("M909 K0.05\nM555.3 P \"a\"\nG09 (stop)\nM220 S80\nG0 X1",
                                           {{'M', 9090}, {'M', 5553}, {'G', 90}, {'M', 2200}});
  ASSERT_FALSE(program.error) << describe(*program.error);
  EXPECT_EQ(program.accepted, (Words{{"M909", 1}, {"M555.3", 1}, {"G9", 1}, {"M220", 1}}));
  EXPECT_TRUE(read_leaving_out("M555.1 P0.4", {{'M', 5553}}).error);
  EXPECT_TRUE(read_leaving_out("M862.7").error);
}

TEST(LeftOut, NoMotionIsLost) {
  EXPECT_EQ(read_leaving_out("M104 S200 G1 X5").error->message, "'G1 X5' beside M104, whose line is left out");
  EXPECT_EQ(read_leaving_out("M106 M3").error->message, "'M3' beside M106, whose line is left out");
  EXPECT_FALSE(read_leaving_out("M106 ; G1 X5").error);
  EXPECT_FALSE(read_leaving_out("M106 (G1 X5)").error);
  EXPECT_FALSE(read_leaving_out("M106 Max Gx").error) << "letters of other words";
  EXPECT_THAT(read_leaving_out("M104. S0").error->message, HasSubstr("unsupported word 'M104.'"));
  EXPECT_THAT(read_leaving_out("M862.35 P0").error->message, HasSubstr("unsupported word 'M862.35'"));
  EXPECT_THAT(read_leaving_out("M1040000 S0").error->message, HasSubstr("unsupported word 'M1040000'"));
  EXPECT_THAT(read_leaving_out("M104.0.0 S0").error->message, HasSubstr("malformed number in 'M104.0.0'"));
  EXPECT_THAT(read_leaving_out("N M104 S0").error->message, HasSubstr("unsupported word 'M104'"));
  EXPECT_THAT(read_leaving_out("G0 X1 M104 S200").error->message, HasSubstr("unsupported word 'M104'"));
  EXPECT_THAT(read_leaving_out("M1040 S1").error->message, HasSubstr("unsupported word 'M1040'"));
  EXPECT_THAT(read_leaving_out("M104.5").error->message, HasSubstr("unsupported word 'M104.5'"));
  EXPECT_THAT(read_leaving_out("G290").error->message, HasSubstr("unsupported word 'G290'"));
  EXPECT_TRUE(read_leaving_out("%\nG0 X1\n%\nM104 S0").error) << "behind the end nothing is read";
}

TEST(LeftOut, OpensTheProgram) {
  EXPECT_EQ(read_leaving_out("M104 S0\n%\nG0 X1").error->line, 3U) << "the '%' ends it";
}

}  // namespace
}  // namespace trammel::gcode
