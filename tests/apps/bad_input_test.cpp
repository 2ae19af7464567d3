// Input that the command cannot use: it prints one line, has the right exit status, and moves nothing.
#include <gtest/gtest.h>

#include "command.hpp"

namespace trammel::test {
namespace {

void expect_refused(const Command& command, const std::string& arguments, int status, const std::string& message) {
  const Outcome outcome = command.run(arguments + " --steps " + command.path("steps.csv"));
  EXPECT_EQ(outcome.status, status) << arguments;
  EXPECT_EQ(count_lines(outcome.err), 1U) << arguments << '\n' << outcome.err;
  EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << '\n' << outcome.err;
  EXPECT_LE(count_lines(contents(command.path("steps.csv"))), 1U) << arguments << ": a header at most";
}

struct Bad {
  const char* name;
  const char* program;
  const char* where;  // position that the message must name
};
// Prints the name in the names of the tests.
void PrintTo(const Bad& row, std::ostream* out) { *out << row.name; }

class BadProgram : public testing::TestWithParam<Bad> {};

// A valid move comes first. It must not be made either.
TEST_P(BadProgram, IsRefusedBeforeTheFirstStep) {
  const Command command;
  const std::string file = command.write("bad.ngc", std::string("G21 G90\nG0 X1\n") + GetParam().program + "\n");
  expect_refused(command, "run " + file, 2, std::string("bad.ngc:") + GetParam().where);
}

INSTANTIATE_TEST_SUITE_P(Programs, BadProgram,
                         testing::Values(Bad{"UnknownWord", "G1 X1 F100\nD5", "4: unsupported word 'D5'"},
                                         Bad{"UnknownG", "G96", "3:"}, Bad{"ArcRadius", "F100\nG2 X3 Y1 I5 J0", "4:"},
                                         Bad{"ArcOfRadiusZero", "F100 G2 X2 I0 J0", "3:"},
                                         Bad{"ArcRTooSmall", "F100\nG2 X9 R1", "4:"}, Bad{"FeedMissing", "G1 X2", "3:"},
                                         Bad{"FeedZero", "G1 X2 F0", "3:"}, Bad{"FeedNegative", "G1 X2 F-5", "3:"},
                                         Bad{"Malformed", "G1 X1.2.3 F100", "3: malformed number"},
                                         Bad{"NoNumber", "G1 X F100", "3:"},
                                         Bad{"BeyondCounters", "G1 X99999999 F100", "3:"}),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(BadInput, UnreadableProgram) {
  const Command command;
  expect_refused(command, "run " + command.path("none.ngc"), 2, "none.ngc: cannot read");
  expect_refused(command, "run " + command.path(""), 2, "directory");
}

TEST(BadInput, MachineFile) {
  const Command command;
  const std::string program = command.write("ok.ngc", "G1 X1 F600\n");
  const std::string good = contents(TRAMMEL_EXAMPLES_DIR "/machine.toml");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return command.write("machine.toml", text);
  };
  const std::string run = "run " + program + " --machine ";
  EXPECT_EQ(command.run(run + command.write("machine.toml", good)).status, 0) << "or nothing below proves anything";
  expect_refused(command, run + changed("max_velocity = 150 ", "# none "), 2, "max_velocity");
  expect_refused(command, run + changed("max_acceleration = 1000", "max_acceleration = -1000"), 2, "max_acceleration");
  expect_refused(command, run + changed("steps_per_mm = 80", "steps_per_mm = \"many\""), 2, "steps_per_mm");
  expect_refused(command, run + changed("[axis.x]", "[axis.x"), 2, "machine.toml");
  expect_refused(command, run + command.path("none.toml"), 2, "none.toml");
}

TEST(BadInput, Options) {
  const Command command;
  const std::string run = "run " + command.write("ok.ngc", "G1 X1 F600\n");
  expect_refused(command, run + " --set nothing=1", 2, "nothing");
  expect_refused(command, run + " --set axis.x.steps_per_mm=-1", 2, "axis.x.steps_per_mm");
  expect_refused(command, run + " --set axis.x.steps_per_mm", 2, "axis.x.steps_per_mm");
  expect_refused(command, run + " --engine model --trace " + command.path("x.fst"), 2, "--trace");
  expect_refused(command, run + " --engine other", 2, "--engine");
  expect_refused(command, run + " --clock 1000000.5", 2, "--clock");
  expect_refused(command, run + " --bogus", 2, "--bogus");
  expect_refused(command, "run", 2, "program");
}

TEST(BadInput, OutputsThatCannotBeWritten) {
  const Command command;
  const std::string run = "run " + command.write("ok.ngc", "G1 X1 F600\n");
  expect_refused(command, run + " --json " + command.path("none/out.json"), 2, "none/out.json");
  expect_refused(command, run + " --plot " + command.path("none/out.svg"), 2, "none/out.svg");
  expect_refused(command, run + " --path-steps " + command.path("none/out.csv"), 2, "none/out.csv");
}

TEST(BadInput, FullDisk) {
  const Command command;
  const Outcome outcome = command.run("run " + command.write("ok.ngc", "G1 X1 F600\n") + " --steps /dev/full");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
}

TEST(Help, OfEverySubcommand) {
  const Command command;
  for (const std::string subcommand :
       {"",        "run",     "line",      "info",     "serve", "monitor", "dump",    "selftest",  "drives", "steps",
        "methods", "compare", "reproduce", "position", "zero",  "recover", "machine", "calibrate", "world",  "panel"}) {
    const Outcome outcome = command.run(subcommand + " --help");
    EXPECT_EQ(outcome.status, 0) << subcommand;
    EXPECT_NE(outcome.out.find("Usage: trammel"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, "");
  }
  EXPECT_EQ(command.run("").status, 2) << "a subcommand is needed";
}

}  // namespace
}  // namespace trammel::test
