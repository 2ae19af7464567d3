// The command `trammel steps`: formats and exit statuses.
#include "steps/steps_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/errors.hpp"
#include "methods/methods_command.hpp"

namespace trammel::app {
namespace {

using ::testing::HasSubstr;

void run(std::vector<std::string> arguments) {
  CLI::App app("test", "trammel");
  add_steps_command(app);
  add_methods_command(app);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(arguments);
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

class StepsCommand : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(file_.c_str()); }
  std::string csv(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "steps");
    arguments.insert(arguments.end(), {"--csv", file_});
    run(arguments);
    return text_of(file_);
  }
  std::string refusal(const std::vector<std::string>& arguments) {
    try {
      csv(arguments);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "accepted";
  }
  std::string file_ = ::testing::TempDir() + "/steps_" + std::to_string(::getpid());
};

TEST_F(StepsCommand, WritesTableOne) {
  EXPECT_EQ(csv({"--method", "steer", "--line", "0,0,3,-7"}),
            "index,axis,direction,x,y,f\n"
            "0,y,-,0,0,-4\n1,y,-,0,-1,-1\n2,x,+,0,-2,2\n3,y,-,1,-2,-5\n4,y,-,1,-3,-2\n"
            "5,x,+,1,-4,1\n6,y,-,2,-4,-6\n7,y,-,2,-5,-3\n8,y,-,2,-6,0\n9,x,+,2,-7,3\n");
}

TEST_F(StepsCommand, DiagonalStepsAndMethodsWithoutDeviation) {
  EXPECT_EQ(csv({"--method", "one-shot", "--line", "-1,4,1,2"}),
            "index,axis,direction,x,y,f\n0,xy,+-,-1,4,\n1,xy,+-,0,3,\n");
  EXPECT_THAT(csv({"--method", "steer", "--arc", "15,10,10,10,10,15", "--clockwise"}), HasSubstr("\n0,y,-,15,10,0\n"));
}

TEST_F(StepsCommand, WritesJson) {
  run({"steps", "--method", "min-deviation-8", "--circle", "25", "--json", file_});
  const auto json = nlohmann::json::parse(text_of(file_));
  EXPECT_EQ(json["steps"], 140);
  EXPECT_EQ(json["path"].size(), 140u);
  EXPECT_EQ(json["start"], nlohmann::json({25, 0}));
  EXPECT_EQ(json["end"], nlohmann::json({25, 0}));
  EXPECT_EQ(json["path"][0]["f"], 0);
  run({"steps", "--method", "dda", "--line", "0,0,0,0", "--json", file_});
  EXPECT_TRUE(nlohmann::json::parse(text_of(file_))["path"].empty());
}

TEST_F(StepsCommand, LongLinesSlowDownUnlessAVelocityIsGiven) {
  EXPECT_EQ(refusal({"--method", "one-shot", "--line", "0,0,3000,1"}), "accepted");
  EXPECT_THAT(refusal({"--method", "one-shot", "--line", "0,0,3000,1", "--velocity", "5000"}),
              HasSubstr("one pulse a clock"));
}

TEST_F(StepsCommand, RefusesBadInput) {
  EXPECT_THAT(refusal({"--method", "stear", "--circle", "5"}), HasSubstr("no method \"stear\""));
  EXPECT_THAT(refusal({"--method", "steer"}), HasSubstr("one of"));
  EXPECT_THAT(refusal({"--method", "steer", "--circle", "5", "--line", "0,0,1,1"}), HasSubstr("one of"));
  EXPECT_THAT(refusal({"--method", "steer", "--circle", "0"}), HasSubstr("radius 0"));
  EXPECT_THAT(refusal({"--method", "steer", "--circle", "1"}), HasSubstr("passes the centre"));
  EXPECT_THAT(refusal({"--method", "steer", "--circle", "-5"}), HasSubstr("negative"));
  EXPECT_THAT(refusal({"--method", "steer", "--circle", "5.5"}), HasSubstr("whole numbers"));
  EXPECT_THAT(refusal({"--method", "steer", "--circle", ""}), HasSubstr("whole numbers"));
  EXPECT_THAT(refusal({"--method", "steer", "--line", "0,0,1"}), HasSubstr("4 needed"));
  EXPECT_THAT(refusal({"--method", "steer", "--line", "0,0,1,"}), HasSubstr("whole numbers"));
  EXPECT_THAT(refusal({"--method", "steer", "--line", "0,0,1,99999999999999999999"}), HasSubstr("64 bits"));
  EXPECT_THAT(refusal({"--method", "steer", "--arc", "5,0,0,0,0,7"}), HasSubstr("not on one circle"));
  EXPECT_THAT(refusal({"--method", "dda", "--ellipse", "5,3"}), HasSubstr("cannot do ellipses"));
  EXPECT_THAT(refusal({"--method", "dda", "--ellipse", "5,0"}), HasSubstr("1 pulse or more"));
  file_ = "/nonexistent/steps.csv";
  EXPECT_THAT(refusal({"--method", "steer", "--circle", "5"}), HasSubstr("cannot be written"));
}

TEST(MethodsCommand, ListsEveryMethod) {
  ::testing::internal::CaptureStdout();
  run({"methods"});
  const std::string text = ::testing::internal::GetCapturedStdout();
  for (const char* name : {"steer", "point-by-point", "min-f-4", "min-deviation-8", "dda", "dda-half", "one-shot",
                           "one-shot-zero", "divider", "rotation"}) {
    EXPECT_THAT(text, HasSubstr(std::string("\n") + name + " "));
  }
}

}  // namespace
}  // namespace trammel::app
