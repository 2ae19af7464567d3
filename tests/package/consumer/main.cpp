// Uses a header and a symbol of each library; fails if a line does not reach its end point.
#include <chrono>
#include <cstdio>
#include <string>

#include "trammel/card_map.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/model/deviation_accumulator.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/world/engine_in_world.hpp"
#include "trammel/world/world_file.hpp"

int main() {
  using namespace trammel;
  const auto bus = sim::make_model_engine({});
  driver::Card card = driver::Card::open(*bus);
  driver::run_line(card, driver::plan_line(card.timing(), {20, 40}, std::chrono::milliseconds(1)));
  const driver::Snapshot snapshot = card.read_snapshot();
  std::printf("%s: x %d, y %d\n", std::string(card_map::find_register(card_map::reg::kMagic).entry->name).c_str(),
              snapshot.position[0], snapshot.position[1]);
  // The same line with a simulated machine, slow enough for its carriages to follow.
  world::World machine(world::default_world(), 1'000'000);
  world::EngineInWorld in_machine(sim::make_model_engine({}), machine);
  driver::Card moved = driver::Card::open(in_machine);
  driver::run_line(moved, driver::plan_line(moved.timing(), {20, 40}, std::chrono::milliseconds(100)));
  in_machine.wait(1'000'000);
  const bool followed = machine.carriage(0).place() == 20 && machine.carriage(1).place() == 40;
  const model::DeviationAccumulator accumulator;
  return snapshot.position[0] == 20 && snapshot.position[1] == 40 && !accumulator.outputs().step_x && followed ? 0 : 1;
}
