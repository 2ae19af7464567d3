#include "panel_command.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "common/card_choice.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/local_card.hpp"
#include "common/machine_choice.hpp"
#include "common/standard_streams.hpp"
#include "common/terminal.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/grbl/card_machine.hpp"
#include "trammel/grbl/settings.hpp"
#include "trammel/panel/page.hpp"
#include "trammel/panel/server.hpp"
#include "trammel/panel/session.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::app {
namespace {

struct PanelOptions {
  std::string listen = "127.0.0.1:8090";
  std::optional<std::string> settings;
  LocalCardChoice local;
  MachineChoice machine;
  CardChoice card;
};

volatile sig_atomic_t g_panel_ended = 0;

// The first signal stops the machine on a ramp and ends the server; the next one ends the process at once.
void end_panel_at_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_panel_ended = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

panel::ServerSettings panel_address(const PanelOptions& options) {
  const std::size_t colon = options.listen.rfind(':');
  const std::string port = colon == std::string::npos ? "" : options.listen.substr(colon + 1);
  const bool number = !port.empty() && port.size() < 6 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!number || std::stoul(port) > 65535) throw UsageError("--listen: must be HOST:PORT, such as 127.0.0.1:8090");
  panel::ServerSettings settings;
  settings.host = options.listen.substr(0, colon);
  settings.port = static_cast<std::uint16_t>(std::stoul(port));
  settings.token = serve::random_token();
  settings.page = panel::page();
  return settings;
}

void warn_of_panel_network(const std::string& host) {
  if (host.rfind("127.", 0) == 0 || host == "localhost" || host == "::1" || host == "[::1]") return;
  tell("warning", fmt::format("--listen {}: the address with its token travels unencrypted, and whoever has it can "
                              "move the machine; use it only in a network that you trust",
                              host));
}

std::unique_ptr<panel::PanelServer> open_panel(const panel::ServerSettings& address, panel::PanelSession& session) {
  try {
    return std::make_unique<panel::PanelServer>(address, session);
  } catch (const driver::Error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("--listen: {}", error.what()));
  }
}

// Serves until a signal arrives.
void serve_page(const PanelOptions& options, driver::Card& card, run::AttentiveBus& bus,
                const machine::Machine& machine) {
  const panel::ServerSettings address = panel_address(options);
  warn_of_panel_network(address.host);
  grbl::Settings settings(machine, options.settings.value_or(""));
  grbl::CardMachine side(card, bus, settings.machine(), options.card.trust_position);
  panel::PanelSession session(side, settings);
  const std::unique_ptr<panel::PanelServer> server = open_panel(address, session);
  bool stopping = false;
  side.set_meanwhile([&] {
    server->turn();
    session.serve();
    if (g_panel_ended != 0 && !stopping) side.stop();
    stopping = g_panel_ended != 0;
  });
  session.begin();
  to_standard_output(fmt::format("panel at {}\n", server->url()));
  finish_standard_streams();
  while (g_panel_ended == 0) session.work();
}

void serve_panel_on(const PanelOptions& options, const transport::CardUrl& url, const machine::Machine& machine) {
  with_card(url, Purpose::kMove, [&](driver::Card& first, transport::Connection& connection) {
    match_axes(first, machine);
    if (options.card.text) take_over(first, options.card, machine);
    run::AttentiveBus bus(connection.bus(), grbl::CardMachine::kLongestSleep);
    driver::Card card = driver::Card::open(bus);
    end_panel_at_signals();
    serve_page(options, card, bus, machine);
  });
}

void panel_command(const PanelOptions& options) {
  if (panel::page().empty()) throw UsageError(panel::kHowToBuildPage);
  const machine::Machine machine = options.machine.load();
  if (const auto url = options.card.url()) {
    options.local.world.refuse_with(options.card);
    return serve_panel_on(options, *url, machine);
  }
  LocalCard local(options.local, static_cast<unsigned>(machine.motors()));
  serve_panel_on(options, local.url(), machine);
  tell("note", local.end());
}

}  // namespace

void add_panel_command(CLI::App& app) {
  auto options = std::make_shared<PanelOptions>();
  CLI::App* command = app.add_subcommand(
      "panel", "serve a page with which a browser runs the machine: jog, home, set zero, run programs");
  command
      ->add_option("--listen", options->listen,
                   "address and TCP port of the page. Port 0 is any free port. The command prints the page's address, "
                   "with a token")
      ->type_name("HOST:PORT")
      ->capture_default_str();
  command
      ->add_option("--settings", options->settings,
                   "file in which work offsets are kept (default: none; they are lost when the server ends)")
      ->type_name("FILE");
  options->local.add_to(*command);
  options->machine.add_to(*command);
  options->card.add_to_mover(*command);
  command->callback([options] { panel_command(*options); });
}

}  // namespace trammel::app
