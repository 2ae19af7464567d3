// The state as text, and the requests.
#include "trammel/world/state.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "trammel/world/world_file.hpp"

namespace trammel::world {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = Request::Kind;

constexpr std::uint32_t kStateClock = 1'000'000;

const char* const kStateWorld = R"(
[axis.x]
alarm = 8
[axis.z]
torque = 0.045
[switch.far]
input = 2
axis = "x"
above = 1
[button."sto\"p"]
emergency_stop = true
[button.hold]
input = 6
)";

World state_world() { return {parse_world(kStateWorld, "test world"), kStateClock}; }

std::string refusal_of(const std::string& line) {
  const World world = state_world();
  try {
    parse_request(line, world);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(WorldState, NamesWhatTheMachineIsLike) {
  World world = state_world();
  EXPECT_EQ(
      state_json(world),
      R"({"time_s":0.000000,"axes":[)"
      R"({"axis":"X","carriage_mm":0.0000,"commanded_mm":0.0000,"carriage":0,"commanded":0,"lost":0,"powered":true},)"
      R"({"axis":"Z","carriage_mm":0.0000,"commanded_mm":0.0000,"carriage":0,"commanded":0,"lost":0,"powered":true}],)"
      R"("switches":[{"name":"far","input":2,"pressed":false}],)"
      R"("buttons":[{"name":"x_alarm","input":8,"pressed":false},{"name":"sto\"p","input":"estop","pressed":false},)"
      R"({"name":"hold","input":6,"pressed":false}],)"
      R"("pressed":[],"inputs":320,"emergency_stop":false,"path":{"steps":0,"identity":""}})");
  for (int n = 0; n < 100; ++n) world.pulse(world.now() + 1000, 0, +1);
  world.run_to(kStateClock);
  world.press("sto\"p");
  world.run_to(1'500'000);
  EXPECT_THAT(
      state_json(world, {12, "ab"}),
      AllOf(HasSubstr(R"("time_s":1.500000)"), HasSubstr(R"("carriage":100,"commanded":100,"lost":0,"powered":false)"),
            HasSubstr(R"("name":"far","input":2,"pressed":true)"), HasSubstr(R"("pressed":["far","sto\"p"])"),
            HasSubstr(R"("inputs":324,"emergency_stop":true,"path":{"steps":12,"identity":"ab"})")));
}

// Z has a weak motor: the card counts on, but the carriage does not follow.
TEST(WorldState, TellsLostStepsApartFromTheCardsCount) {
  World world = state_world();
  for (int n = 0; n < 4000; ++n) world.pulse(world.now() + 50, 1, +1);
  world.run_to(world.now() + kStateClock);
  const Carriage& z = world.carriage(1);
  ASSERT_GT(z.lost(), 0);
  EXPECT_THAT(state_json(world), HasSubstr(R"("commanded_mm":50.0000,"carriage":)" + std::to_string(z.place()) +
                                           R"(,"commanded":4000,"lost":)" + std::to_string(4000 - z.place())));
}

TEST(WorldState, RequestsAreRead) {
  const World world = state_world();
  EXPECT_EQ(parse_request("state", world).kind, Kind::kState);
  EXPECT_EQ(parse_request("count", world).kind, Kind::kCount);
  const Request press = parse_request("press hold", world);
  EXPECT_EQ(press.kind, Kind::kPress);
  EXPECT_EQ(press.button, "hold");
  EXPECT_FALSE(press.when);
  const Request clear = parse_request(" clear  X ", world);
  EXPECT_EQ(clear.kind, Kind::kRelease);
  EXPECT_EQ(clear.button, "x_alarm");
  const Request place = parse_request("release hold when z < -1.5", world);
  EXPECT_EQ(place.when->axis, 1U);
  EXPECT_FALSE(place.when->above);
  EXPECT_EQ(place.when->bound, -1.5);
  const Request steps = parse_request("alarm x when steps > 200", world);
  EXPECT_EQ(steps.kind, Kind::kPress);
  EXPECT_FALSE(steps.when->axis);
}

TEST(WorldState, ConditionsAreOfTheCarriageAndOfThePath) {
  World world = state_world();
  for (int n = 0; n < 160; ++n) world.pulse(world.now() + 1000, 0, +1);
  world.run_to(world.now() + kStateClock);
  const auto holds_now = [&](const std::string& condition, std::uint64_t steps = 0) {
    return holds(*parse_request("press hold when " + condition, world).when, world, steps);
  };
  EXPECT_TRUE(holds_now("X > 1.9"));
  EXPECT_FALSE(holds_now("X > 2.1"));
  EXPECT_TRUE(holds_now("X < 2.1"));
  EXPECT_FALSE(holds_now("X < 1.9"));
  EXPECT_FALSE(holds_now("steps > 7", 7));
  EXPECT_TRUE(holds_now("steps > 7", 8));
  EXPECT_TRUE(holds_now("steps < 7", 6));
}

TEST(WorldState, WhatIsNoRequestIsRefusedByName) {
  EXPECT_THAT(refusal_of("press far"), AllOf(HasSubstr("far: no such button"), HasSubstr("hold")));
  EXPECT_THAT(refusal_of("alarm Z"), HasSubstr("z_alarm: no such button"));
  EXPECT_THAT(refusal_of("press hold when Q > 1"), HasSubstr("Q: the world has no such axis"));
  EXPECT_THAT(refusal_of("press hold when X > near"), HasSubstr("near: is no number"));
  for (const char* line : {"", "press", "stat", "state now", "push hold", "press hold now", "press hold when X",
                           "press hold when X = 1", "press hold when X > 1 2", "count 2", "press hold when X > inf"}) {
    EXPECT_NE(refusal_of(line), "none") << line;
  }
}

}  // namespace
}  // namespace trammel::world
