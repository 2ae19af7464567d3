// The programs of examples/other-hosts on served cards, by another URL. On these cards they check the axes' end
// positions only; the pulses are checked on cards in their own process.
#include <gtest/gtest.h>

#include <cstdlib>
#include <initializer_list>
#include <string>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

void expect_served(const std::string& engine, std::initializer_list<const char*> programs) {
  const Command command;
  Server server(command, "--fast --engine " + engine);
  for (const char* const program : programs) {
    const std::string line =
        "'" + std::string(program) + "' " + server.moving() + " >'" + command.path("out") + "' 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0) << contents(command.path("out"));
  }
  const std::string said = server.end();
  EXPECT_NE(said.find("served " + std::to_string(programs.size())), std::string::npos) << said;
}

TEST(OtherHosts, BlocksOnTheVerilatedCard) { expect_served("rtl", {PLANNER_BLOCKS}); }

TEST(OtherHosts, TheOthersOnTheModel) { expect_served("model", {TRAJECTORY, PICK_AND_PLACE}); }

}  // namespace
}  // namespace trammel::test
