// A sender, a Grbl controller and a simulated card in this process, not in real time: the same parts as in `trammel
// grbl`, with access to the card's pins.
#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/grbl/card_machine.hpp"
#include "trammel/grbl/controller.hpp"
#include "trammel/grbl/settings.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/output_recorder.hpp"
#include "trammel/sim/engines.hpp"
#include "trammel/world/engine_in_world.hpp"
#include "trammel/world/world_file.hpp"

namespace trammel::test {

inline constexpr std::uint32_t kSessionClock = 1'000'000;

// examples/first-machine.toml, with a spindle and a coolant pump on outputs.
inline constexpr unsigned kSpindle = 0;
inline constexpr unsigned kCoolant = 1;
inline machine::Machine first_machine_with_outputs() {
  machine::Machine machine = machine::load_machine(TRAMMEL_EXAMPLES_DIR "/first-machine.toml");
  machine.outputs.m3 = 1U << kSpindle;
  machine.outputs.m8 = 1U << kCoolant;
  return machine;
}

class CardSession {
 public:
  // The machine is homed and at 0 in all axes. `in_world`: with the default world behind the pins.
  CardSession(sim::EngineKind kind, const machine::Machine& machine, bool in_world = false)
      : engine_(make(kind, in_world)), settings_(machine, "") {
    engine_->set_sink(&outputs);
    const std::uint8_t motors = run::motors_of(machine);
    run::place_axes(card, machine, (1U << machine.axes.size()) - 1, {}, motors);
    side_ = std::make_unique<grbl::CardMachine>(card, bus_, machine, false);
    controller_ =
        std::make_unique<grbl::Controller>(*side_, settings_, [this](const std::string& text) { came_ += text; });
    side_->set_meanwhile([this] {
      if (meanwhile_) meanwhile_();
      controller_->serve();
    });
    controller_->begin();
    settle();
    came_.clear();
  }

  sim::Engine& engine() { return *engine_; }
  void put(const std::string& bytes) { controller_->receive(bytes); }
  // Works until nothing is in progress; throws after 10^5 turns.
  void settle() {
    for (unsigned n = 0, quiet = 0; quiet < 3; ++n) {
      if (n > 100'000) throw std::logic_error("the controller does not settle");
      controller_->work();
      quiet = controller_->idle() ? quiet + 1 : 0;
    }
  }
  // Sends a line. Returns all answers until nothing is in progress.
  std::string ask(const std::string& line) {
    came_.clear();
    put(line + "\n");
    settle();
    return came_;
  }
  // Sends a line. During its motion, after an axis has made `pulses` pulses in either direction, calls `act` and then
  // sends `bytes`.
  std::string ask_and_then(const std::string& line, unsigned axis, std::int64_t pulses, const std::string& bytes,
                           const std::function<void()>& act = nullptr) {
    const std::int64_t begin = engine_->positions()[axis];
    bool done = false;
    meanwhile_ = [&, this] {
      if (done || std::abs(engine_->positions()[axis] - begin) < pulses) return;
      done = true;
      if (act) act();
      put(bytes);
    };
    const std::string said = ask(line);
    meanwhile_ = nullptr;
    EXPECT_TRUE(done) << "no axis has come so far";
    return said;
  }
  // Levels at the pins; bit n: output n.
  unsigned levels() const {
    unsigned levels = 0;
    for (unsigned n = 0; n < outputs.outputs().size(); ++n) levels |= outputs.outputs()[n].level ? 1U << n : 0U;
    return levels;
  }

  world::World world{world::default_world(), kSessionClock};
  run::OutputRecorder outputs;  // at the pins

 private:
  std::unique_ptr<sim::Engine> make(sim::EngineKind kind, bool in_world) {
    sim::SimulationOptions options;
    options.kind = kind;
    options.clock_hz = kSessionClock;
    auto engine = sim::make_engine(options);
    if (!in_world) return engine;
    return std::make_unique<world::EngineInWorld>(std::move(engine), world);
  }

  std::unique_ptr<sim::Engine> engine_;
  run::AttentiveBus bus_{*engine_, grbl::CardMachine::kLongestSleep};

 public:
  driver::Card card{driver::Card::open(bus_)};

 private:
  grbl::Settings settings_;
  std::unique_ptr<grbl::CardMachine> side_;
  std::unique_ptr<grbl::Controller> controller_;
  std::function<void()> meanwhile_;
  std::string came_;
};

}  // namespace trammel::test
