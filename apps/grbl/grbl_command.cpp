#include "grbl_command.hpp"

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
#include "standard_stream.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/grbl/card_machine.hpp"
#include "trammel/grbl/controller.hpp"
#include "trammel/grbl/server.hpp"
#include "trammel/grbl/settings.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::app {
namespace {

struct GrblOptions {
  std::string listen = "127.0.0.1:2323";
  bool terminal = false;
  bool standard = false;
  bool once = false;
  std::optional<std::string> settings;
  LocalCardChoice local;
  MachineChoice machine;
  CardChoice card;
};

volatile sig_atomic_t g_grbl_ended = 0;

// The first signal stops the machine on a ramp and ends the server; the next one ends the process at once.
void end_grbl_at_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_grbl_ended = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

std::unique_ptr<transport::Listener> open_listener(const GrblOptions& options) {
  if (options.standard) return nullptr;
  const std::size_t colon = options.listen.rfind(':');
  const std::string port = colon == std::string::npos ? "" : options.listen.substr(colon + 1);
  const bool number = !port.empty() && port.size() < 6 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!number || std::stoul(port) > 65535) throw UsageError("--listen: must be HOST:PORT, such as 127.0.0.1:2323");
  try {
    return options.terminal
               ? transport::open_pseudo_terminal()
               : transport::listen_tcp(options.listen.substr(0, colon), static_cast<std::uint16_t>(std::stoul(port)));
  } catch (const driver::LinkError& error) {
    throw UsageError(fmt::format("grbl: {}", error.what()));
  }
}

// Prints the address for senders on standard output at once.
void tell_senders(const transport::Listener& listener) {
  std::string url = listener.url();
  const std::string serial = "serial:";
  const bool is_terminal = url.rfind(serial, 0) == 0;
  if (is_terminal) url.erase(0, serial.size());
  if (url.rfind("tcp://", 0) == 0) url.erase(0, 6);
  to_standard_output(fmt::format("Grbl 1.1h at {}{}\n", is_terminal ? "serial port " : "", url));
  finish_standard_streams();
}

void warn_of_network(const GrblOptions& options) {
  if (options.terminal || options.standard) return;
  const std::string host = options.listen.substr(0, options.listen.rfind(':'));
  if (host.rfind("127.", 0) == 0 || host == "localhost" || host == "::1" || host == "[::1]") return;
  tell("warning", fmt::format("--listen {}: everybody who reaches this address can move the machine: Grbl's protocol "
                              "has no password; use it only in a network that you trust",
                              options.listen));
}

// Serves until a signal arrives; with --once until the last client has disconnected and the machine is at rest.
void serve_senders(const GrblOptions& options, driver::Card& card, run::AttentiveBus& bus,
                   const machine::Machine& machine) {
  const std::unique_ptr<transport::Listener> listener = open_listener(options);
  warn_of_network(options);
  grbl::Settings settings(machine, options.settings.value_or(""));
  grbl::CardMachine side(card, bus, settings.machine(), options.card.trust_position);
  grbl::Server server([](const std::string& text) { tell("note", text); });
  grbl::Controller controller(side, settings, [&server](const std::string& text) { server.write(text); });
  bool met = false;
  bool stopping = false;
  side.set_meanwhile([&] {
    server.turn(listener.get(), controller);
    met = met || server.has_clients();
    controller.serve();
    if (g_grbl_ended != 0 && !stopping) side.stop();
    stopping = g_grbl_ended != 0;
  });
  controller.begin();
  if (listener) tell_senders(*listener);
  if (options.standard) server.add(standard_stream(), controller);
  const bool once = options.once || options.standard;
  while (g_grbl_ended == 0) {
    controller.work();
    const bool gone = (met || options.standard) && !server.has_clients();
    if (once && gone && controller.idle()) break;
  }
}

void tell_under_runs(driver::Card& card) {
  if (!card_map::has_engine(card.identification().engines, card_map::engine::kUnderrunHold)) return;
  tell("note", fmt::format("holds for want of commands since the card's reset: {}",
                           card.parts().registers.read(card_map::reg::kUnderruns)));
}

void serve_on(const GrblOptions& options, const transport::CardUrl& url, const machine::Machine& machine) {
  with_card(url, Purpose::kMove, [&](driver::Card& first, transport::Connection& connection) {
    match_axes(first, machine);
    if (options.card.text) take_over(first, options.card, machine);
    run::AttentiveBus bus(connection.bus(), grbl::CardMachine::kLongestSleep);
    driver::Card card = driver::Card::open(bus);
    end_grbl_at_signals();
    serve_senders(options, card, bus, machine);
    tell_under_runs(card);
  });
}

void grbl_command(const GrblOptions& options) {
  const machine::Machine machine = options.machine.load();
  if (const auto url = options.card.url()) {
    options.local.world.refuse_with(options.card);
    return serve_on(options, *url, machine);
  }
  LocalCard local(options.local, static_cast<unsigned>(machine.motors()));
  serve_on(options, local.url(), machine);
  tell("note", local.end());
}

}  // namespace

void add_grbl_command(CLI::App& app) {
  auto options = std::make_shared<GrblOptions>();
  CLI::App* command = app.add_subcommand(
      "grbl",
      "act as a Grbl 1.1 controller for senders (cncjs, bCNC, UGS), with a simulated or an external card behind it");
  auto* listen = command
                     ->add_option("--listen", options->listen,
                                  "address and TCP port on which senders connect. Port 0 is any free port")
                     ->type_name("HOST:PORT")
                     ->capture_default_str();
  auto* terminal = command
                       ->add_flag("--pty", options->terminal,
                                  "use a pseudo-terminal instead of a TCP port. To senders it looks like a serial port")
                       ->excludes(listen);
  command->add_flag("--stdio", options->standard, "use standard input and output instead of a TCP port")
      ->excludes(listen)
      ->excludes(terminal);
  command->add_flag("--once", options->once, "end when the last sender has disconnected and the machine is at rest");
  command
      ->add_option("--settings", options->settings,
                   "file in which the settings that senders make ($x=, $N, offsets) are kept (default: none; they are "
                   "lost when the server ends)")
      ->type_name("FILE");
  options->local.add_to(*command);
  options->machine.add_to(*command);
  options->card.add_to_mover(*command);
  command->callback([options] { grbl_command(*options); });
}

}  // namespace trammel::app
