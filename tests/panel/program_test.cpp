#include "trammel/panel/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.hpp"

namespace trammel::panel {
namespace {

using testing::HasSubstr;

TEST(Program, RunsToItsEndAndTellsTheLine) {
  Bench bench;
  bench.load("G21 G90\nG1 X4 F1200\n\n(a comment with ! and ?)\nY4\nX0 Y0\nM2\nX999\n");
  bench.send({{"do", "start"}});
  std::vector<int> lines;
  bench.machine.at_moments = [&] {
    const int line = bench.state()["program"]["line"];
    if (line != 0 && (lines.empty() || lines.back() != line)) lines.push_back(line);
  };
  bench.work(milliseconds(3000));
  EXPECT_EQ(lines, (std::vector<int>{2, 5, 6}));
  EXPECT_EQ(bench.state()["program"]["phase"], "done");
  EXPECT_EQ(bench.state()["program"]["lines"], 8);
  EXPECT_NEAR(bench.machine.live.at[0], 0, 1e-9);
}

TEST(Program, IsHeldWhenThePageGoesAndGoesOnAtResumeAlone) {
  Bench bench;
  bench.load("G1 X10 F1200\nX20\n");
  bench.send({{"do", "start"}});
  double held = 0;
  const auto look = [&] {
    bench.after(milliseconds(300), [&] {
      held = bench.machine.live.at[0];
      bench.session.arrived();  // nothing moves by itself
      bench.after(milliseconds(300), [&] {
        EXPECT_EQ(bench.machine.live.at[0], held);
        EXPECT_EQ(bench.state()["state"], "Hold:0");
        bench.send({{"do", "resume"}});
      });
    });
  };
  bench.after(milliseconds(200), [&] {
    bench.session.left();
    look();
  });
  bench.work(milliseconds(4000));
  EXPECT_GT(held, 2);
  EXPECT_LT(held, 5);
  EXPECT_EQ(bench.state()["program"]["phase"], "done");
  EXPECT_NEAR(bench.machine.live.at[0], 20, 1e-9);
}

TEST(Program, GoesOnWithoutThePageWhereThePageWantedIt) {
  Bench bench;
  bench.send({{"do", "when_gone"}, {"hold", false}});
  bench.load("G1 X10 F1200\nX20\n");
  bench.send({{"do", "start"}});
  bench.after(milliseconds(200), [&] { bench.session.left(); });
  bench.work(milliseconds(4000));
  EXPECT_TRUE(bench.machine.holds.empty());
  EXPECT_EQ(bench.state()["program"]["phase"], "done");
  EXPECT_NEAR(bench.machine.live.at[0], 20, 1e-9);
}

TEST(Program, IsHeldAndStopped) {
  Bench bench;
  bench.load("G1 X10 F1200\nX20\n");
  bench.send({{"do", "start"}});
  bench.after(milliseconds(200), [&] {
    bench.send({{"do", "hold"}});
    bench.after(milliseconds(200), [&] { bench.send({{"do", "stop"}}); });
  });
  bench.work(milliseconds(1500));
  EXPECT_EQ(bench.state()["state"], "Idle");
  EXPECT_EQ(bench.state()["program"]["phase"], "stopped");
  EXPECT_EQ(bench.state()["program"]["line"], 1);
  EXPECT_LT(bench.machine.live.at[0], 6);
  bench.work(milliseconds(500));
  EXPECT_LT(bench.machine.live.at[0], 6);
}

// A stop at any time: no line after it moves anything.
TEST(Program, NothingMovesBehindAStop) {
  std::string text = "G91 F1200\n";
  for (unsigned n = 0; n < 60; ++n) text += n % 2 == 0 ? "G0 X0.3\n" : "G0 Y0.2\n";
  for (int time = 20; time < 400; time += 7) {
    Bench bench;
    bench.load(text);
    bench.send({{"do", "start"}});
    bench.after(milliseconds(time), [&] { bench.send({{"do", "stop"}}); });
    bench.work(milliseconds(time + 20));
    const gcode::Coordinates stood = bench.machine.live.at;
    bench.work(milliseconds(300));
    ASSERT_EQ(bench.machine.live.at, stood) << time;
    ASSERT_EQ(bench.state()["program"]["phase"], "stopped") << time;
    ASSERT_EQ(bench.state()["state"], "Idle") << time;
  }
}

// Nothing moves if the controller would refuse a later line of the program.
TEST(Program, IsCheckedBeforeItMoves) {
  const std::pair<const char*, const char*> kCases[]{
      {"G1 X5 F600\nG2 I3\n", "Line 2: axis words are missing"},
      {"G1 X5 F600\nX300\n", "Line 2: the target is beyond a soft limit"},
      {"G1 X5\n", "Line 1: there is no feed"}};
  for (const auto& [text, reason] : kCases) {
    Bench bench;
    bench.load(text);
    bench.send({{"do", "start"}});
    bench.work(milliseconds(1000));
    EXPECT_EQ(bench.state()["program"]["phase"], "stopped");
    EXPECT_THAT(bench.state()["program"]["stop_reason"], HasSubstr(reason));
    EXPECT_EQ(bench.machine.live.at[0], 0);
  }
}

TEST(Program, ThePageGoesBeforeItMoves) {
  Bench bench;
  bench.load("G1 X10 F1200\n");
  bench.send({{"do", "start"}});
  bench.session.left();
  bench.work(milliseconds(300));
  EXPECT_EQ(bench.machine.live.at[0], 0);
  EXPECT_EQ(bench.state()["program"]["phase"], "stopped");
}

TEST(Program, IsRefusedWithWhatIsNoProgram) {
  const std::pair<std::string, const char*> kCases[]{{"G1 X5\n$X\n", "line 2 begins with $"},
                                                     {"G1 X5 F600\nG1 X\xC3\xB6 5", "line 2 has a character"},
                                                     {"G0 X1 !", "line 1 has a character"},
                                                     {"(nothing)\n\n", "the program is empty"},
                                                     {"G1 X" + std::string(80, '1'), "line 1 is longer than 79"}};
  for (const auto& [text, reason] : kCases) {
    Program program;
    program.begin_loading("a.ngc");
    ASSERT_TRUE(program.append(text));
    EXPECT_THAT(program.finish_loading().value_or(""), HasSubstr(reason));
    EXPECT_EQ(program.phase(), Program::Phase::kNone);
  }
}

TEST(Program, LinesCarryTheirNumbersAndCommentsMayHaveAnyLetters) {
  Program program;
  program.begin_loading("a.ngc");
  ASSERT_TRUE(program.append("%\r\nN100 G1 X1 F60 (gr\xC3\xB6sser!)\r\nx2;?\n" + std::string(76, 'X')));
  ASSERT_EQ(program.finish_loading(), std::nullopt);
  EXPECT_EQ(program.lines(), 4U);
  ASSERT_TRUE(program.check());
  EXPECT_EQ(program.next()->text, "N2G1X1F60");
  EXPECT_EQ(program.next()->text, "N3X2");
  EXPECT_EQ(program.next()->text, "N4" + std::string(76, 'X'));
  EXPECT_FALSE(program.next().has_value());
}

TEST(Program, AnotherIsNotTakenWhileOneRuns) {
  Bench bench;
  bench.load("G1 X10 F1200\n");
  bench.send({{"do", "start"}});
  bench.after(milliseconds(100), [&] { bench.load("G1 X-5 F600\n"); });
  bench.work(milliseconds(1500));
  EXPECT_NEAR(bench.machine.live.at[0], 10, 1e-9);
  EXPECT_EQ(bench.session.program().text(), "G1 X10 F1200\n");
  EXPECT_THAT(bench.notes(), HasSubstr("not taken"));
}

}  // namespace
}  // namespace trammel::panel
