#include "serve_hm2.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "common/errors.hpp"
#include "common/standard_streams.hpp"
#include "common/terminal.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/hm2/server.hpp"

namespace trammel::app {
namespace {

struct UdpPlace {
  std::string host;
  std::uint16_t port = hm2::kUdpPort;
};

UdpPlace udp_place_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  UdpPlace place;
  place.host = text.substr(0, colon);
  if (colon == std::string::npos) return place;
  const std::string port = text.substr(colon + 1);
  const bool number = !port.empty() && port.size() < 6 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!number || std::stoul(port) > 65535) throw UsageError("--hm2: must be HOST or HOST:PORT, such as 192.168.81.2");
  place.port = static_cast<std::uint16_t>(std::stoul(port));
  return place;
}

std::unique_ptr<hm2::UdpPort> open_udp(const UdpPlace& place) {
  try {
    return std::make_unique<hm2::UdpPort>(place.host, place.port);
  } catch (const driver::LinkError& error) {
    throw UsageError(fmt::format("serve: {}", error.what()));
  }
}

// Sums the pulses at the pins, for comparison with the card's counters.
class PinPulses final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& step) override { places_[step.axis] += step.direction; }
  void path_step(const driver::PathStep& /*step*/) override {}
  std::string text(unsigned axes) const {
    return fmt::format("{}", fmt::join(places_.begin(), places_.begin() + axes, " "));
  }

 private:
  std::array<std::int64_t, card_map::kMaxAxes> places_{};
};

void say_counts(const hm2::Board::Counts& board, const hm2::Server::Counts& server, const hm2::Hostmot2& hostmot2) {
  std::string refused;
  for (unsigned n = 1; n < hm2::kDefects; ++n) {
    if (board.refused[n] == 0) continue;
    refused += fmt::format("{}{} {}", refused.empty() ? " (" : ", ", board.refused[n],
                           hm2::name_of(static_cast<hm2::Defect>(n)));
  }
  if (!refused.empty()) refused += ")";
  const std::string lost = server.lost == 0 ? "" : fmt::format(", {} lost on purpose", server.lost);
  const std::string strangers = server.strangers == 0 ? "" : fmt::format(", {} of others", server.strangers);
  const std::chrono::duration<double, std::milli> longest = server.longest_answer;
  say_served(
      fmt::format("{} drivers; {} datagrams, {} answered, {} refused{}{}{}; longest answer {:.3f} ms, longest gap of a "
                  "driver {:.3f} ms",
                  server.drivers, board.datagrams, board.answers, board.all_refused(), refused, strangers, lost,
                  longest.count(), std::chrono::duration<double, std::milli>(server.longest_gap).count()));
  const hm2::StepGenerators::Counts& steps = hostmot2.steps().counts();
  say_served(
      fmt::format("{} bites of the watchdog; {} lines in {} motions, {} clamped to the step times, {} ticks stale; "
                  "{:.3f} s left out",
                  hostmot2.bites(), steps.lines, steps.streams, steps.clamped, steps.stale_ticks, server.lost_seconds));
}

void say_places(sim::Engine& engine, const PinPulses& pins, const ServeOptions& options) {
  std::string lockstep;  // the call completes the comparison of pending cycles
  if (const auto cycles = engine.lockstep_cycles())
    lockstep = fmt::format("; lockstep: {} cycles, 0 mismatches", *cycles);
  say_served(fmt::format("pulses at the pins {}; counters {}; {:.3f} s of card time{}", pins.text(options.axes),
                         fmt::join(engine.positions(), " "), static_cast<double>(engine.cycles()) / options.clock(),
                         lockstep));
}

// A driver sends to the hardware address that the card reports, independent of the network.
void warn_of_hardware(const hm2::UdpPort& port, const std::array<std::uint8_t, 6>& hardware) {
  if (std::any_of(hardware.begin(), hardware.end(), [](std::uint8_t byte) { return byte != 0; })) return;
  tell("warning", fmt::format("{} has no hardware address: hm2_eth reaches the card only on the address of an Ethernet "
                              "interface, such as one end of a veth pair",
                              port.address().text()));
}

}  // namespace

void serve_hm2(const ServeOptions& options) {
  const UdpPlace place = udp_place_of(*options.hm2);
  Switches switches(options);
  const std::unique_ptr<world::World> world = options.world.make(options.clock(), switches.events());
  const std::unique_ptr<hm2::UdpPort> port = open_udp(place);
  const std::unique_ptr<sim::Engine> engine = in_world(world.get(), sim::make_engine(served_engine(options)));
  PinPulses pins;
  engine->set_sink(&pins);
  driver::Card card = driver::Card::open(*engine);
  hm2::EngineTime time(*engine);
  hm2::Hostmot2 hostmot2(card, time, say_served);
  const std::array<std::uint8_t, 6> hardware = port->hardware_address();
  hm2::Board board(hostmot2, hardware, options.clock());
  hm2::Server::Settings settings;
  settings.clock_hz = options.clock();
  settings.lose_percent = options.hm2_lose;
  settings.note = say_served;
  hm2::Server server(hostmot2, board, *port, settings);
  end_serving_at_signals();
  warn_of_hardware(*port, hardware);
  to_standard_output(fmt::format("hostmot2 at {}\n", port->address().text()));
  finish_standard_streams();
  while (!serving_ended() && !(options.once && server.counts().drivers != 0 && !server.has_driver())) {
    server.turn();
    switches.press_due(*engine);
  }
  say_counts(board.counts(), server.counts(), hostmot2);
  say_places(*engine, pins, options);
  if (world) say_served(world_text(*world, "; "));
}

}  // namespace trammel::app
