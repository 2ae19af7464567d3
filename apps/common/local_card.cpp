#include "local_card.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <thread>

#include "engine_options.hpp"
#include "terminal.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engines.hpp"
#include "trammel/transport/byte_stream.hpp"

namespace trammel::app {
namespace {

sim::SimulationOptions local_engine(const LocalCardChoice& choice, unsigned axes) {
  sim::SimulationOptions options;
  options.kind = choice.engine == "model" ? sim::EngineKind::kModel : sim::EngineKind::kRtl;
  options.axes = axes;
  options.clock_hz = choice.clock_hz;
  options.rtl_thread = true;
  return options;
}

}  // namespace

void LocalCardChoice::add_to(CLI::App& command) {
  command
      .add_option("--engine", engine,
                  "how to simulate the card. rtl: the Verilated RTL, compared with the golden model in every cycle. "
                  "model: the golden model alone, which is faster")
      ->check(CLI::IsMember({"rtl", "model"}))
      ->capture_default_str();
  command.add_option("--clock", clock_hz, "clock of the simulated card")
      ->transform(whole_number(machine::kSlowestClock, machine::kFastestClock, "Hz"))
      ->type_name("HZ")
      ->capture_default_str();
  command.add_flag("--fast", fast, "run the simulated card as fast as possible, not in real time");
  world.add_to(command);
}

class LocalCard::Served {
 public:
  Served(const LocalCardChoice& choice, unsigned axes)
      : world_(choice.world.make(choice.clock_hz, {})),
        listener_(transport::listen_tcp("127.0.0.1", 0)),
        engine_(in_world(world_.get(), sim::make_engine(local_engine(choice, axes)))),
        token_(serve::random_token()) {
    engine_->set_sink(&path_);
    serve::Settings settings;
    settings.token = token_;
    settings.clock_hz = choice.clock_hz;
    settings.real_time = !choice.fast;
    settings.world = world_.get();
    server_ = std::make_unique<serve::CardServer>(*engine_, *listener_, settings);
    thread_ = std::thread([this] { serve(); });
  }
  ~Served() { stop(); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  std::string url() const { return fmt::format("{}?token={}", listener_->url(), token_); }
  std::string end() {
    stop();
    std::string lockstep;
    if (const auto cycles = engine_->lockstep_cycles()) {
      lockstep = fmt::format("; lockstep: {} cycles, 0 mismatches", *cycles);
    }
    const run::PathIdentity& path = path_.identity();
    return fmt::format("path: {} steps, of axes and directions {}{}", path.count(), path.order_text(), lockstep);
  }

 private:
  // Records all path steps.
  class Path final : public driver::StepSink {
   public:
    void pin_step(const driver::PinStep& /*step*/) override {}
    void path_step(const driver::PathStep& step) override { identity_.path_step(step); }
    const run::PathIdentity& identity() const { return identity_; }

   private:
    run::PathIdentity identity_;
  };

  void serve() {
    try {
      while (!ended_) server_->turn();
    } catch (const std::exception& error) {
      tell("error", fmt::format("the simulated card has stopped: {}", error.what()));
    }
  }
  void stop() {
    ended_ = true;
    if (thread_.joinable()) thread_.join();
  }

  std::unique_ptr<world::World> world_;
  std::unique_ptr<transport::Listener> listener_;
  std::unique_ptr<sim::Engine> engine_;
  std::string token_;
  Path path_;
  std::unique_ptr<serve::CardServer> server_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

LocalCard::LocalCard(const LocalCardChoice& choice, unsigned axes) : served_(std::make_unique<Served>(choice, axes)) {}
LocalCard::~LocalCard() = default;

transport::CardUrl LocalCard::url() const { return transport::parse_card_url(served_->url()); }

std::string LocalCard::end() { return served_->end(); }

}  // namespace trammel::app
