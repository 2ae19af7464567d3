// A machine behind the simulated card's pins: `trammel run --world` and `trammel serve --world`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BehindThePins : public ::testing::Test {
 protected:
  Outcome run_program(const std::string& text, const std::string& options) {
    return command_.run("run " + command_.write("p.ngc", text) +
                        " --engine model --clock 400000 --set inputs.x_limit_plus=1 " + options);
  }
  Command command_;
};

TEST_F(BehindThePins, TheCarriagesStandWhereTheCardCounts) {
  const Outcome run = run_program("G1 X5 Y-2 F6000\n", "--world default --json " + command_.path("r.json"));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out,
              HasSubstr("  world: carriages at X 5.0000, Y -2.0000, Z 0.0000, E 0.0000 mm; pressed: nothing\n"));
  const nlohmann::json world = read_json(command_.path("r.json"))["world"];
  EXPECT_EQ(world["axes"][1]["carriage"], -160);
  EXPECT_EQ(world["axes"][1]["commanded"], -160);
  EXPECT_EQ(world["axes"][1]["lost"], 0);
  EXPECT_TRUE(world["pressed"].empty());
}

TEST_F(BehindThePins, ALimitSwitchStopsTheRun) {
  const Outcome run = run_program("G1 X350 F9000\n", "--world " TRAMMEL_EXAMPLES_DIR "/world.toml");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("LIMIT (X plus)"), HasSubstr("note: world: carriages at X 300."),
                             HasSubstr("pressed: x_plus"), Not(HasSubstr("lost its place"))));
}

TEST_F(BehindThePins, AWeakMotorLosesItsPlace) {
  const std::string world = command_.write("weak.toml", "[axis.x]\ntorque = 0.045\n");
  const Outcome run = run_program("G1 X30 F9000\n", "--world " + world);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\n  X has lost its place: the card counts 30.0000 mm, "));
}

TEST_F(BehindThePins, AScriptPressesItsButtons) {
  const std::string script = command_.write("events.txt", "# the operator\nat 300 ms press estop\n");
  const Outcome run = run_program("G1 X100 F3000\n", "--world default --world-events " + script);
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("EMERGENCY_STOP"), HasSubstr("pressed: estop")));
}

TEST_F(BehindThePins, OfTheServedCardToo) {
  Server server(command_, "--engine model --fast --world default");
  const std::string file = command_.write("p.ngc", "G1 X350 F9000\n");
  const Outcome run = command_.run("run " + file + " --set inputs.x_limit_plus=1 --card " + server.moving());
  EXPECT_THAT(run.err, HasSubstr("LIMIT (X plus)"));
  EXPECT_THAT(server.end(), AllOf(HasSubstr("note: world: carriages at X 300."), HasSubstr("pressed: x_plus")));
}

TEST_F(BehindThePins, WhatDoesNotGoTogetherIsRefused) {
  const auto refused = [&](const std::string& options) {
    const Outcome run = run_program("G1 X1 F600\n", options);
    EXPECT_EQ(run.status, 2) << options << run.err;
    return run.err;
  };
  EXPECT_THAT(refused("--world " + command_.path("none.toml")), HasSubstr("none.toml: cannot read the world file"));
  const std::string wrong = command_.write("wrong.toml", "[axis.x]\nmas = 2\n");
  EXPECT_THAT(refused("--world " + wrong), HasSubstr("wrong.toml:2: unknown entry axis.x.mas"));
  EXPECT_THAT(refused("--world default --input-at 1:1:1"),
              HasSubstr("--input-at: input 1 is wired to a switch or button"));
  EXPECT_THAT(refused("--world default --input-at 1:estop:1"),
              HasSubstr("the emergency stop is wired to a switch or button"));
  EXPECT_THAT(refused("--world default --check"), HasSubstr("--world: not with --check, which runs nothing"));
  EXPECT_THAT(refused("--world-events " + wrong), HasSubstr("--world"));
  const std::string high = command_.write("high.toml", "[axis.x]\n[button.a]\ninput = 20\n");
  EXPECT_THAT(refused("--world " + high), HasSubstr("high.toml:3: button.a.input must be a whole number, 0 to 15"));
  const Outcome card = command_.run("run " + command_.path("p.ngc") + " --world default --card tcp://127.0.0.1:1");
  EXPECT_EQ(card.status, 2);
  EXPECT_THAT(card.err, HasSubstr("--world"));
}

}  // namespace
}  // namespace trammel::test
