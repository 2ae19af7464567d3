// A card whose pins are connected to the default world or to a changed one, and programs that run on it.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "steps.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/world/engine_in_world.hpp"
#include "trammel/world/world_file.hpp"

namespace trammel::world {

inline constexpr std::uint32_t kCardClock = 400'000;  // Hz

// The text of the default world with the first `from` replaced.
inline std::string changed_world(const std::string& from, const std::string& to,
                                 std::string text = default_world_text()) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error(from + ": not in the default world");
  return text.replace(at, from.size(), to);
}

inline std::unique_ptr<sim::Engine> model_card(bool interrupt = false) {
  return sim::make_model_engine(sim::EngineOptions{4, kCardClock, interrupt});
}

class WorldCard {
 public:
  explicit WorldCard(const std::string& world_text, std::unique_ptr<sim::Engine> card_engine = model_card())
      : world(parse_world(world_text, "test world"), kCardClock), engine(std::move(card_engine), world) {
    engine.set_sink(&steps);
    machine::apply_override(machine, "inputs.x_limit_minus=0");
    machine::apply_override(machine, "inputs.x_limit_plus=1");
    machine::apply_override(machine, "inputs.z_limit_minus=4");
    machine::apply_override(machine, "inputs.filter=0.5");
    machine::apply_override(machine, "probe.input=9");
  }

  // Runs the program; returns "its end" or the message of the error that ended it.
  std::string end_of(const std::string& text) {
    const auto shared = std::make_shared<const std::string>(text);
    run::Runner runner([shared] { return std::make_unique<gcode::TextLines>(*shared, "p.ngc"); }, machine,
                       planner::limits_of(card.identification()));
    runner.plan();
    std::string end = "its end";
    try {
      runner.run(card);
    } catch (const std::exception& error) {
      end = error.what();
    }
    rest();
    return end;
  }
  // Waits for steps in flight and for the oscillation of the carriages.
  void rest() { engine.wait(kCardClock / 2); }

  World world;
  EngineInWorld engine;
  test::Steps steps;
  driver::Card card = driver::Card::open(engine);
  machine::Machine machine = machine::default_machine();
};

}  // namespace trammel::world
