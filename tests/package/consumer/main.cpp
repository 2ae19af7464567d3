// Uses a header and a symbol of each library; fails if a line does not arrive.
#include <chrono>
#include <cstdio>
#include <string>

#include "trammel/card_map.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/model/deviation_accumulator.hpp"
#include "trammel/sim/engine.hpp"

int main() {
  using namespace trammel;
  const auto bus = sim::make_model_engine({});
  driver::Card card = driver::Card::open(*bus);
  driver::run_line(card, driver::plan_line(card.timing(), {20, 40}, std::chrono::milliseconds(1)));
  const driver::Snapshot snapshot = card.read_snapshot();
  std::printf("%s: x %d, y %d\n", std::string(card_map::find_register(card_map::reg::kMagic).entry->name).c_str(),
              snapshot.position[0], snapshot.position[1]);
  const model::DeviationAccumulator accumulator;
  return snapshot.position[0] == 20 && snapshot.position[1] == 40 && !accumulator.outputs().step_x ? 0 : 1;
}
