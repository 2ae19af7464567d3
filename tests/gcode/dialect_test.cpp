// Words of slicers, printers' firmware and other controllers: accepted, left out, or refused with advice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::map<std::string, std::size_t>;

Reading read_naming_all(const std::string& text) {
  ReaderOptions options;
  options.name_all_unknown = true;
  TextLines lines(text, "p.gcode");
  return read_all(lines, machine::default_machine(), {}, options);
}

Coordinates end_of(const std::string& text) {
  const Reading program = read_text(text);
  EXPECT_FALSE(program.error) << text << ": " << describe(*program.error);
  return program.motions.empty() ? Coordinates{} : program.motions.back().target;
}

TEST(Dialect, FirmwareWordsWithoutEffectAreListed) {
  const Reading program = read_text(
      "M115 U3.14\nM17\nM17 X Y\nM400\nM900 K0.05\nM862.1 P0.4\nM862.3 P \"MK3S\"\nM862.6 P\"Input shaper\"\nM84 X Y "
      "E\nM18 E\n"
      "M84 S120\nM220 S100\nM221 T0 S100.0 ; flow\nG10\nG10 S1\nG11 ; back\nM82\nG0 X1\n");
  ASSERT_FALSE(program.error) << describe(*program.error);
  EXPECT_EQ(program.accepted, (Words{{"M115", 1},
                                     {"M17", 2},
                                     {"M400", 1},
                                     {"M900", 1},
                                     {"M862.1", 1},
                                     {"M862.3", 1},
                                     {"M862.6", 1},
                                     {"M84", 2},
                                     {"M18", 1},
                                     {"M220", 1},
                                     {"M221", 1},
                                     {"G10", 2},
                                     {"G11", 1}}));
  EXPECT_EQ(program.motions.size(), 2U);
}

TEST(Dialect, OverridesOtherThanAllOfItAreRefused) {
  EXPECT_EQ(refusal("M220 S80"),
            "1: unsupported word 'M220': only S100 has no effect; --override changes the speed; --accept M220 leaves "
            "out the lines that begin with it");
  EXPECT_THAT(refusal("M221 ; S100"), HasSubstr("let the slicer scale E; --accept M221"));
  EXPECT_THAT(refusal("M220 B"), HasSubstr("--accept M220"));
}

TEST(Dialect, G10WithWordsKeepsItsMeaning) {
  EXPECT_EQ(end_of("G10 L2 P1 X5\nG0 X1")[0], 6);
  EXPECT_EQ(refusal("G10 P1 X5"), "1: G10 needs L2 or L20; alone on its line it is a printer's retraction");
  EXPECT_THAT(refusal("G11 X5"), HasSubstr("alone on its line it takes back a retraction (G10)"));
}

TEST(Dialect, AllUnknownWordsAreNamedAtOnce) {
  const Reading program = read_naming_all(
      "G0 X1\nN2 M808 L5\n\nN3\nN M9999\n/M11\nM70\nM555\nM808\nM104 S0\nM220 S90\nG9\nG68\nM1234.5 (M7)\nG0 M5555\n");
  ASSERT_TRUE(program.error);
  EXPECT_EQ(describe(*program.error),
            "p.gcode:2: unsupported word 'M808'; --accept M808,M555,M220,G9,M1234.5 leaves out the lines that begin "
            "with these words");
  EXPECT_EQ(refusal("M808\nM555"), "1: unsupported word 'M808'; --accept M808 leaves out the lines that begin with it");
}

TEST(Dialect, WordsThatCannotBeLeftOut) {
  EXPECT_EQ(refusal("G0 X1 M555"), "1: unsupported word 'M555'; on a line of its own --accept M555 leaves it out");
  EXPECT_EQ(refusal("G0 X1 M104 S0"), "1: unsupported word 'M104'; on a line of its own it is left out");
  EXPECT_EQ(refusal("G0 X1 M19"),
            "1: unsupported word 'M19': there is no spindle encoder to turn to an angle by; on a line of its own "
            "--accept M19 leaves it out");
  for (const char* word : {"G68 R30", "G51", "G16", "G33 K1", "M98 P1", "G162", "M206 X1", "G1.5", "G59.4"}) {
    EXPECT_THAT(refusal(word), Not(HasSubstr("--accept"))) << word;
  }
  for (const CodeWord word : {CodeWord{'G', 10}, {'G', 200}, {'G', 170}, {'G', 920}, {'M', 830}, {'G', 594}}) {
    EXPECT_EQ(why_not_left_out(word), "the reader obeys it") << word.letter << word.tenths;
  }
  for (const CodeWord word : {CodeWord{'M', 9000}, {'G', 90}, {'M', 30}, {'G', 291}, {'M', 45'670}}) {
    EXPECT_EQ(why_not_left_out(word), "") << word.letter << word.tenths;
  }
}

TEST(Dialect, RefusedWordsHaveAReason) {
  for (const char* word : {"G68", "M19", "M50 P1", "M51", "M52", "M53", "M66 P0 L3", "M67 E0", "M68 E0", "M70", "M72",
                           "M61 Q1", "G7", "G50", "G12 I5", "G65 P1"}) {
    EXPECT_THAT(refusal(word), HasSubstr("': ")) << word;
  }
}

TEST(Dialect, CancellingWordsOfModesThatAreNotThere) { EXPECT_EQ(end_of("G8 G15 G69 G97 S100\nG0 X1")[0], 1); }

TEST(Dialect, G28TakesLettersAlone) {
  machine::Machine machine = machine::default_machine();
  machine.axes[0].home = -5;
  machine.axes[1].home = -6;
  machine.axes[2].home = 30;
  const auto end = [&](const std::string& line) { return read_text("G0 X1 Y1 Z1\n" + line, machine).motions.back(); };
  EXPECT_EQ(end("G28 X Y").target, (Coordinates{-5, -6, 1}));
  EXPECT_EQ(end("G28 X0 Z").target, (Coordinates{-5, 1, 30}));
  EXPECT_EQ(end("G28 z ; lift").target, (Coordinates{1, 1, 30}));
  EXPECT_EQ(end("G28 Z(lift)").target, (Coordinates{1, 1, 30}));
  EXPECT_EQ(end("G30 X Z").target, (Coordinates{0, 1, 0}));
  EXPECT_EQ(end("G28 W").target, (Coordinates{-5, -6, 30})) << "a printer's word, where there is no such axis";
  EXPECT_EQ(refusal("G28 A"), "1: 'A': the machine has no axis A; [axis.a] of its file would describe it");
  EXPECT_EQ(refusal("G28 X P"), "1: malformed number in 'X'");
  EXPECT_EQ(refusal("G0 Y X1"), "1: malformed number in 'Y'");
  EXPECT_EQ(refusal("G28 X-"), "1: malformed number in 'X-'");
}

TEST(Dialect, G28IsListedSinceNothingIsSearched) {
  EXPECT_EQ(read_text("G28\nG28 X0\nG28.1\nG30").accepted, (Words{{"G28", 2}}));
}

TEST(Dialect, AProgramNumberComesBeforeAllWords) {
  EXPECT_EQ(end_of("%\nO1234 (PART)\nG0 X1\nM30\n%\n")[0], 1);
  EXPECT_EQ(end_of("o0001\nG0 X1")[0], 1);
  EXPECT_THAT(refusal("G0 X1\nO1234"), HasSubstr("2: O-word 'O1234'"));
  EXPECT_THAT(refusal("O100 sub"), HasSubstr("1: O-word 'O100 sub'"));
}

TEST(Dialect, G4TakesSAsSecondsWhereThereIsNoP) {
  const Reading program = read_text("G4 S2.5\nG4 P0.5 S1000\n");
  ASSERT_EQ(program.motions.size(), 3U);
  EXPECT_EQ(program.motions[0].seconds, 2.5);
  EXPECT_EQ(program.motions[1].seconds, 0.5);
  EXPECT_EQ(program.accepted, (Words{{"S", 1}})) << "the speed beside P alone";
}

TEST(Dialect, G4AloneWaitsForNothingInProgramsOfPrinters) {
  EXPECT_EQ(read_text("M104 S0\nG4 ; wait\nG0 X1").accepted, (Words{{"G4", 1}, {"M104", 1}}));
  EXPECT_EQ(refusal("G4\nM104 S0"), "1: G4 needs P or S, its seconds");
  EXPECT_EQ(refusal("M104 S0\nG0 X1\nG4 X1"), "3: G4 needs P or S, its seconds");
}

TEST(Dialect, SecondsOfG4AreToldInProgramsOfPrinters) {
  EXPECT_EQ(read_text("G4 P500\nG4 P0\nG4 S1\nM104 S0\n").accepted.at("G4 P"), 1U);
  EXPECT_EQ(read_text("G4 P500\nM3 S0\n").accepted.count("G4 P"), 0U);
  EXPECT_EQ(read_text("G4 P500\nG1 X1 E0.1 F600\n").accepted.count("G4 P"), 1U) << "an extruder";
  EXPECT_EQ(read_text("M83\nG4 P500\n").accepted.count("G4 P"), 1U);
}

TEST(Dialect, AZeroBesideThePlaneOfAnArc) {
  EXPECT_EQ(end_of("G2 X10 I5 K0 F60")[0], 10);
  EXPECT_EQ(end_of("G18 G2 X10 I5 J0 F60")[0], 10);
  EXPECT_THAT(refusal("G2 X10 I5 K0.1 F60"), HasSubstr("K in the plane XY (G17)"));
}

TEST(Dialect, G53WithoutAnythingToMove) {
  EXPECT_EQ(end_of("G92 X5\nG53\nG53 G90 G40\nG0 X1")[0], -4);
  EXPECT_EQ(end_of("G92 X5\nG0 G53\nX1")[0], -4);
  EXPECT_THAT(refusal("G53 G2 I5 F60"), HasSubstr("G53 needs G0 or G1"));
}

TEST(Dialect, G31ProbesForOneLine) {
  machine::Machine machine = machine::default_machine();
  machine.probe.input = 0;
  const Reading probe = read_text("G1 F60\nG31 Z-10 F50", machine);
  ASSERT_EQ(probe.motions.size(), 1U);
  EXPECT_EQ(probe.motions[0].kind, MotionKind::kProbe);
  EXPECT_FALSE(probe.motions[0].probe_must_trip);
  EXPECT_FALSE(probe.motions[0].probe_away);
  TextLines lines("G31 Z-10 F50\nX5\n", "p.ngc");
  Reader reader(lines, machine);
  Motion motion;
  ASSERT_TRUE(reader.next(motion));
  reader.assume_probed();
  EXPECT_FALSE(reader.next(motion));
  ASSERT_TRUE(reader.error());
  EXPECT_THAT(reader.error()->message, HasSubstr("axis words without a motion word"));
  EXPECT_EQ(refusal("G31"), "1: G31 without an axis word");
}

TEST(Dialect, CommandsOfKlipperAreRefusedByName) {
  EXPECT_EQ(refusal("START_PRINT BED_TEMP=60"),
            "1: 'START_PRINT' is a command or macro of Klipper: let the slicer write the G-code that it stands for");
  EXPECT_THAT(refusal("G0 X1\n  PRINT_END"), HasSubstr("2: 'PRINT_END' is a command"));
  EXPECT_THAT(refusal("SET_VELOCITY_LIMIT ACCEL=500"), HasSubstr("'SET_VELOCITY_LIMIT' is"));
  EXPECT_THAT(refusal("PRINT_END\tX"), HasSubstr("'PRINT_END' is a command"));
  EXPECT_THAT(refusal("PRINT_END;X"), HasSubstr("'PRINT_END' is a command"));
  EXPECT_THAT(refusal("Xabs[1]"), HasSubstr("axis words without a motion word"));
  EXPECT_EQ(refusal("PRINT=1"), "1: malformed number in 'P'") << "no name";
  EXPECT_EQ(refusal("XY1"), "1: malformed number in 'X'") << "too short for a name";
}

TEST(Dialect, CommandsOfGrblAreRefusedByName) {
  EXPECT_EQ(refusal("$32=1 (laser)"),
            "1: '$32=1' is a setting or command for Grbl, no word of a program: remove the line");
  EXPECT_THAT(refusal("$H"), HasSubstr("'$H' is a setting or command for Grbl"));
}

TEST(Dialect, RefusalsSayWhatToDo) {
  EXPECT_EQ(refusal("o<drill> sub (holes)"),
            "1: O-word 'o<drill> sub': subroutines, loops and branches are not supported: let the CAM program write "
            "their lines out");
  EXPECT_THAT(refusal("M98 P1000"), HasSubstr("let the CAM program write their lines out"));
  EXPECT_EQ(refusal("G81 X1 Y1 Z-1 R1 F60\n^120"), "2: '^': no polar coordinates: let the CAM program write X and Y");
  EXPECT_THAT(refusal("G0 @5 ^60"), HasSubstr("'@': no polar coordinates"));
  EXPECT_EQ(refusal("F#<_hal[plasmac.cut-feed-rate]>"),
            "1: #<_hal[plasmac.cut-feed-rate]> is LinuxCNC's own: write its value in the program");
  EXPECT_EQ(refusal("G84.2 X1"),
            "1: unsupported word 'G84.2': there is no spindle encoder to follow: let the CAM program mill the thread");
  EXPECT_THAT(refusal("G95"), HasSubstr("write feeds a minute (G94)"));
  EXPECT_THAT(refusal("G86 X1"), HasSubstr("G85 and G89 bore without"));
  EXPECT_THAT(refusal("G161 X0"), HasSubstr("trammel zero --homed"));
  EXPECT_EQ(refusal("G59.4"), "1: unsupported word 'G59.4': no such word here: write what it stands for");
}

// On other controllers these words move the machine, or change the meaning of the lines after them.
TEST(Dialect, MotionsOfOtherControllersAreNeverLeftOut) {
  for (const char* word : {"G35",  "G36",  "G47",  "G60",     "G63",  "G72",  "G75",  "G107", "G112", "G113",
                           "G141", "G143", "G150", "G154 P1", "G184", "G234", "G254", "G380", "G425", "M97 P5"}) {
    EXPECT_THAT(refusal(word), Not(HasSubstr("--accept"))) << word;
  }
}

}  // namespace
}  // namespace trammel::gcode
