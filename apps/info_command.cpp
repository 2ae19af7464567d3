#include "info_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "engine_options.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"

namespace trammel::app {
namespace {

constexpr std::uint32_t kDefaultClock = 1'000'000;

struct Options {
  EngineChoice engine;
  unsigned axes = 4;
};

std::string engines(std::uint32_t bits) {
  std::string text;
  for (std::uint32_t engine = 0; engine < card_map::kEngineNames.size(); ++engine) {
    if (!card_map::has_engine(bits, engine)) continue;
    if (!text.empty()) text += ", ";
    text += card_map::kEngineNames[engine];
  }
  return text;
}

void execute(const Options& options) {
  const auto engine = sim::make_engine(options.engine.options(options.axes, kDefaultClock, kDefaultClock));
  driver::Card card = driver::Card::open(*engine);
  const driver::Identification& id = card.identification();
  fmt::print("register map   {}.{}\n", id.map_major, id.map_minor);
  fmt::print("commands       version {}\n", id.commands_version);
  fmt::print("axes           {}\n", id.axes);
  fmt::print("clock          {} Hz\n", id.clock_hz);
  fmt::print("engines        {}\n", engines(id.engines));
  fmt::print("geometry queue {} halfwords\n", id.geometry_depth);
  fmt::print("feed queue     {} halfwords\n", id.feed_depth);
  const driver::Snapshot now = card.snapshot();
  fmt::print("time           {} clocks since reset\n", now.time);
  for (unsigned axis = 0; axis < id.axes; ++axis) fmt::print("axis {}         pulse {}\n", axis, now.position[axis]);
  fmt::print("state          {}{}{}\n", now.status.busy ? "busy" : "idle", now.status.faulted ? ", faulted" : "",
             now.status.refused ? ", refused" : "");
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("info", "what the card says of itself");
  options->engine.add_to(*command);
  command->add_option("--axes", options->axes, "axes of the simulated card")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command->callback([options] { execute(*options); });
}

}  // namespace trammel::app
