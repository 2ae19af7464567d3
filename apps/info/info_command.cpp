#include "info_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>
#include <memory>
#include <string>

#include "common/card_choice.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/outputs.hpp"
#include "common/waveform.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/simulation/simulated_card.hpp"

namespace trammel::app {
namespace {

constexpr std::uint32_t kInfoClock = 1'000'000;

struct InfoArguments {
  CardChoice card;
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

// A row of the table of units, without trailing blanks.
template <typename... Cells>
std::string row(const Cells&... cells) {
  std::string text = fmt::format("{:18} {:>7} {:>9}  {:>9} {:>5} {:>6}  {}", cells...);
  return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
}

std::string units(const driver::UnitTable& table) {
  std::string text = "\n" + row("unit", "version", "instances", "registers", "words", "stride", "with");
  for (const card_map::Descriptor& unit : table) {
    const bool has_registers = unit.words != 0;
    text += row(driver::unit_name(unit), fmt::format("{}.{}", unit.major, unit.minor), unit.instances,
                has_registers ? fmt::format("0x{:03X}", 4 * unit.base) : "",
                has_registers ? fmt::to_string(unit.words) : "",
                unit.stride != 0 && unit.instances > 1 ? fmt::to_string(unit.stride) : "", driver::feature_names(unit));
  }
  return text;
}

std::string describe(driver::Card& card) {
  std::string text;
  const auto out = std::back_inserter(text);
  const driver::Identification& id = card.identification();
  fmt::format_to(out, "register map   {}.{}\n", id.map_major, id.map_minor);
  fmt::format_to(out, "commands       version {}\n", id.commands_version);
  fmt::format_to(out, "axes           {}\n", id.axes);
  fmt::format_to(out, "clock          {} Hz\n", id.clock_hz);
  fmt::format_to(out, "engines        {}\n", engines(id.engines));
  fmt::format_to(out, "geometry queue {} halfwords\n", id.geometry_depth);
  fmt::format_to(out, "feed queue     {} halfwords\n", id.feed_depth);
  const driver::Build build = card.read_build();
  fmt::format_to(out, "build          {:08x}{}\n", build.id, build.dirty ? ", dirty" : "");
  fmt::format_to(out, "board          {}\n", build.board);
  const driver::Snapshot now = card.read_snapshot();
  fmt::format_to(out, "time           {} clocks since reset\n", now.time);
  for (unsigned axis = 0; axis < id.axes; ++axis)
    fmt::format_to(out, "axis {}         pulse {}\n", axis, now.position[axis]);
  fmt::format_to(out, "state          {}{}{}\n", now.status.busy ? "busy" : "idle",
                 now.status.faulted ? ", faulted" : "", now.status.refused ? ", refused" : "");
  return text + units(id.units);
}

void info_on_card(const InfoArguments& options, const transport::CardUrl& url) {
  options.engine.refuse_with(options.card);
  Outputs outputs;
  std::string text;
  with_card(url, Purpose::kRead, [&](driver::Card& card, transport::Connection&) { text = describe(card); });
  outputs.commit(text);
}

void info_in_simulation(const InfoArguments& options) {
  if (const auto url = options.card.url()) return info_on_card(options, *url);
  Outputs outputs;
  Output* const trace = outputs.add("--trace", options.engine.trace, true);
  outputs.check();
  sim::SimulationOptions engine_options = options.engine.options(options.axes, kInfoClock, kInfoClock);
  if (trace != nullptr && simulation::traced_axes(options.axes) != options.axes) {
    throw UsageError(fmt::format("--trace: works only on cards with 4 or 8 axes, not with {}", options.axes));
  }
  outputs.open();
  if (trace != nullptr) engine_options.trace->path = trace->path_to_write();
  const auto engine = sim::make_engine(engine_options);
  driver::Card card = driver::Card::open(*engine);
  const std::string text = describe(card);
  if (trace != nullptr) require_whole_waveform(trace->path_to_write(), *options.engine.trace);
  outputs.commit(text);
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto options = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "show a card's identification, units and state");
  options->card.add_to(*command);
  options->engine.add_to(*command);
  command->add_option("--axes", options->axes, "number of axes of the simulated card")
      ->transform(whole_number(1, card_map::kMaxAxes))
      ->capture_default_str();
  command->callback([options] { info_in_simulation(*options); });
}

}  // namespace trammel::app
