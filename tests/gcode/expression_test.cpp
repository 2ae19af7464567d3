// Parameters and expressions, against the mathematics library and LinuxCNC's documentation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;

// Value of an X word.
double value_of(const std::string& expression, const std::string& before = "") {
  const Reading program = read_text(before + "\nG0 X" + expression);
  EXPECT_FALSE(program.error) << describe(*program.error);
  // A motion to the present position is reported as a motion, too.
  return program.motions.size() < 2 ? std::nan("") : program.motions[program.motions.size() - 2].target[0];
}

TEST(Expression, OperatorsAndTheirStrength) {
  const std::vector<std::pair<const char*, double>> cases = {
      {"[1+2*3]", 7},       {"[[1+2]*3]", 9},      {"[2**3**2]", 64}, {"[-2**2]", 4},    {"[7/2*2]", 7},
      {"[10-4-3]", 3},      {"[-7 MOD 3]", 2},     {"[7mod-3]", 1},   {"[2*3 GT 5]", 1}, {"[1 EQ 1.00005]", 1},
      {"[1 EQ 1.0002]", 0}, {"[1 NE 1.00005]", 0}, {"[1 LE 1]", 1},   {"[1 LT 1]", 0},   {"[2 GE 3]", 0},
      {"[1 AND 0]", 0},     {"[1 OR 0]", 1},       {"[2 XOR 3]", 0},  {"[0 xor 5]", 1},  {"[2 + 3 GT 4 XOR 1]", 0},
      {"-[3]", -3},         {"+[3]", 3},           {"[2*-3]", -6},    {"[.5+1.]", 1.5},  {"[4/[1+1]]", 2},
      {"[9**.5]", 3},       {"[2**-2]", 0.25},     {"[[[[1]]]]", 1},  {"[1+2EQ3]", 1},   {"[1 EQ 0 OR 1 EQ 1]", 1},
      {"[0 AND 1]", 0},     {"[-1 AND 2]", 1},     {"[0 OR 0]", 0},   {"[0 OR -2]", 1},  {"[0 XOR 0]", 0},
  };
  for (const auto& [text, expected] : cases) EXPECT_NEAR(value_of(text), expected, 1e-12) << text;
}

TEST(Expression, FunctionsInDegrees) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  for (const double angle : {-400.5, -90.0, -30.0, 0.0, 12.25, 45.0, 60.0, 89.5, 180.0, 270.0, 725.0}) {
    const std::string text = "[" + std::to_string(angle) + "]";
    EXPECT_NEAR(value_of("sin" + text), std::sin(angle * kDegree), 1e-14) << angle;
    EXPECT_NEAR(value_of("COS" + text), std::cos(angle * kDegree), 1e-14) << angle;
  }
  EXPECT_NEAR(value_of("tan[45]"), 1, 1e-15);
  EXPECT_EQ(value_of("sin[180]"), 0);
  EXPECT_EQ(value_of("cos[90]"), 0);
  for (const double x : {-1.0, -0.99, -0.3, 0.0, 0.2, 0.75, 1.0}) {
    const std::string text = "[" + std::to_string(x) + "]";
    EXPECT_NEAR(value_of("asin" + text), std::asin(x) / kDegree, 1e-12) << x;
    EXPECT_NEAR(value_of("acos" + text), std::acos(x) / kDegree, 1e-12) << x;
  }
  EXPECT_NEAR(value_of("atan[1]/[-1]"), 135, 1e-12);
  EXPECT_NEAR(value_of("ATAN [-3] / [4]"), std::atan2(-3, 4) / kDegree, 1e-12);
  EXPECT_EQ(value_of("fix[-2.5]"), -3);
  EXPECT_EQ(value_of("fup[-2.5]"), -2);
  EXPECT_EQ(value_of("round[-2.5]"), -3);
  EXPECT_EQ(value_of("round[2.49]"), 2);
  EXPECT_EQ(value_of("abs[-2.5]"), 2.5);
  EXPECT_NEAR(value_of("sqrt[2]"), std::sqrt(2), 1e-15);
  EXPECT_NEAR(value_of("-sqrt[4]"), -2, 0);
}

TEST(Expression, ExponentialsAndPowers) {
  for (const double x : {-20.0, -1.0, -0.001, 0.0, 0.5, 1.0, 3.25, 27.0}) {
    EXPECT_NEAR(value_of("exp[" + std::to_string(x) + "]") / std::exp(x), 1, 1e-15) << x;
  }
  for (const double x : {0.000125, 0.5, 0.999, 1.0, 1.0005, 2.718281828, 12345.678}) {
    EXPECT_NEAR(value_of("ln[" + std::to_string(x) + "]"), std::log(std::stod(std::to_string(x))), 4e-16 * 10) << x;
  }
  for (const double base : {0.01, 0.5, 2.0, 9.75, 1000.0}) {
    for (const double exponent : {-3.5, -0.25, 0.5, 2.0, 3.75}) {
      const std::string text = "[" + std::to_string(base) + "**" + std::to_string(exponent) + "]";
      EXPECT_NEAR(value_of(text) / std::pow(base, exponent), 1, 1e-13) << text;
    }
  }
  EXPECT_EQ(value_of("[0**2.5]"), 0);
  EXPECT_NEAR(value_of("[1.01**2048]") / std::pow(1.01, 2048), 1, 1e-12) << "too many factors for products";
  EXPECT_EQ(value_of("exp[-746]"), 0);
}

TEST(Expression, NumberedParameters) {
  EXPECT_EQ(value_of("#1", "#1=5"), 5);
  EXPECT_EQ(value_of("#[1+1]", "#2=6"), 6);
  EXPECT_EQ(value_of("##1", "#1=2 #2=7"), 7);
  EXPECT_EQ(value_of("-#3", "#3=4"), -4);
  EXPECT_EQ(value_of("#77"), 0) << "not set";
  EXPECT_EQ(value_of("#2", "#1=5\n#1=6 #2=#1"), 5) << "a line's assignments take effect behind it";
  EXPECT_EQ(value_of("#1", "#1=1\n#1=[#1+1] #1=[#1+5]"), 6) << "the last one counts";
  EXPECT_EQ(value_of("#1", "#1=[2 * [3 + 4]] (note) ; rest"), 14);
  EXPECT_EQ(value_of("#5000", "#5000=9"), 9);
  EXPECT_THAT(refusal("G0 X#0"), HasSubstr("#0: parameters have the numbers 1 to 5602, or names"));
  EXPECT_THAT(refusal("#1.5=2"), HasSubstr("#1.5: parameters"));
  EXPECT_THAT(refusal("#5603=2"), HasSubstr("parameters have"));
  EXPECT_THAT(refusal("#5220=2"), HasSubstr("#5220 only tells something"));
  EXPECT_EQ(value_of("#5599"), 1) << "LinuxCNC shows messages for debugging";
  EXPECT_EQ(value_of("#5599", "#5599=0"), 0);
  EXPECT_THAT(refusal("#1=5 6"), HasSubstr("unexpected '6'"));
  EXPECT_THAT(refusal("#1"), HasSubstr("needs '='"));
}

TEST(Expression, NamedParameters) {
  EXPECT_EQ(value_of("#<depth>", "#<depth>=3"), 3);
  EXPECT_EQ(value_of("#<DE pth>", "#<depth>=3"), 3) << "case and blanks do not count";
  EXPECT_EQ(value_of("[exists[#<a>]+2*exists[#<b>]]", "#<a>=0"), 1);
  EXPECT_EQ(value_of("exists[#<_x>]"), 1);
  EXPECT_EQ(value_of("exists[#5]"), 1);
  EXPECT_THAT(refusal("G0 X#<nope>"), HasSubstr("#<nope> has no value yet"));
  EXPECT_THAT(refusal("#<a>=#<a>"), HasSubstr("#<a> has no value yet"));
  EXPECT_THAT(refusal("#<_x>=1"), HasSubstr("cannot be set"));
  EXPECT_THAT(refusal("#<>=1"), HasSubstr("without a name"));
  EXPECT_THAT(refusal("#<a\xc3\xa4>=1"), HasSubstr("not understood from '\xc3\xa4>=1' on"));
  EXPECT_THAT(refusal("#<a=1"), HasSubstr("without '>'"));
  EXPECT_EQ(refusal("G0 X#<a(b)>"), "1: an expression is not understood from '(b)>' on");
  EXPECT_EQ(refusal("G0 X#<a)>"), "1: an expression is not understood from ')>' on");
  EXPECT_EQ(refusal("G0 X#<a;b>"), "1: an expression is not understood from ';b>' on");
  EXPECT_EQ(refusal("G0 X#<a\x7f>"), "1: an expression is not understood from '\\x7f>' on");
  EXPECT_EQ(refusal("G0 X#<ab>"), "1: #<ab> has no value yet");
  EXPECT_EQ(refusal("G0 X#<_q>"), "1: #<_q> has no value yet");
  EXPECT_EQ(refusal("#<_ini[axis]>=1\nG0 X#<_ini[traj]>"),
            "2: #<_ini[traj]> is LinuxCNC's own: write its value in the program");
  EXPECT_THAT(refusal("#<" + std::string(65, 'a') + ">=1"), HasSubstr("more than 64 characters"));
}

TEST(Expression, AnyWordTakesOne) {
  const Reading program = read_text("#1=1 #2=90\nG[#1] X[1+1] F[60*2]\nG#2 G4 P[1/4]\nM[1+1]\n");
  ASSERT_FALSE(program.error) << describe(*program.error);
  ASSERT_EQ(program.motions.size(), 3U);
  EXPECT_EQ(program.motions[0].kind, MotionKind::kLine);
  EXPECT_EQ(program.motions[0].feed, 2);
  EXPECT_EQ(program.motions[1].seconds, 0.25);
  EXPECT_EQ(refusal("G0 X1 T[1.5]"), "1: 'T[1.5]' must be a whole number");
}

TEST(Expression, WhatIsWrongIsTold) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"G0 X[1", "the line ends inside an expression"},
      {"G0 X[1+]", "not understood from ']' on"},
      {"G0 X[1 2]", "not understood from '2]' on"},
      {"G0 X[1/0]", "division by 0"},
      {"G0 X[1 mod 0]", "division by 0"},
      {"G0 X[0**-1]", "a power that is no number"},
      {"G0 X[-1**.5]", "a power that is no number"},
      {"G0 Xsqrt[-1]", "SQRT of a number below 0"},
      {"G0 Xln[0]", "LN of a number that is not above 0"},
      {"G0 Xasin[1.5]", "ASIN of a number beyond -1 to 1"},
      {"G0 Xacos[-2]", "ACOS of a number beyond -1 to 1"},
      {"G0 Xtan[90]", "TAN of a right angle"},
      {"G0 Xatan[1]", "ATAN needs two arguments"},
      {"G0 Xexists[1]", "EXISTS needs a parameter"},
      {"G0 X[10**13]", "out of range"},
      {"G0 X[10**200*10**200]", "out of range"},
      {"G0 X[foo]", "not understood from 'foo]' on"},
      {"G0 X[1.2.3]", "not understood from '.3]' on"},
      {"G0 X[.]", "not understood from '.]' on"},
      {"G0 X[2 + * 3]", "not understood from '* 3]' on"},
      {"G0 Xatan[1/0]/[1]", "1: division by 0"},
      {"G0 Xatan[1]/[1/0]", "1: division by 0"},
      {"G0 Xatan[1]/2", "not understood from '2' on"},
      {"G0 X[atan 1]", "not understood from '1]' on"},
      {"G0 Xabs[1/0]", "1: division by 0"},
      {"G0 X[abs 1]", "not understood from 'abs 1]' on"},
      {"G0 X[exists 5]", "EXISTS needs a parameter"},
      {"G0 Xexists[#<>]", "a parameter without a name"},
      {"G0 Xexists[#[1/0]]", "1: division by 0"},
      {"G0 Xexists[#5 6]", "not understood from '6]' on"},
      {"G0 X#[1/0]", "1: division by 0"},
      {"#[1/0]=2", "1: division by 0"},
      {"G0 Xexp[710]", "EXP is out of range"},
      {"G0 X[0**-.5]", "a power that is no number"},
      {"G0 Xfoo[1]", "malformed number in 'X'"},
  };
  for (const auto& [text, message] : cases) EXPECT_THAT(refusal(text), HasSubstr(message)) << text;
  EXPECT_THAT(refusal("G0 X" + std::string(40, '[')), HasSubstr("nested deeper than 32"));
  std::string many = "G0 X1";
  for (int i = 0; i < 51; ++i) many += " #1=1";
  EXPECT_THAT(refusal(many), HasSubstr("more than 50 assignments on a line"));
}

TEST(Expression, NumbersOfAnyLength) {
  EXPECT_EQ(value_of("[0." + std::string(400, '0') + "1]"), 0) << "nearer to 0 than to the least double";
  EXPECT_EQ(value_of("[" + std::string(400, '0') + "7]"), 7);
  for (const std::string before : {"[", "[1/", "#"}) {
    EXPECT_EQ(refusal("G0 X" + before + std::string(400, '9') + "]"),
              "1: number out of range in '" + std::string(77, '9') + "...'");
  }
}

TEST(Expression, LimitsOfNames) {
  std::string named;
  for (int i = 0; i < 51; ++i) named += "#<n" + std::to_string(i) + ">=1 ";
  EXPECT_EQ(refusal(named), "1: more than 50 assignments on a line");
  std::string names;
  for (int i = 0; i < 4096; ++i) names += "#<n" + std::to_string(i) + ">=" + std::to_string(i) + "\n";
  EXPECT_EQ(value_of("#<n4095>", names + "#<n4095>=7"), 7) << "of a name that is there";
  EXPECT_EQ(refusal(names + "#<more>=1"), "4097: more than 4096 names of parameters");
  EXPECT_EQ(refusal("#<a>=1 G0 X#<a>"), "1: #<a> has no value yet") << "but behind the line";
  EXPECT_EQ(value_of("[#1*10+exists[#<a>]]", "#<a>=1 #1=exists[#<a>]"), 1);
}

TEST(Expression, StateThatProgramsRead) {
  machine::Machine machine = machine::default_machine();
  machine.axes[0].offsets[1] = 7;
  machine.axes[2].home = 30;
  machine.axes[1].second_home = 12;
  machine.tools.push_back({4, {0, 0, 25.4}});
  const auto read_value = [&](const std::string& before, const std::string& word) {
    const Reading program = read_text(before + "\nG21 G90 G54 G92.1 G49\nG53 G0 Y" + word, machine);
    EXPECT_FALSE(program.error) << describe(*program.error);
    return program.motions[program.motions.size() - 2].target[1];
  };
  EXPECT_EQ(read_value("", "#5163"), 30);
  EXPECT_EQ(read_value("", "#5182"), 12);
  EXPECT_EQ(read_value("", "#5241"), 7);
  EXPECT_EQ(read_value("G55\n#1=#5220", "#1"), 2);
  EXPECT_EQ(read_value("G59.3\n#1=#<_coord_system>", "#1"), 593);
  EXPECT_EQ(read_value("G55 G0 X3\n#1=#5420 #2=#<_x>", "[#1*10+#2]"), 33);
  EXPECT_NEAR(read_value("G0 X25.4\nG20\n#1=#<_x>", "#1"), 1, 1e-12) << "in the program's units";
  EXPECT_EQ(read_value("G0 X5\nG92 X2\n#1=#5211 #2=#5210", "[#1*10+#2]"), 31);
  EXPECT_EQ(read_value("T4 M6\n#1=#5400 #2=#5403", "[#1+#2]"), 29.4);
  EXPECT_EQ(read_value("T4\n#1=#<_current_tool> #2=#<_selected_tool>", "[#1*10+#2]"), 4);
  EXPECT_EQ(read_value("T4 M6 G43\n#1=#<_tool_offset>", "#1"), 1);
  EXPECT_EQ(read_value("G20 G91 G98\n#1=[#<_imperial>+#<_metric>*2+#<_incremental>*4+#<_retract_old_z>*8]", "#1"), 13);
  EXPECT_EQ(read_value("G1 F90\n#1=[#<_feed>+#<_motion_mode>]", "#1"), 100);
  EXPECT_EQ(read_value("#1=#<_line>", "#1"), 0) << "of the line before";
  EXPECT_EQ(read_value("#1=#5210 #2=#<_rpm>\nS1200", "[#1+#<_rpm>]"), 1200);
  EXPECT_EQ(read_value("G92 X1\nG92.2\n#1=#5210", "#1"), 0) << "G92 is off";
  EXPECT_EQ(read_value("#1=#<_tool_offset>", "#1"), 0);
  machine.axes[0].letter = 'A';
  EXPECT_EQ(read_value("G20 G0 A90\n#1=#<_a>", "#1"), 90) << "degrees, whatever the units";
}

TEST(Expression, ParametersGoInAndOut) {
  ReaderOptions options;
  options.parameters = {{31, 4.5}, {5221, 10}, {5220, 2}, {5241, -3}, {5163, 44}, {5211, 1}, {5210, 1}, {5400, 7}};
  const machine::Machine machine = machine::default_machine();
  TextLines lines("G0 X#31\nG28\n#32=8 #33=0\nG10 L2 P3 Y2\nG30.1\nT9 M6", "p.ngc");
  Reader reader(lines, machine, {}, options);
  std::vector<Motion> motions;
  for (Motion motion; reader.next(motion);) motions.push_back(motion);
  ASSERT_FALSE(reader.error());
  EXPECT_EQ(motions[0].target[0], 4.5 - 3 + 1) << "G55 and G92";
  EXPECT_EQ(motions[1].target[2], 44);
  const std::map<int, double> expected = {{31, 4.5}, {32, 8},    {5163, 44}, {5183, 44}, {5210, 1}, {5211, 1},
                                          {5220, 2}, {5221, 10}, {5241, -3}, {5262, 2},  {5400, 9}};
  EXPECT_EQ(reader.parameters(), expected);
}

TEST(Expression, ParametersThatMeanNothingGoIn) {
  using Numbers = std::map<int, double>;
  const auto behind = [](const Numbers& before) {
    ReaderOptions options;
    options.parameters = before;
    const machine::Machine machine = machine::default_machine();
    TextLines lines("G0 X1", "p.ngc");
    Reader reader(lines, machine, {}, options);
    for (Motion motion; reader.next(motion);) continue;
    EXPECT_FALSE(reader.error());
    return reader.parameters();
  };
  const Numbers none = {{5220, 1}};
  EXPECT_EQ(behind({}), none);
  EXPECT_EQ(behind({{0, 4}, {-1, 4}, {5001, 4}}), none) << "there are no such numbers to set";
  EXPECT_EQ(behind({{5400, -1}}), none);
  EXPECT_EQ(behind({{5400, 1e7}}), none) << "no such tool";
  EXPECT_EQ(behind({{5220, 0}}), none);
  EXPECT_EQ(behind({{5220, 10}}), none) << "no such system";
  EXPECT_EQ(behind({{5164, 3}}), none) << "no such axis";
  EXPECT_EQ(behind({{5210, 0}, {5211, 3}}), (Numbers{{5211, 3}, {5220, 1}})) << "G92 that is off";
}

}  // namespace
}  // namespace trammel::gcode
