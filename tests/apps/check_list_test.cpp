// docs/user/first-powered-move.md: each command of the check list exists and has the options that the page uses. The
// steps that need no hand do on the simulated machine what the page says.
#include <gmock/gmock.h>

#include <regex>
#include <set>
#include <sstream>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;

// Command lines of the page's code blocks: indented by at least four, starting with `trammel`. Returned without that
// word.
std::vector<std::string> page_commands() {
  std::vector<std::string> commands;
  std::istringstream page(contents(TRAMMEL_EXAMPLES_DIR "/../docs/user/first-powered-move.md"));
  for (std::string line; std::getline(page, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin != std::string::npos && begin >= 4 && line.compare(begin, 8, "trammel ") == 0)
      commands.push_back(line.substr(begin + 8));
  }
  return commands;
}

TEST(CheckList, NamesCommandsAndOptionsThatThereAre) {
  const Command command;
  const std::vector<std::string> commands = page_commands();
  EXPECT_GT(commands.size(), 20U);
  std::set<std::string> names;
  for (const std::string& line : commands) {
    const std::string name = line.substr(0, line.find(' '));
    names.insert(name);
    const Outcome help = command.run("help " + name);
    EXPECT_EQ(help.status, 0) << line;
    const std::regex option(" (--[a-z-]+)");
    for (std::sregex_iterator at(line.begin(), line.end(), option), end; at != end; ++at)
      EXPECT_THAT(help.out, HasSubstr((*at)[1].str())) << line;
  }
  for (const char* const needed :
       {"info", "selftest", "monitor", "machine", "jog", "recover", "calibrate", "zero", "home"})
    EXPECT_EQ(names.count(needed), 1U) << needed;
}

// The page's command line that starts with `begin`.
std::string line_of(const std::string& begin) {
  for (const std::string& line : page_commands())
    if (line.compare(0, begin.size(), begin) == 0) return line;
  ADD_FAILURE() << "the page has no line " << begin;
  return {};
}

// Order of the steps: roles by a program that moves nothing, inputs at rest, a move, a limit, homing, a soft limit.
TEST(CheckList, RunsOnTheSimulatedMachine) {
  const Command command;
  Server server(command, "--engine model --fast --world default");
  const std::string machine = command.write("router.toml", contents(TRAMMEL_EXAMPLES_DIR "/first-machine.toml"));
  // Runs a line of the page on this card and this machine file. `instead`, if not empty, replaces the start of the
  // line.
  const auto step = [&](const std::string& begin, int status, const std::string& instead = "") {
    std::string line = line_of(begin);
    if (!instead.empty()) line = instead + line.substr(begin.size());
    line = std::regex_replace(line, std::regex("\\bCARD\\b"), server.moving());
    line = std::regex_replace(line, std::regex("router\\.toml"), machine);
    const Outcome outcome = command.run(line);
    EXPECT_EQ(outcome.status, status) << line << outcome.err;
    return outcome.out + outcome.err;
  };
  command.write("nothing.ngc", "M2\n");
  EXPECT_THAT(step("machine --check", 0), HasSubstr("limit switches: stop on a ramp"));
  EXPECT_THAT(step("info", 0), HasSubstr("axes"));
  EXPECT_THAT(step("selftest --card", 0), HasSubstr("0 requests sent again"));
  step("run nothing.ngc", 0, "run " + command.path("nothing.ngc"));
  EXPECT_THAT(step("monitor --card CARD --looks", 0), HasSubstr("at rest  input 1 (limit plus of axis 0)"));
  EXPECT_THAT(step("jog X1 ", 0), HasSubstr("the machine stands at X 1.0000"));
  EXPECT_THAT(step("jog X-1 ", 0), HasSubstr("the machine stands at X 0.0000"));
  EXPECT_THAT(step("jog X30 --speed 2", 1, "jog X-150 --speed 60"), HasSubstr("LIMIT (X minus)"));
  EXPECT_THAT(step("recover", 0), HasSubstr("stopped  by LIMIT (X minus)"));
  step("jog X-5 --speed 2 --clear-faults", 0, "jog X5 --speed 2 --clear-faults");
  step("home Z", 0);
  EXPECT_THAT(step("home --card", 0), HasSubstr("the edges of search and approach differ by"));
  EXPECT_THAT(step("jog X-10", 2), HasSubstr("soft limit"));
}

}  // namespace
}  // namespace trammel::test
