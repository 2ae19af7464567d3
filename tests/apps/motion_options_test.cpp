// Actions of an operator during a run: overrides, holds, a slow bus, a start in the middle. The path stays the same,
// step by step; only the times differ.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <random>
#include <sstream>

#include "command.hpp"

namespace trammel::test {
namespace {

// Output of one run.
struct Made {
  nlohmann::json json;
  std::string path;  // contents of the file of --path-steps
  std::vector<Step> pins;
};

// Arcs, lines of three axes and reversals.
constexpr char kProgram[] =
    "F1500\nG1 X8 Y3\nG2 X12 Y7 I4\nG1 X2 Y9.3 Z1.7\nG3 X2 Y9.3 J-3\nG1 X9\nX3\nX4.1\nG4 P0.05\nG0 X0 Y0 Z0\nM2\n";

class Operator : public testing::Test {
 protected:
  Made run(const std::string& program, const std::string& options) {
    const Outcome outcome =
        command_.run("run " + program + " --clock 250000 --engine model " + options + " --json " + command_.path("j") +
                     " --steps " + command_.path("s") + " --path-steps " + command_.path("p"));
    EXPECT_EQ(outcome.status, 0) << options << ": " << outcome.err;
    return {read_json(command_.path("j")), contents(command_.path("p")), read_steps(command_.path("s"))};
  }
  // The directions of each axis's pulses, in order, without their times.
  static std::map<unsigned, std::string> order(const std::vector<Step>& pins) {
    std::map<unsigned, std::string> result;
    for (const Step& step : pins) result[step.axis] += step.direction > 0 ? '+' : '-';
    return result;
  }
  // The path steps with consecutive numbers of their paths instead of the commands' numbers.
  static std::vector<std::string> paths_in_order(const std::string& path) {
    std::vector<std::string> result;
    std::istringstream rows(path);
    std::string row;
    std::string command;
    int paths = 0;
    std::getline(rows, row);
    while (std::getline(rows, row)) {
      const std::size_t comma = row.find(',');
      if (row.substr(0, comma) != command) ++paths;
      command = row.substr(0, comma);
      result.push_back(std::to_string(paths) + row.substr(comma));
    }
    return result;
  }
  void expect_same_path(const Made& made, const Made& other, const std::string& what) {
    EXPECT_TRUE(made.path == other.path) << what;
    EXPECT_EQ(made.json["path_steps"], other.json["path_steps"]) << what;
    EXPECT_EQ(made.json["final_position"], other.json["final_position"]) << what;
    EXPECT_EQ(made.json["shaper_delay"], other.json["shaper_delay"]) << what;
    EXPECT_TRUE(order(made.pins) == order(other.pins)) << what;
  }

  Command command_;
};

// Ten times in the run, in order, far enough apart for one hold each.
std::vector<double> ten_moments(unsigned seed, double seconds) {
  std::mt19937_64 random(seed);
  std::vector<double> result;
  for (int i = 0; i < 10; ++i) result.push_back((i + std::uniform_real_distribution<>(0, 0.5)(random)) * seconds / 10);
  return result;
}

// 8 directions stay within half a pulse of the circle, 4 within one.
TEST_F(Operator, TheAccumulatorMakesArcsIn8DirectionsOnlyIfAsked) {
  const std::string program = command_.write("circle.ngc", "F1200\nG2 X0 Y0 I5\nM2\n");
  const auto deviation = [&](const std::string& arcs) {
    return run(program, "--arcs " + arcs).json["max_deviation"]["arc"].get<double>();
  };
  EXPECT_GT(deviation("accumulator"), 0.9);
  EXPECT_LT(deviation("accumulator-8"), 0.51);
}

TEST_F(Operator, NothingThatHappensInTimeMovesThePath) {
  const std::string program = command_.write("a.ngc", kProgram);
  const Made plain = run(program, "");
  const double seconds = plain.json["seconds"];
  ASSERT_GT(plain.json["path_steps"]["count"], 4000);
  std::string holds;
  for (const double at : ten_moments(1, seconds)) holds += fmt::format(" --hold-at {}:{}", at, seconds / 40);
  std::string overrides;
  int percent = 20;
  for (const double at : ten_moments(2, seconds)) {
    overrides += fmt::format(" --override-at {}:{}", at, percent);
    percent = (percent + 67) % 100 + 1;
  }
  for (const std::string& options :
       {std::string("--override 37"), holds, overrides, holds + overrides, std::string("--limit-bus 150")}) {
    const Made other = run(program, options);
    expect_same_path(plain, other, options);
    EXPECT_GT(other.json["seconds"], seconds * 1.03) << options << " took time";
    EXPECT_LT(other.json["feed"]["achieved"], plain.json["feed"]["achieved"]) << options;
    EXPECT_EQ(other.json["feed"]["commanded"], plain.json["feed"]["commanded"]) << options;
  }
  EXPECT_NEAR(run(program, "--override 37").json["feed"]["achieved"].get<double>(),
              0.37 * plain.json["feed"]["achieved"].get<double>(), 2);
}

TEST_F(Operator, TheSummaryCountsUnderRunsAndTheirTime) {
  const std::string program = command_.write("p.ngc", kProgram);
  const std::string options = "run " + program + " --clock 250000 --engine model";
  EXPECT_NE(command_.run(options).out.find("under-runs: 0\n"), std::string::npos);
  const Made late = run(program, "--limit-bus 150");
  const int count = late.json["under_runs"].get<int>();
  EXPECT_GT(count, 0);
  const std::string text = command_.run(options + " --limit-bus 150").out;
  EXPECT_THAT(
      text, testing::ContainsRegex(fmt::format("under-runs: {}, [1-9][0-9]*[.][0-9]+ s longer than planned\n", count)));
}

// The identity distinguishes paths that have the same end and the same number of steps.
TEST_F(Operator, AnotherPathHasAnotherIdentity) {
  const Made one = run(command_.write("a.ngc", "G1 X3 Y1 F900\nX0 Y0\n"), "");
  const Made other = run(command_.write("b.ngc", "G1 X3 F900\nX0\nY1\nY0\n"), "");
  EXPECT_EQ(one.json["path_steps"]["count"], other.json["path_steps"]["count"]);
  EXPECT_NE(one.json["path_steps"]["identity"], other.json["path_steps"]["identity"]);
}

TEST_F(Operator, EventsComeAtTheirClockOnBothEngines) {
  const std::string program = command_.write("a.ngc", "G1 X4 F1200\nX2 Y1\n");
  for (const std::string bus : {"", " --limit-bus 2000"}) {
    std::vector<std::string> lists;
    for (const std::string engine : {"rtl", "model"}) {
      const Outcome outcome =
          command_.run("run " + program + " --clock 1000000 --engine " + engine + bus +
                       " --override-at 0.0005:80 --hold-at 0.1:0.05 --override-at 0.2:55.5 --json " +
                       command_.path("j") + " --steps " + command_.path(engine));
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      const nlohmann::json json = read_json(command_.path("j"));
      ASSERT_EQ(json["events"].size(), 4U);
      std::string text;
      for (const nlohmann::json& event : json["events"]) {
        const double due = event["seconds"].get<double>() * 1e6;
        EXPECT_GE(event["cycle"], due);
        EXPECT_LE(event["cycle"], due + 20);
        text += event.dump();
      }
      EXPECT_EQ(json["events"][1]["event"], "hold");
      EXPECT_EQ(json["events"][2]["event"], "resume");
      EXPECT_EQ(json["events"][3]["percent"], 55.5);
      lists.push_back(text + contents(command_.path(engine)));
    }
    EXPECT_TRUE(lists[0] == lists[1]) << bus;
  }
}

// 20 mm/s, on a machine whose slew takes 2 * 150 / 1000 s from full speed: stopping and starting take 3 mm each.
TEST_F(Operator, AHoldIsARampOnThePathAndItsTimeCountsFromTheRequest) {
  const std::string program = command_.write("a.ngc", "G1 X20 F1200\n");
  const Made plain = run(program, "");
  const Made held = run(program, "--hold-at 0.3:0.5");
  std::uint64_t gap = 0;
  std::uint64_t begin = 0;
  for (std::size_t i = 1; i < held.pins.size(); ++i) {
    const std::uint64_t between = held.pins[i].cycle - held.pins[i - 1].cycle;
    if (between > gap) {
      gap = between;
      begin = held.pins[i - 1].cycle;
    }
  }
  EXPECT_NEAR(static_cast<double>(begin) / 250000, 0.3 + 0.3 / 4, 0.02)
      << "at rest a quarter of the slew after the request: twice as fast would take more than half the acceleration";
  EXPECT_NEAR(static_cast<double>(begin + gap) / 250000, 0.8, 0.02) << "resumed half a second after the request";
  EXPECT_NEAR(held.json["seconds"].get<double>() - plain.json["seconds"].get<double>(), 0.5, 0.01)
      << "both slews at half the speed on the mean";
}

TEST_F(Operator, EventsAfterTheEndOfTheRunAreNamed) {
  const std::string run_it = "run " + command_.write("a.ngc", "G1 X2 F1200\n") + " --engine model --clock 250000";
  const Outcome outcome =
      command_.run(run_it + " --hold-at 0.01:0.01 --override-at 50:80 --hold-at 60:1 --input-at 70:1:1");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              testing::ContainsRegex("note: --override-at 50 had no effect: the run ended after 0[.][0-9]+ "
                                     "s of card time\n"));
  EXPECT_THAT(outcome.err, HasSubstr("--hold-at 60 had no effect"));
  EXPECT_THAT(outcome.err, HasSubstr("--input-at 70 had no effect"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("--hold-at 0.01")));
}

// The estimate of the card's time is right within half of it.
TEST_F(Operator, ABusTooSlowForTheMotionIsNamedBeforeTheRun) {
  const std::string run_it = "run " + command_.write("a.ngc", kProgram) + " --engine model --clock 250000";
  EXPECT_EQ(command_.run(run_it + " --limit-bus 100000").err, "");
  const Made late = run(command_.path("a.ngc"), "--limit-bus 10");
  const std::string note = command_.run(run_it + " --limit-bus 10").err;
  const std::size_t at = note.find(" commands take about ");
  ASSERT_NE(at, std::string::npos) << note;
  const double expected = std::stod(note.substr(at + 21));
  const double seconds = late.json["seconds"];
  EXPECT_GT(expected, 0.5 * seconds);
  EXPECT_LT(expected, 1.5 * seconds);
}

TEST_F(Operator, FeedScaleIsAFactorOnEveryFeed) {
  const std::string once = command_.write("a.ngc", "G1 X8 F600\nY3 F300\nG93 G2 X9 Y4 I1 F60\nG94 G4 P0.1\n");
  const std::string thrice = command_.write("b.ngc", "G1 X8 F1800\nY3 F900\nG93 G2 X9 Y4 I1 F180\nG94 G4 P0.1\n");
  const Made scaled = run(once, "--feed-scale 3");
  const Made written = run(thrice, "");
  EXPECT_TRUE(scaled.path == written.path);
  EXPECT_EQ(scaled.json["planned_seconds"], written.json["planned_seconds"]);
  EXPECT_LT(scaled.json["planned_seconds"], run(once, "").json["planned_seconds"]);
}

TEST_F(Operator, FromALineOnModesAndPositionAreRestored) {
  // Inches, relative coordinates, plane ZX and a feed are set above line 6.
  const std::string program =
      command_.write("a.ngc", "G20 G1 X1 Y0.5 F40\nG91\nG18\nZ0.25\nF30\nX0.2 Z0.1\nG2 X0.1 Z0.1 K0.1\nM2\n");
  const Made whole = run(program, "");
  const Made rest = run(program, "--from-line 6");
  EXPECT_EQ(rest.json["final_position"], whole.json["final_position"]);
  EXPECT_EQ(rest.json["segments"], 2);
  EXPECT_EQ(rest.json["steps"][0], 610) << "0.3 inches from 1 inch on, at 80 steps/mm";
  EXPECT_EQ(rest.json["steps"][1], 0);
  const std::map<unsigned, std::string> all = order(whole.pins);
  for (const auto& [axis, directions] : order(rest.pins)) {
    EXPECT_EQ(directions, all.at(axis).substr(all.at(axis).size() - directions.size()));
  }
}

// Steps of one path: tick, axis and direction.
using PathSteps = std::vector<std::array<long, 3>>;

std::vector<PathSteps> paths_of(const std::string& text) {
  std::vector<PathSteps> paths;
  std::istringstream rows(text);
  std::string row;
  std::getline(rows, row);
  for (long last = -1; std::getline(rows, row);) {
    std::array<long, 4> values{};
    std::replace(row.begin(), row.end(), ',', ' ');
    std::istringstream numbers(row);
    for (long& value : values) numbers >> value;
    if (values[0] != last) paths.emplace_back();
    last = values[0];
    paths.back().push_back({values[1], values[2], values[3]});
  }
  return paths;
}

// Lines and arcs of a few mm, with coordinates between the pulses.
std::string wandering_program(std::uint64_t seed, unsigned lines) {
  std::mt19937_64 random(seed);
  const auto mm = [&] { return (static_cast<double>(random() % 8001) - 4000) / 1000; };
  std::string text = "G1 F1500 X0\n";
  for (double x = 0, y = 0; lines != 0; --lines) {
    x += mm();
    y += mm();
    const bool arc = random() % 3 == 0;
    text += fmt::format("{} X{:.3f} Y{:.3f}{}\n", arc ? "G2" : "G1", x, y, arc ? " R9" : "");
  }
  return text + "M2\n";
}

// The whole program is planned, and the commands before the line are left out. Each path keeps its ticks of the whole
// run.
TEST_F(Operator, FromALineOnThePathsAreThoseOfTheWholeRun) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const std::string program = command_.write("a.ngc", wandering_program(seed, 30));
    const std::vector<PathSteps> whole = paths_of(run(program, "").path);
    const std::vector<PathSteps> rest = paths_of(run(program, fmt::format("--from-line {}", 5 + 2 * seed)).path);
    ASSERT_GT(rest.size(), 3U);
    ASSERT_LT(rest.size(), whole.size());
    EXPECT_TRUE(std::equal(rest.begin(), rest.end(), whole.end() - static_cast<std::ptrdiff_t>(rest.size()))) << seed;
  }
}

TEST_F(Operator, SingleBlockStopsBehindEachLine) {
  const std::string program = command_.write("a.ngc", kProgram);
  const Made plain = run(program, "");
  const Made single = run(program, "--single-block");
  // Stops add feed pieces, so the numbers of the paths' commands differ.
  EXPECT_EQ(paths_in_order(plain.path), paths_in_order(single.path));
  EXPECT_EQ(plain.json["final_position"], single.json["final_position"]);
  EXPECT_TRUE(order(plain.pins) == order(single.pins));
  EXPECT_GT(single.json["seconds"], plain.json["seconds"]) << "the card is idle between lines";
}

TEST_F(Operator, BlockDeleteSwitch) {
  const std::string program = command_.write("a.ngc", "G1 X1 F600\n / Y1\n/X2\n");
  EXPECT_EQ(run(program, "").json["final_position"], nlohmann::json({80, 0, 0, 0}));
  EXPECT_EQ(run(program, "--no-block-delete").json["final_position"], nlohmann::json({160, 80, 0, 0}));
}

TEST_F(Operator, CheckTellsTheTimeOfTheRunAndRunsNothing) {
  const std::string program = command_.write("a.ngc", std::string("G1 X100 F1200\n") + kProgram);
  const Made made = run(program, "--feed-scale 0.5");
  const Outcome outcome =
      command_.run("run " + program + " --check --feed-scale 0.5 --clock 250000 --json " + command_.path("check"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("nothing was run"), std::string::npos);
  const nlohmann::json check = read_json(command_.path("check"));
  EXPECT_NEAR(check["planned_seconds"].get<double>() / made.json["seconds"].get<double>(), 1, 0.001);
  for (const char* key : {"final_position", "segments", "commands", "axes", "program", "planned_seconds", "motion"}) {
    EXPECT_EQ(check[key], made.json[key]) << key;
  }
  EXPECT_FALSE(check.contains("cycles"));
  const Outcome bad = command_.run("run " + command_.write("b.ngc", "G1 X1 F600\nG1 Q\n") + " --check");
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.err.find("b.ngc:2: "), std::string::npos) << bad.err;
}

// The default machine has 1,000 mm/s^2. At 50,000 mm/s^3 the acceleration rises for 0.02 s, and a single move on an
// S-curve takes longer by this time than on a trapezoid.
TEST_F(Operator, TheProfileIsNamed) {
  const std::string program = command_.write("a.ngc", "G1 X20 F1200\n");
  std::string jerks;
  for (const std::string axis : {"x", "y", "z", "e"}) jerks += " --set axis." + axis + ".max_jerk=50000";
  struct Case {
    std::string options;
    std::string name;
    std::string text;
    double seconds;
  };
  for (const auto& [options, name, text, seconds] : std::vector<Case>{
           {"", "trapezoid", "  profile: trapezoid (S-curves need a max_jerk of X Y Z E)\n", 1.02},
           {jerks, "s-curve", "  profile: s-curve\n", 1.04},
           {jerks + " --profile trapezoid", "trapezoid", "  profile: trapezoid\n", 1.02},
           {"--set axis.x.max_jerk=50000", "trapezoid", "  profile: trapezoid (S-curves need a max_jerk of Y Z E)\n",
            1.02},
           {"--set axis.x.max_jerk=50000 --profile s-curve", "s-curve", "  profile: s-curve\n", 1.04},
       }) {
    SCOPED_TRACE(options);
    for (const std::string mode : {" --engine model --clock 1000000", " --check --clock 1000000"}) {
      const Outcome outcome = command_.run("run " + program + mode + " " + options + " --json " + command_.path("j"));
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_NE(outcome.out.find(text), std::string::npos) << outcome.out;
      EXPECT_EQ(outcome.err.find("max_jerk"), std::string::npos) << outcome.err;
      const nlohmann::json json = read_json(command_.path("j"));
      EXPECT_EQ(json["profile"], name);
      EXPECT_NEAR(json["planned_seconds"], seconds, 0.002);
    }
  }
}

TEST_F(Operator, SCurvesNeedTheJerkOfEachAxisThatMoves) {
  const std::string s_curve = " --check --profile s-curve --set axis.x.max_jerk=50000";
  // Two of them are a half circle that returns to its start's Y, and a full circle.
  const std::map<std::string, std::string> wrong{
      {"G1 X1 F600\nX2 Y1\n", "a.ngc:2: axis Y moves"}, {"G1 X1 F600\nG2 X3 I1\n", "a.ngc:2: axis Y moves"},
      {"G2 I1 F600\n", "a.ngc:1: axis Y moves"},        {"G18 G2 X1 Z1 I1 F600\n", "a.ngc:1: axis Z moves"},
      {"G1 X1 F600\nE1\n", "a.ngc:2: axis E moves"},
  };
  for (const auto& [text, message] : wrong) {
    const Outcome outcome = command_.run("run " + command_.write("a.ngc", text) + s_curve);
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_NE(outcome.err.find(message + " and has no max_jerk"), std::string::npos) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  }
  EXPECT_EQ(command_.run("run " + command_.write("a.ngc", "G1 X1 Y0 F600\nG4 P0.1\n") + s_curve).status, 0)
      << "Y stands";
}

TEST_F(Operator, AJerkThatIsNotPerCubicSecondIsToldOf) {
  const std::string run = "run " + command_.write("a.ngc", "G1 X1 F600\n") + " --check --set axis.x.max_jerk=";
  const Outcome slow = command_.run(run + "999");
  EXPECT_EQ(slow.status, 0);
  EXPECT_NE(slow.err.find("warning: axis X: at a max_jerk of 999 its acceleration takes 1 s to rise to 1000; max_jerk "
                          "is in mm/s^3"),
            std::string::npos)
      << slow.err;
  EXPECT_EQ(command_.run(run + "1000").err, "");
}

// The program is read once and runs in the same way. Standard input needs no copy.
TEST_F(Operator, StreamRunsWhatIsReadAndEndsAtRestWhereItIsWrong) {
  const Made whole = run(command_.write("a.ngc", kProgram), "");
  const Made streamed = run("- --stream <" + command_.path("a.ngc"), "");
  expect_same_path(whole, streamed, "stream");
  for (const char* key : {"segments", "commands", "planned_seconds", "cycles"}) {
    EXPECT_EQ(streamed.json[key], whole.json[key]) << key;
  }
  const Outcome outcome =
      command_.run("run - --stream --engine model --clock 250000 < <(printf 'G1 X3 F600\\nY2\\nG1 Q7\\nX0\\n')");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_NE(outcome.err.find("standard input:3: "), std::string::npos) << outcome.err;
  EXPECT_EQ(command_.run("run - <<< 'G1 Q7'").status, 2) << "without it nothing begins";
}

TEST_F(Operator, BadValuesAreRefusedWithTheirUnits) {
  const std::string program = command_.write("a.ngc", "G1 X1 F600\n");
  const std::map<std::string, std::string> wrong{
      {"--override 101", "101 is not an override from 0 to 100 percent (max_override"},
      {"--override fast", "fast is not an override from 0 to 100 percent"},
      {"--override=-1", "-1 is not an override from 0 to 100 percent"},
      {"--override 0", "0 percent at the end"},
      {"--override-at 1:50 --override-at 2:0", "0 percent at the end"},
      {"--override-at 1", "1 must be SECONDS:PERCENT"},
      {"--override-at x:5", "x is not a time from 0 to 1e+09 seconds of card time"},
      {"--override-at 1:500", "500 is not an override from 0 to 100 percent"},
      {"--hold-at 1", "1 must be SECONDS:DURATION, both in seconds"},
      {"--hold-at 1:-2", "-2 is not a duration from 0 to 1e+09 seconds of card time"},
      {"--hold-at 1:2 --hold-at 2:1", "begins before the one at 1 s is over"},
      {"--feed-scale 0", "must be a factor from 0.001 to 1000, not 0"},
      {"--limit-bus 0.5", "must be bytes per second from 1 to 1000000000, not 0.5"},
      {"--from-line 0", "must be a whole number, 1 to 4294967295, not 0"},
      {"--from-line 2", "a.ngc:1: the program ends before line 2"},
      {"--check --steps -", "--steps: not with --check, which runs nothing"},
      {"--stream --check", "--stream: not with --check, which runs nothing"},
      {"--stream --plot x.svg", "--plot: needs the whole program before the run"},
  };
  for (const auto& [options, message] : wrong) {
    const Outcome outcome = command_.run("run " + program + " " + options);
    EXPECT_EQ(outcome.status, 2) << options;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << options << ": " << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  }
}

}  // namespace
}  // namespace trammel::test
