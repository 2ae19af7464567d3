// Real programs from other sources. Each runs on both engines. By default the clock is lower than the command's 1 MHz,
// so that each program takes about ten seconds. TRAMMEL_LONG=1 in the environment runs all of them at 1 MHz (up to 306
// million clocks on the Verilated card). The long program, octocat, runs in tests/hashes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using Pulses = std::array<std::int64_t, 4>;

const std::string kFolder = TRAMMEL_SHARED_GCODE_DIR "/";

// `end`: the last coordinates of the file, rounded to pulses at 80 steps/mm. `axes`: number of axes that move together.
struct Job {
  const char* name;
  const char* clock;  // Hz
  Pulses end;
  int axes;
};
// Prints the name in the names of the tests.
void PrintTo(const Job& row, std::ostream* out) { *out << row.name; }

class Jobs : public testing::TestWithParam<Job> {};

TEST_P(Jobs, RunsOnBothEngines) {
  const Job& job = GetParam();
  const std::string clock = std::getenv("TRAMMEL_LONG") != nullptr ? "1000000" : job.clock;
  const Command command;
  for (const std::string engine : {"model", "rtl"}) {
    const Outcome outcome = command.run("run " + kFolder + job.name + ".gcode --clock " + clock + " --engine " +
                                        engine + " --steps " + command.path(engine + ".steps") + " --path-steps " +
                                        command.path(engine + ".path") + " --json " + command.path(engine + ".json"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json json = read_json(command.path(engine + ".json"));
    EXPECT_EQ(json["final_position"].get<Pulses>(), job.end);
    EXPECT_LE(json["max_deviation"]["line"].get<double>(), std::sqrt(job.axes) / 2 + 0.001);
    EXPECT_LE(json["max_deviation"]["arc"].get<double>(), 1.1);
    EXPECT_EQ(json["mismatches"], 0);
    if (engine == "rtl") {
      EXPECT_GT(json["cycles"], 0);
      EXPECT_EQ(json["lockstep_cycles"], json["cycles"]);
    }
  }
  EXPECT_GT(read_steps(command.path("rtl.steps")).size(), 1000U);
  EXPECT_TRUE(contents(command.path("rtl.steps")) == contents(command.path("model.steps")));
  EXPECT_TRUE(contents(command.path("rtl.path")) == contents(command.path("model.path")));
}

std::string job_name(const testing::TestParamInfo<Job>& info) {
  std::string name = info.param.name;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Gcode, Jobs,
                         testing::Values(Job{"jsdc-laser", "25000", {0, 0, 0, 0}, 2},
                                         Job{"tball", "50000", {12482, -2388, 400, 0}, 2},
                                         Job{"arc-xz-plane", "100000", {1600, 0, 0, 0}, 2},
                                         Job{"arc-yz-plane", "200000", {0, 1600, 0, 0}, 2},
                                         Job{"g2-arc", "50000", {800, 800, 0, 0}, 2},
                                         // Its last line moves three axes.
                                         Job{"circle-inch", "50000", {0, 0, 508, 0}, 3}),
                         job_name);

// 300 mm/s and 3,000 mm/s^2: 887 s of motion, 73,118 commands.
TEST(Gcode, OctocatOnASlowBusHasNoUnderRun) {
  const Command command;
  std::string options = " --feed-scale 15 --set motion.junction_deviation=0.02";
  for (const char* axis : {"x", "y", "z", "e"}) {
    options += std::string(" --set axis.") + axis + ".max_velocity=300 --set axis." + axis + ".max_acceleration=3000";
  }
  const Outcome outcome =
      command.run("run " + kFolder + "octocat.gcode --engine model --clock 10000000 --limit-bus 8000" + options +
                  " --json " + command.path("o.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json = read_json(command.path("o.json"));
  EXPECT_EQ(json["under_runs"], 0);
  EXPECT_NEAR(json["seconds"].get<double>(), json["planned_seconds"].get<double>(), 0.5);
}

// The link has 115,200 baud in card time, too slow for a machine this fast (500 mm/s, 20,000 mm/s^2): the card holds on
// the path and continues. Frames over TCP, the card at 1 MHz.
void octocat_over_a_slow_line(const Command& command, const std::string& program, const std::string& engine) {
  std::string options = " --feed-scale 15 --set motion.junction_deviation=0.05";
  for (const char* axis : {"x", "y", "z", "e"}) {
    options += std::string(" --set axis.") + axis + ".max_velocity=500 --set axis." + axis + ".max_acceleration=20000";
  }
  const Outcome here =
      command.run("run " + program + options + " --engine model --clock 1000000 --json " + command.path("here.json"));
  ASSERT_EQ(here.status, 0) << here.err;
  Server server(command, "--baud 115200 --clock 1000000 --fast --once --engine " + engine);
  const Outcome there =
      command.run("run " + program + options + " --card " + server.moving() + " --json " + command.path("there.json"));
  ASSERT_EQ(there.status, 0) << there.err;
  const std::string end = server.wait();
  const nlohmann::json direct = read_json(command.path("here.json"));
  const nlohmann::json far = read_json(command.path("there.json"));
  EXPECT_EQ(far["final_position"], direct["final_position"]);
  EXPECT_EQ(far["commands"], direct["commands"]);
  const std::string path = "path: " + std::to_string(direct["path_steps"]["count"].get<std::uint64_t>()) +
                           " steps, identity " + direct["path_steps"]["identity"].get<std::string>();
  EXPECT_NE(end.find(path), std::string::npos) << "not the same steps: " << end << path;
  EXPECT_EQ(direct["under_runs"], 0);
  EXPECT_GT(far["under_runs"], 0) << "the line was not what held it up";
  EXPECT_GT(far["seconds"].get<double>(), direct["seconds"].get<double>() + 1);
  EXPECT_EQ(far["link"]["reconnections"], 0);
  EXPECT_EQ(end.find("0 mismatches") != std::string::npos, engine == "rtl") << end;
  testing::Test::RecordProperty("under_runs", far["under_runs"].get<int>());
}

TEST(Gcode, OctocatsFirstLinesOverASlowLineToTheVerilatedCard) {
  const Command command;
  std::ifstream in(kFolder + "octocat.gcode");
  std::string text;
  std::string line;
  for (int i = 0; i < 2000 && std::getline(in, line); ++i) text += line + '\n';
  octocat_over_a_slow_line(command, command.write("octocat.gcode", text), "rtl");
}

TEST(Gcode, OctocatOverASlowLine) {
  if (std::getenv("TRAMMEL_LONG") == nullptr) GTEST_SKIP() << "with --long: some minutes";
  octocat_over_a_slow_line(Command(), kFolder + "octocat.gcode", "model");
}

void expect_refused(const std::string& name, const std::string& line) {
  const Command command;
  const Outcome outcome = command.run("run " + kFolder + name + " --steps " + command.path("steps.csv"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find(name + ":" + line + ":"), std::string::npos) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_LE(count_lines(contents(command.path("steps.csv"))), 1U) << "a header at most";
}

TEST(Gcode, CircleDiamondSquareIsRefused) { expect_refused("circle-diamond-square.gcode", "624"); }
TEST(Gcode, FullCircleWithoutXyzIsRefused) { expect_refused("full-circle-without-xyz.gcode", "11"); }

}  // namespace
}  // namespace trammel::test
