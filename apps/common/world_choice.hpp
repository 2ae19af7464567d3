// A simulated machine behind the simulated card's pins: the options --world and --world-events.
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
  std::optional<std::string> file;    // file of --world; "default": the built-in one
  std::optional<std::string> events;  // file of --world-events

  void add_to(CLI::App& command);
  // Throws UsageError if a world was given together with an external card.
  void refuse_with(const CardChoice& card) const;
  // Null without --world. Throws UsageError for a file that cannot be read, and if `inputs` sets an input that the
  // world wires.
  std::unique_ptr<world::World> make(std::uint32_t clock_hz,
                                     const std::vector<simulation::OperatorEvent>& inputs) const;
};

// The engine connected to the world; the engine itself if `world` is null.
std::unique_ptr<sim::Engine> in_world(world::World* world, std::unique_ptr<sim::Engine> engine);

// The positions of the carriages, the pressed contacts, and the carriages whose position differs from the card's count;
// separated by `between`.
std::string world_text(const world::World& world, const char* between);
nlohmann::ordered_json world_json(const world::World& world);

}  // namespace trammel::app
