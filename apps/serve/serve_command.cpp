#include "serve_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/standard_streams.hpp"
#include "common/terminal.hpp"
#include "serve_hm2.hpp"
#include "served_card.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/hm2/lbp16.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engines.hpp"
#include "trammel/transport/byte_stream.hpp"

namespace trammel::app {
namespace {

using namespace std::chrono_literals;

serve::Settings settings_of(const ServeOptions& options) {
  if (options.token && !serve::is_token(*options.token)) {
    throw UsageError("--token: must be 1 to 64 letters, digits, '-' and '_'");
  }
  serve::Settings settings;
  settings.token = options.token.value_or(serve::random_token());
  settings.clock_hz = options.clock();
  settings.real_time = !options.fast;
  settings.baud = options.baud;
  settings.note = say_served;
  // The client of a terminal cannot be disconnected, and does not exclude others.
  if (!options.terminal) {
    settings.hello = 5s;
    settings.silence = std::chrono::milliseconds(static_cast<std::int64_t>(options.silence * 1000));
  }
  return settings;
}

std::unique_ptr<transport::Listener> listener_of(const ServeOptions& options) {
  try {
    return options.terminal ? transport::open_pseudo_terminal() : transport::listen_tcp(options.listen, options.port);
  } catch (const driver::LinkError& error) {
    const bool has_port = std::count(options.listen.begin(), options.listen.end(), ':') == 1;
    throw UsageError(fmt::format("serve: {}{}", error.what(), has_port ? ". Give the port with --port" : ""));
  }
}

// The path of all steps of the card, and of those since the start of a count.
class ServedPath final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& step) override {
    whole_.path_step(step);
    counted_.path_step(step);
  }
  std::string text() const {
    return fmt::format("path: {} steps, identity {}; without the commands' numbers {}; of axes and directions {}",
                       whole_.count(), whole_.text(), whole_.unnumbered_text(), whole_.order_text());
  }
  world::PathCount count(bool anew) {
    if (anew) counted_ = {};
    return {counted_.count(), counted_.unnumbered_text()};
  }

 private:
  run::PathIdentity whole_;
  run::PathIdentity counted_;
};

// Prints the data that a program or a person needs to connect, on standard output at once.
void tell_where(const transport::Listener& listener, const std::string& token) {
  to_standard_output(
      fmt::format("card {}\ntoken {}\nmove with --card '{}?token={}'\n", listener.url(), token, listener.url(), token));
  finish_standard_streams();
}

bool is_loopback(const std::string& address) {
  return address.rfind("127.", 0) == 0 || address == "::1" || address == "localhost";
}

void serve_card(const ServeOptions& options) {
  serve::Settings settings = settings_of(options);
  Switches switches(options);
  const std::unique_ptr<world::World> world = options.world.make(options.clock(), switches.events());
  const std::unique_ptr<transport::Listener> listener = listener_of(options);
  const std::unique_ptr<sim::Engine> engine = in_world(world.get(), sim::make_engine(served_engine(options)));
  ServedPath path;
  engine->set_sink(&path);
  settings.world = world.get();
  settings.path = [&path](bool anew) { return path.count(anew); };
  serve::CardServer server(*engine, *listener, settings);
  end_serving_at_signals();
  if (!options.terminal && !is_loopback(options.listen)) {
    const bool any = options.listen == "0.0.0.0" || options.listen == "::";
    tell("warning",
         fmt::format("--listen {}: the token is transmitted unencrypted, and whoever has it can move the card. Serve "
                     "it only in a network that you trust{}",
                     options.listen,
                     any ? "; other computers connect to this computer's own address instead of this one" : ""));
  }
  tell_where(*listener, settings.token);
  bool met = false;
  while (!serving_ended() && !(options.once && met && !server.has_client())) {
    server.turn();
    switches.press_due(*engine);
    met = met || server.has_client();
  }
  const serve::CardServer::Counts& counts = server.counts();
  const double seconds = static_cast<double>(engine->cycles()) / options.clock();
  std::string lockstep;  // the call completes the comparison of pending cycles
  if (const auto cycles = engine->lockstep_cycles())
    lockstep = fmt::format("; lockstep: {} cycles, 0 mismatches", *cycles);
  say_served(fmt::format("served {} clients, {} refused; {} requests, {} damaged; {:.3f} s of card time{}",
                         counts.clients, counts.refused, counts.requests, counts.dropped, seconds, lockstep));
  say_served(path.text());
  if (world) say_served(world_text(*world, "; "));
}

// `others`: options that do not apply to a card for LinuxCNC.
void add_hm2_options(CLI::App& command, ServeOptions& options, const std::vector<CLI::Option*>& others) {
  auto* hm2 = command
                  .add_option("--hm2", options.hm2,
                              fmt::format("serve the card to LinuxCNC's driver hm2_eth, on a UDP port instead of a TCP "
                                          "port (without HOST: 127.0.0.1; without PORT: {})",
                                          hm2::kUdpPort))
                  ->type_name("HOST[:PORT]")
                  ->expected(0, 1)
                  ->default_str("127.0.0.1");
  for (CLI::Option* const other : others) hm2->excludes(other);
  command
      .add_option("--hm2-lose", options.hm2_lose,
                  "drop this percentage of the datagrams in each direction, from the first motion on, to test a bad "
                  "network (default: 0)")
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("PERCENT")
      ->needs(hm2);
}

}  // namespace

void add_serve_command(CLI::App& app) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* command =
      app.add_subcommand("serve", "serve a simulated card to other programs, on a TCP port or a pseudo-terminal");
  command
      ->add_option("--engine", options->engine,
                   "how to simulate the card. rtl: the Verilated RTL, compared with the golden model in every cycle. "
                   "model: the golden model alone, which is faster (default: rtl; with --hm2, model)")
      ->check(CLI::IsMember({"rtl", "model"}));
  command->add_option("--clock", options->clock_hz, "clock of the card (default: 1000000; with --hm2, 10000000)")
      ->transform(whole_number(machine::kSlowestClock, machine::kFastestClock, "Hz"))
      ->type_name("HZ");
  command->add_option("--axes", options->axes, "number of axes of the card")
      ->transform(whole_number(1, card_map::kMaxAxes))
      ->capture_default_str();
  auto* listen =
      command
          ->add_option("--listen", options->listen,
                       "address on which to listen. On any other address than loopback, other computers reach the card")
          ->type_name("ADDRESS")
          ->capture_default_str();
  auto* port = command->add_option("--port", options->port, "TCP port. 0 is any free port")
                   ->transform(whole_number(0, 65535))
                   ->capture_default_str();
  auto* terminal =
      command
          ->add_flag("--pty", options->terminal,
                     "serve on a pseudo-terminal instead of a TCP port. To other programs it looks like a serial line")
          ->excludes(listen)
          ->excludes(port);
  auto* token = command->add_option(
      "--token", options->token,
      "token that a client needs to move the card: 1 to 64 letters, digits, '-' and '_' (default: a random one)");
  auto* fast = command->add_flag("--fast", options->fast, "run the card as fast as possible, not in real time");
  auto* baud = command
                   ->add_option("--baud", options->baud,
                                "limit the link to this baud rate, in card time, like a serial line. 0 is no limit")
                   ->transform(whole_number(0, 100'000'000))
                   ->type_name("BAUD")
                   ->capture_default_str();
  auto* silence = command
                      ->add_option("--silence", options->silence,
                                   "disconnect a client that has sent nothing for this time, seconds")
                      ->check(positive())
                      ->type_name("SECONDS")
                      ->capture_default_str();
  command
      ->add_option(
          "--input-at", options->input_at,
          fmt::format(
              "set an input of the card (0 to {}) to a level (0 or 1) at this card time or soon after (repeatable). "
              "Until then the input is at rest. Input estop is the emergency stop button: 1 pressed, 0 released",
              sim::kInputs - 1))
      ->type_name("SECONDS:INPUT:LEVEL");
  options->world.add_to(*command);
  command->add_flag("--once", options->once,
                    "end when the first client, and every client that has connected since, has disconnected");
  add_hm2_options(*command, *options, {listen, port, terminal, token, fast, baud, silence});
  command->callback([options] { options->hm2 ? serve_hm2(*options) : serve_card(*options); });
}

}  // namespace trammel::app
