#include "linuxcnc_command.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/card_choice.hpp"
#include "common/errors.hpp"
#include "common/local_card.hpp"
#include "common/machine_choice.hpp"
#include "common/outputs.hpp"
#include "common/standard_streams.hpp"
#include "common/terminal.hpp"
#include "motion_record.hpp"
#include "paced_card.hpp"
#include "trammel/linuxcnc/bridge.hpp"
#include "trammel/linuxcnc/path_server.hpp"
#include "trammel/linuxcnc/refused_paths.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::app {
namespace {

struct LinuxcncOptions {
  std::string name = "0";
  std::string units = "mm";
  std::optional<std::string> record;
  LocalCardChoice local;
  MachineChoice machine;
  CardChoice card;
};

volatile sig_atomic_t g_linuxcnc_ended = 0;

// The first signal stops the machine on a ramp and ends the owner; the next one ends the process at once.
void end_linuxcnc_at_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_linuxcnc_ended = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

std::unique_ptr<linuxcnc::PathSide> path_side(const LinuxcncOptions& options, linuxcnc::Region& region,
                                              driver::Card& card, run::AttentiveBus& bus,
                                              const machine::Machine& machine) {
  const auto units = options.units == "mm" ? linuxcnc::PathUnits::kMillimetres : linuxcnc::PathUnits::kInches;
  try {
    return std::make_unique<linuxcnc::PathServer>(region.memory(), card, bus, machine, units);
  } catch (const std::invalid_argument& error) {
    tell("note", error.what());
    return linuxcnc::refuse_paths(region.memory());
  }
}

void tell_counts(const trammel_status& status) {
  tell("note", fmt::format("under-runs: {}; late periods: {}; dropped periods: {}; refused periods: {}", status.missing,
                           status.late, status.dropped, status.refused));
}

void serve_linuxcnc(const LinuxcncOptions& options, linuxcnc::Region& region, driver::Bus& card_bus,
                    const machine::Machine& machine, MotionRecord* record) {
  run::AttentiveBus bus(card_bus, linuxcnc::kServoPeriod);
  driver::Card card = driver::Card::open(bus);
  const auto path = path_side(options, region, card, bus, machine);
  linuxcnc::BridgeOptions bridge_options;
  bridge_options.note = [](const std::string& text) { tell("note", text); };
  bridge_options.record = record;
  linuxcnc::Bridge bridge(region, card, bus, machine, *path, bridge_options);
  end_linuxcnc_at_signals();
  to_standard_output(fmt::format("LinuxCNC finds the card as \"{}\" ({})\n", options.name, region.path()));
  finish_standard_streams();
  bridge.run([] { return g_linuxcnc_ended != 0; });
  tell_counts(bridge.status());
}

void linuxcnc_command(const LinuxcncOptions& options) {
  const machine::Machine machine = options.machine.load();
  Outputs outputs;
  Output* const file = outputs.add("--record", options.record);
  outputs.check();
  MotionRecord record(static_cast<unsigned>(machine.motors()));
  std::optional<linuxcnc::Region> region;
  try {
    region.emplace(options.name);
  } catch (const linuxcnc::RegionError& error) {
    throw UsageError(error.what());
  }
  MotionRecord* const recorded = file == nullptr ? nullptr : &record;
  if (const auto url = options.card.url()) {
    options.local.world.refuse_with(options.card);
    with_card(*url, Purpose::kMove, [&](driver::Card& card, transport::Connection& connection) {
      match_axes(card, machine);
      take_over(card, options.card, machine);
      serve_linuxcnc(options, *region, connection.bus(), machine, recorded);
    });
  } else {
    PacedCard local(options.local, static_cast<unsigned>(machine.motors()), recorded);
    serve_linuxcnc(options, *region, local, machine, recorded);
    tell("note", local.text());
  }
  if (file == nullptr) return;
  outputs.open();
  file->write(record.text());
  outputs.commit();
}

}  // namespace

void add_linuxcnc_command(CLI::App& app) {
  auto options = std::make_shared<LinuxcncOptions>();
  CLI::App* command = app.add_subcommand(
      "linuxcnc", "drive a card for LinuxCNC, whose HAL component or planner module sends the motion");
  command
      ->add_option("--name", options->name,
                   "name of the shared memory with LinuxCNC. Load LinuxCNC's modules with the same name (name=NAME)")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--units", options->units, "linear units of LinuxCNC. Needed for its planner module only")
      ->check(CLI::IsMember({"mm", "inch"}))
      ->capture_default_str();
  command
      ->add_option("--record", options->record,
                   "write each period as it was sent, and each step of a simulated card, to a CSV file")
      ->type_name("FILE");
  options->local.engine = "model";  // the Verilated card is too slow for one kilohertz
  options->local.add_to(*command);
  options->machine.add_to(*command);
  options->card.add_to_mover(*command);
  command->callback([options] { linuxcnc_command(*options); });
}

}  // namespace trammel::app
