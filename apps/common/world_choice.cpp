#include "world_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "errors.hpp"
#include "trammel/world/world_file.hpp"

namespace trammel::app {
namespace {

double world_mm(const world::World& world, std::size_t axis, std::int64_t pulses) {
  return static_cast<double>(pulses) / world.axis(axis).pulses_a_mm;
}

// The machine one second later, without further pulses, because it still oscillates when the card has ended.
world::World at_rest(world::World world) {
  world.set_watcher(nullptr);
  world.run_to(world.now() + world.clock_hz());
  return world;
}

void refuse_wired_inputs(const world::World& world, const std::vector<simulation::OperatorEvent>& inputs) {
  using Kind = simulation::OperatorEvent::Kind;
  for (const simulation::OperatorEvent& event : inputs) {
    const bool wired = (event.kind == Kind::kInput && (world.wired() >> event.input & 1U) != 0) ||
                       (event.kind == Kind::kEmergencyStop && world.has_emergency_stop());
    if (!wired) continue;
    const std::string pin = event.kind == Kind::kInput ? fmt::format("input {}", event.input) : "the emergency stop";
    throw UsageError(fmt::format(
        "--input-at: {} is wired to a switch or button of the world. Press it with --world-events instead", pin));
  }
}

}  // namespace

void WorldChoice::add_to(CLI::App& command) {
  CLI::Option* const option =
      command
          .add_option("--world", file,
                      "simulate a machine behind the simulated card's pins, with carriages, switches and buttons. FILE "
                      "is a world file, or 'default' for the built-in one")
          ->type_name("FILE");
  command
      .add_option("--world-events", events,
                  "script that presses the world's buttons, one event per line, such as: at 1.5 s press estop; at 2 s "
                  "release estop; at 3 s alarm X")
      ->type_name("FILE")
      ->needs(option);
}

void WorldChoice::refuse_with(const CardChoice& card) const { refuse_with_card(card, "--world", file.has_value()); }

std::unique_ptr<world::World> WorldChoice::make(std::uint32_t clock_hz,
                                                const std::vector<simulation::OperatorEvent>& inputs) const {
  if (!file) return nullptr;
  try {
    world::Description description = *file == "default" ? world::default_world() : world::load_world(*file);
    if (events) {
      const std::vector<world::Event> more = world::load_events(*events, description);
      description.events.insert(description.events.end(), more.begin(), more.end());
    }
    auto made = std::make_unique<world::World>(description, clock_hz);
    refuse_wired_inputs(*made, inputs);
    return made;
  } catch (const world::WorldError& error) {
    throw UsageError(error.what());
  }
}

std::unique_ptr<sim::Engine> in_world(world::World* world, std::unique_ptr<sim::Engine> engine) {
  if (world == nullptr) return engine;
  return std::make_unique<world::EngineInWorld>(std::move(engine), *world);
}

std::string world_text(const world::World& now, const char* between) {
  const world::World world = at_rest(now);
  std::vector<std::string> places;
  std::string apart;
  for (std::size_t n = 0; n < world.axes(); ++n) {
    const world::Carriage& carriage = world.carriage(n);
    const char letter = world.axis(n).letter;
    const double at = world_mm(world, n, carriage.place());
    places.push_back(fmt::format("{} {:.4f}", letter, at));
    if (carriage.place() == carriage.commanded()) continue;
    apart += fmt::format("{}{} has lost its place: the card counts {:.4f} mm, {} pulses from where it stands", between,
                         letter, world_mm(world, n, carriage.commanded()), carriage.commanded() - carriage.place());
  }
  const std::vector<std::string> pressed = now.pressed();
  return fmt::format("world: carriages at {} mm; pressed: {}{}", fmt::join(places, ", "),
                     pressed.empty() ? "nothing" : fmt::format("{}", fmt::join(pressed, ", ")), apart);
}

nlohmann::ordered_json world_json(const world::World& now) {
  const world::World world = at_rest(now);
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (std::size_t n = 0; n < world.axes(); ++n) {
    const world::Carriage& carriage = world.carriage(n);
    axes.push_back({{"axis", std::string(1, world.axis(n).letter)},
                    {"carriage", carriage.place()},
                    {"commanded", carriage.commanded()},
                    {"lost", carriage.lost()}});
  }
  return {{"axes", axes}, {"pressed", now.pressed()}};
}

}  // namespace trammel::app
