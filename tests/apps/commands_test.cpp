// The other subcommands, and the output files for people.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "command.hpp"

namespace trammel::test {
namespace {

// A line of the paper's table, in pulses, and its largest distance, which was computed independently of this project
// with an exact phase.
struct PaperLine {
  std::array<int, 2> from;
  std::array<int, 2> to;
  double distance;
};

std::string pair(const std::array<int, 2>& place) { return std::to_string(place[0]) + "," + std::to_string(place[1]); }

TEST(Line, EightLinesOfThePaper) {
  const std::vector<PaperLine> lines = {{{0, 0}, {20, 40}, 0.447},     {{10, 10}, {40, 20}, 0.316},
                                        {{10, -10}, {40, -20}, 0.316}, {{-10, 10}, {-40, 20}, 0.316},
                                        {{-10, -10}, {-40, -40}, 0},   {{-10, -5}, {30, 20}, 0.636},
                                        {{7, -2}, {-32, -38}, 0.678},  {{-10, 20}, {30, 20}, 0}};
  const Command command;
  for (const PaperLine& line : lines) {
    SCOPED_TRACE(pair(line.from) + " to " + pair(line.to));
    const Outcome outcome =
        command.run("line --from=" + pair(line.from) + " --to=" + pair(line.to) +
                    " --no-ramp --clock 10000000 --velocity 5000 --json " + command.path("out.json"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json json = read_json(command.path("out.json"));
    EXPECT_EQ(json["final_position"][0], line.to[0] - line.from[0]);
    EXPECT_EQ(json["final_position"][1], line.to[1] - line.from[1]);
    EXPECT_EQ(json["line_clocks"], 2000);
    EXPECT_NEAR(json["max_deviation"]["line"].get<double>(), line.distance, 0.0005);
    EXPECT_EQ(json["lockstep_cycles"], json["cycles"]);
  }
}

// X of the default machine has 80 pulses/mm and 1000 mm/s^2.
TEST(Line, RampsByTheMachinesLimits) {
  const Command command;
  const std::string files = " --json " + command.path("out.json") + " --steps " + command.path("steps.csv");
  const std::string line = "line --to 2000 --speed 10000 --engine model --clock 1000000";
  ASSERT_EQ(command.run(line + files).status, 0);
  EXPECT_NEAR(read_json(command.path("out.json"))["line_clocks"].get<double>(), 200'000 + 125'000, 2000);
  const std::vector<Step> steps = read_steps(command.path("steps.csv"));
  ASSERT_EQ(steps.size(), 2000U);
  const auto clocks = [&](std::size_t from, std::size_t to) {
    return static_cast<double>(steps[to].cycle - steps[from].cycle);
  };
  EXPECT_NEAR(clocks(999, 1000), 100, 1);
  // From rest, pulse n comes after sqrt(2 n / 80,000) s.
  EXPECT_NEAR(clocks(49, 449), 1e6 * (std::sqrt(450 / 40'000.) - std::sqrt(50 / 40'000.)), 1000);
  EXPECT_NEAR(clocks(1550, 1950), clocks(49, 449), 1000);
  ASSERT_EQ(command.run(line + files + " --no-ramp").status, 0);
  EXPECT_EQ(read_json(command.path("out.json"))["line_clocks"], 200'000);
}

TEST(Line, WhatOnlyOneKindOfLineTakes) {
  const Command command;
  const auto error_of = [&](const std::string& arguments) {
    const Outcome outcome = command.run("line " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    return outcome.err;
  };
  EXPECT_NE(error_of("--to 5 --slow").find("--slow: only with --no-ramp"), std::string::npos);
  EXPECT_NE(error_of("--to 5 --max-velocity 9").find("--max-velocity: only with --no-ramp"), std::string::npos);
  EXPECT_NE(error_of("--to 1,1,1,1,1").find("the machine has 4 motors"), std::string::npos);
  EXPECT_NE(error_of("--to 0,0").find("line: no axis moves"), std::string::npos);
  EXPECT_EQ(command.run("line --to 1,1,1,1,1 --no-ramp").status, 0);
}

TEST(Line, LimitRefusesOrSlows) {
  const Command command;
  const std::string line = "line --to 20,40 --no-ramp --clock 10000000 --velocity 5000 --max-velocity 0,100000";
  const Outcome refused = command.run(line + " --steps " + command.path("steps.csv"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(count_lines(refused.err), 1U) << refused.err;
  EXPECT_LE(count_lines(contents(command.path("steps.csv"))), 1U);
  const Outcome slowed = command.run(line + " --slow --json " + command.path("out.json"));
  ASSERT_EQ(slowed.status, 0) << slowed.err;
  const nlohmann::json json = read_json(command.path("out.json"));
  EXPECT_EQ(json["slowed"], true);
  // 40 pulses at 100,000 pulses/s are 4,000 clocks of 10 MHz.
  EXPECT_EQ(json["line_clocks"], 4000);
  EXPECT_EQ(json["final_position"][1], 40);
}

TEST(Info, NamesAxesAndClock) {
  const Command command;
  const Outcome outcome = command.run("info --axes 8 --clock 2500000");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("axes           8\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("2500000 Hz"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("build          00000000\nboard          0\n"), std::string::npos) << outcome.out;
}

TEST(Info, ShowsTheUnitsAsATable) {
  const Command command;
  const Outcome outcome = command.run("info --axes 5");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* row :
       {"unit               version instances  registers words stride  with\n",
        "time_base              1.1         1      0x640     4         classes\n",
        "axes                   1.2         5      0x800     7     32\n", "host_ports             1.0         1\n"}) {
    EXPECT_NE(outcome.out.find(row), std::string::npos) << row << outcome.out;
  }
}

TEST(Run, MachineOfThreeAxesOnBothEngines) {
  const Command command;
  std::string machine = contents(TRAMMEL_EXAMPLES_DIR "/machine.toml");
  machine.resize(machine.find("[axis.e]"));
  const std::string run = "run " + command.write("ok.ngc", "G1 X1 Y-2 Z0.5 F600\n") + " --machine " +
                          command.write("machine.toml", machine) + " --json " + command.path("out.json");
  for (const std::string engine : {"rtl", "model"}) {
    const Outcome outcome = command.run(run + " --engine " + engine);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_json(command.path("out.json"))["final_position"], (std::vector<int>{80, -160, 40}));
  }
}

TEST(Run, TraceIsWritten) {
  const Command command;
  const Outcome outcome =
      command.run("run " + command.write("ok.ngc", "G1 X0.1 F600\n") + " --trace " + command.path("x.fst"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GT(std::filesystem::file_size(command.path("x.fst")), 1000U);
}

// Checks the tags: each is closed by its own name, in order, and one element contains all. Attributes hold no '<' or
// '>'.
testing::AssertionResult is_well_formed(const std::string& text) {
  std::vector<std::string> open;
  int roots = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.find_first_of("<>", at + 1);
    if (end == std::string::npos || text[end] != '>') return testing::AssertionFailure() << "broken tag at " << at;
    const std::string tag = text.substr(at + 1, end - at - 1);
    if (tag.empty()) return testing::AssertionFailure() << "empty tag at " << at;
    if (tag[0] == '?' || tag[0] == '!') continue;
    const bool closes = tag[0] == '/';
    const std::string name = tag.substr(closes ? 1 : 0, tag.find_first_of(" /\n", 1) - (closes ? 1 : 0));
    if (closes) {
      if (open.empty() || open.back() != name) return testing::AssertionFailure() << "stray </" << name << ">";
      open.pop_back();
      continue;
    }
    if (open.empty()) ++roots;
    if (tag.back() != '/') open.push_back(name);
  }
  if (!open.empty()) return testing::AssertionFailure() << "<" << open.back() << "> is never closed";
  if (roots != 1) return testing::AssertionFailure() << roots << " root elements";
  return testing::AssertionSuccess();
}

TEST(Run, PictureOfALongProgramIsThinned) {
  std::string program = "G21 G90\nF9000\n";
  for (int i = 1; i <= 2000; ++i) {
    const double angle = 0.05 * i;
    program +=
        "G1 X" + std::to_string(0.01 * i * std::cos(angle)) + " Y" + std::to_string(0.01 * i * std::sin(angle)) + "\n";
  }
  const Command command;
  // The name contains characters that XML reserves.
  const Outcome outcome = command.run("run '" + command.write("a<b>&c.ngc", program) +
                                      "' --engine model --clock 1000000 --plot " + command.path("out.svg"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string svg = contents(command.path("out.svg"));
  EXPECT_LT(svg.size(), 5'000'000U);
  EXPECT_GT(svg.size(), 10'000U);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_NE(svg.find("a&lt;b&gt;&amp;c.ngc"), std::string::npos);
  EXPECT_NE(svg.find(">pulses, thinned<"), std::string::npos);
}

TEST(Commands, MachineChecks) {
  const Command command;
  const Outcome outcome = command.run("machine --check --machine built-in");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("axis Z: stops from 100 mm/s"));
  EXPECT_EQ(command.run("machine").status, 2);
}

}  // namespace
}  // namespace trammel::test
