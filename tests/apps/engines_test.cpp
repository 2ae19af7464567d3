// The two engines, at the same clock, make the same pulses in the same cycles. (examples/part.ngc: tests/hashes.)
#include <gtest/gtest.h>

#include "command.hpp"

namespace trammel::test {
namespace {

class Engines : public testing::TestWithParam<const char*> {};

TEST_P(Engines, GiveTheSameStepLists) {
  const Command command;
  for (const std::string engine : {"rtl", "model"}) {
    const Outcome outcome =
        command.run(std::string("run " TRAMMEL_EXAMPLES_DIR "/") + GetParam() + ".ngc --clock 1000000 --engine " +
                    engine + " --steps " + command.path(engine + ".steps") + " --path-steps " +
                    command.path(engine + ".path") + " --json " + command.path(engine + ".json"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_GT(read_steps(command.path("rtl.steps")).size(), 1000U);
  EXPECT_TRUE(contents(command.path("rtl.steps")) == contents(command.path("model.steps")));
  EXPECT_GT(count_lines(contents(command.path("rtl.path"))), 1000U);
  EXPECT_TRUE(contents(command.path("rtl.path")) == contents(command.path("model.path")));
  const nlohmann::json rtl = read_json(command.path("rtl.json"));
  const nlohmann::json model = read_json(command.path("model.json"));
  for (const char* key : {"final_position", "steps", "max_deviation", "segments", "commands", "clock_hz"}) {
    EXPECT_EQ(rtl[key], model[key]) << key;
  }
  EXPECT_EQ(rtl["lockstep_cycles"], rtl["cycles"]);
  EXPECT_EQ(rtl["mismatches"], 0);
  EXPECT_TRUE(model["lockstep_cycles"].is_null());
}

INSTANTIATE_TEST_SUITE_P(Examples, Engines, testing::Values("extruder"),
                         [](const auto& row) { return std::string(row.param); });

}  // namespace
}  // namespace trammel::test
