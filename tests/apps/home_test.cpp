// `trammel home` on a served card with a machine behind its pins.
#include <gmock/gmock.h>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;

const std::string kMachine = TRAMMEL_EXAMPLES_DIR "/first-machine.toml";

class HomeCommand : public ::testing::Test {
 protected:
  Outcome on_card(const std::string& arguments) const {
    return command_.run(arguments + " --machine " + kMachine + " --card " + server_.moving());
  }

  Command command_;
  Server server_{command_, "--engine model --fast --world default"};
};

TEST_F(HomeCommand, AllAxesOfTheDefaultWorld) {
  const Outcome home = on_card("home");
  EXPECT_EQ(home.status, 0) << home.err;
  EXPECT_THAT(home.err, HasSubstr("Z: searches its switch at 30 mm/s, at most 159.5 mm"));
  EXPECT_THAT(home.out, HasSubstr("X homed: the edges of search and approach differ by 0.0"));
  EXPECT_THAT(home.out, HasSubstr("the machine stands at X 0.0000 Y 0.0000 Z 0.0000 mm"));
  const Outcome position = on_card("position");
  EXPECT_THAT(position.out, HasSubstr("valid, homed"));
  EXPECT_THAT(position.out, ::testing::Not(HasSubstr("not homed")));
  // The soft limits are in force now, and no carriage has run into an end.
  const Outcome jog = on_card("jog X-10");
  EXPECT_EQ(jog.status, 2) << jog.out;
  EXPECT_THAT(server_.end(), HasSubstr("world: carriages at X -98.0"));
}

TEST_F(HomeCommand, OneAxisAlone) {
  const Outcome home = on_card("home z");
  EXPECT_EQ(home.status, 0) << home.err;
  const Outcome position = on_card("position");
  EXPECT_THAT(position.out, HasSubstr("X       0.0000 mm       valid, not homed"));
  EXPECT_THAT(position.out, HasSubstr("Z       0.0000 mm       valid, homed"));
}

TEST_F(HomeCommand, RefusesBeforeAnythingMoves) {
  EXPECT_THAT(on_card("home W").err, HasSubstr("home: the machine has no axis W"));
  const Outcome without = command_.run("home --card " + server_.moving());
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("no axis of the machine file has a [homing]"));
  EXPECT_THAT(command_.run("home").err, HasSubstr("home: needs --card"));
  EXPECT_THAT(on_card("position").out, HasSubstr("no position since the card's reset"));
}

TEST_F(HomeCommand, ASwitchThatDoesNotComeIsNamed) {
  const Outcome home = on_card("home X --set homing.x.search_distance=20");
  EXPECT_EQ(home.status, 1);
  EXPECT_THAT(home.err, HasSubstr("X: its home switch at input 0 did not become active within 20 mm at 40 mm/s"));
  EXPECT_THAT(on_card("position").out, HasSubstr("no position since the card's reset"));
}

}  // namespace
}  // namespace trammel::test
