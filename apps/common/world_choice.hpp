// A machine behind the simulated card's pins: the options --world and --world-events.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "card_choice.hpp"
#include "command_line.hpp"
#include "trammel/simulation/operation.hpp"
#include "trammel/world/engine_in_world.hpp"

namespace trammel::app {

struct WorldChoice {
  std::optional<std::string> file;    // of --world; "default": the built-in one
  std::optional<std::string> events;  // of --world-events

  void add_to(CLI::App& command);
  // Throws UsageError where a world was chosen: the card is another.
  void refuse_with(const CardChoice& card) const;
  // Nothing without --world. Throws UsageError for what cannot be read, and where `inputs` sets one that the world
  // wires.
  std::unique_ptr<world::World> make(std::uint32_t clock_hz,
                                     const std::vector<simulation::OperatorEvent>& inputs) const;
};

// The engine in the world; itself where there is none.
std::unique_ptr<sim::Engine> in_world(world::World* world, std::unique_ptr<sim::Engine> engine);

// Where the carriages stand, what is pressed, and which of them stand elsewhere than the card counts; `between` these.
std::string world_text(const world::World& world, const char* between);
nlohmann::ordered_json world_json(const world::World& world);

}  // namespace trammel::app
