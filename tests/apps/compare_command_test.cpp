// The command `trammel compare`: figures of one line that were calculated by hand, and random lines whose figures do
// not depend on the number of threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "command.hpp"

namespace trammel::test {
namespace {

nlohmann::json compare(const Command& command, const std::string& arguments) {
  const Outcome outcome = command.run("compare " + arguments + " --json -");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

std::map<std::string, nlohmann::json> by_name(const nlohmann::json& comparison) {
  std::map<std::string, nlohmann::json> result;
  for (const nlohmann::json& method : comparison["methods"]) result[method["name"]] = method;
  return result;
}

TEST(Compare, OneLine) {
  const Command command;
  const auto methods = by_name(compare(command, "--line 0,0,7,5"));
  EXPECT_EQ(methods.size(), 9U);
  // One pulse per step; or both axes in one step, for as many steps as the shorter axis has pulses.
  EXPECT_EQ(methods.at("steer")["steps"], 12);
  EXPECT_EQ(methods.at("min-deviation-8")["steps"], 7);
  for (const auto& [name, method] : methods) EXPECT_EQ(method["pulses"], 12) << name;
  // For the one-shot line the host computes once.
  EXPECT_EQ(methods.at("one-shot")["host_operations"], 1);
  EXPECT_EQ(methods.at("steer")["host_operations"], 12);
  // Distances are |5x - 7y| / sqrt(74). The numerator is 6 at the farthest corner of the staircase, and 3 at best.
  const double length = std::sqrt(74.0);
  EXPECT_NEAR(methods.at("steer")["distance"]["perpendicular"]["largest"], 6 / length, 1e-9);
  EXPECT_NEAR(methods.at("min-deviation-8")["distance"]["perpendicular"]["largest"], 3 / length, 1e-9);
}

TEST(Compare, RandomLinesDoNotDependOnTheThreads) {
  const Command command;
  const nlohmann::json one = compare(command, "--random 3000 --seed 7 --threads 1");
  const nlohmann::json two = compare(command, "--random 3000 --seed 7 --threads 2");
  EXPECT_EQ(one, two);
  EXPECT_NE(one, compare(command, "--random 3000 --seed 8 --threads 2"));
  const auto methods = by_name(one);
  // The bounds that are proved for each method.
  EXPECT_LT(methods.at("steer")["distance"]["perpendicular"]["largest"], 1.0);
  EXPECT_LE(methods.at("min-deviation-8")["distance"]["perpendicular"]["largest"], 0.5);
  EXPECT_LE(methods.at("one-shot")["distance"]["perpendicular"]["largest"], std::sqrt(0.5) + 1e-6);
  for (const auto& [name, method] : methods) EXPECT_EQ(method["wrong_ends"], 0) << name;
}

TEST(Compare, WritesAPicture) {
  const Command command;
  const std::string picture = command.path("arc.svg");
  const Outcome outcome = command.run("compare --arc 12,0,0,0,0,12 --plot " + picture);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("min-deviation-8"));
  EXPECT_THAT(contents(picture), testing::HasSubstr("</svg>"));
}

TEST(Compare, BadInputIsOneLineAndStatus2) {
  const Command command;
  for (const char* arguments : {"", "--circle 0", "--random 0", "--random 5 --circle 3", "--line 0,0,0,0",
                                "--random 5 --plot x.svg", "--circle 5 --json /nonexistent/x.json"}) {
    const Outcome outcome = command.run(std::string("compare ") + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(count_lines(outcome.err), 1U) << arguments << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
  }
}

}  // namespace
}  // namespace trammel::test
