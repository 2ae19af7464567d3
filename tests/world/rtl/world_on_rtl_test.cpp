// The Verilated card in a world, in lockstep with the golden model: the same machine, step by step.
#include <gmock/gmock.h>

#include "../world_card.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::world {
namespace {

using ::testing::HasSubstr;

std::unique_ptr<sim::Engine> rtl_card() {
  sim::SimulationOptions options;
  options.axes = 4;
  options.clock_hz = kCardClock;
  options.rtl_thread = true;
  return sim::make_engine(options);
}

// Moves into the switch at +2 mm and back; then the emergency stop is pressed.
TEST(WorldOnRtl, LimitAndEmergencyStopAsOnTheModel) {
  const std::string text = "events = [\"at 900 ms press estop\"]\n" + changed_world("above = 300", "above = 2");
  WorldCard rtl(text, rtl_card());
  WorldCard model(text);
  for (WorldCard* c : {&rtl, &model}) {
    EXPECT_THAT(c->end_of("G1 X10 F3000\n"), HasSubstr("LIMIT (X plus)"));
    EXPECT_EQ(c->world.carriage(0).place(), c->engine.positions()[0]);
    EXPECT_TRUE(c->world.pressed("x_plus"));
    c->card.clear_faults();
    EXPECT_THAT(c->end_of("G91\nG1 X-100 F3000\n"), HasSubstr("EMERGENCY_STOP"));
  }
  EXPECT_EQ(rtl.engine.positions(), model.engine.positions());
  EXPECT_EQ(rtl.engine.cycles(), model.engine.cycles());
  EXPECT_EQ(rtl.world.carriage(0).position(), model.world.carriage(0).position());
  EXPECT_EQ(rtl.engine.lockstep_cycles(), rtl.engine.cycles());
  EXPECT_GT(rtl.engine.comparisons(), 0U);
}

}  // namespace
}  // namespace trammel::world
