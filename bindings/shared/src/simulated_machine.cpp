#include "trammel/bindings/simulated_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/transport/served_world.hpp"
#include "trammel/world/engine_in_world.hpp"
#include "trammel/world/state.hpp"
#include "trammel/world/world_file.hpp"

namespace trammel::bindings {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

std::string request_of(const char* verb, const std::string& button, const std::string& when) {
  std::string text = fmt::format("{} {}", verb, button);
  if (when.empty()) return text;
  text += " when ";
  for (const char c : when) {
    if (c == '<' || c == '>') {
      text += fmt::format(" {} ", c);
    } else if (c != ' ') {
      text += c;
    }
  }
  return text;
}

class ServedMachine final : public SimulatedMachine {
 public:
  explicit ServedMachine(const std::string& url) : world_(transport::parse_card_url(url)) {}

  std::string read() override { return world_.request("state"); }
  std::string count() override { return world_.request("count"); }

 private:
  std::string make(const std::string& request, nanoseconds longest) override {
    return world_.request(request, std::chrono::ceil<std::chrono::milliseconds>(longest));
  }

  transport::ServedWorld world_;
};

class MachineHere final : public SimulatedMachine {
 public:
  explicit MachineHere(std::shared_ptr<CardInWorld> card) : card_(std::move(card)) {}

  std::string read() override { return world::state_json(card_->world()); }
  std::string count() override { throw driver::StateError("steps of the path are counted at served cards alone"); }

 private:
  std::string make(const std::string& text, nanoseconds longest) override {
    world::World& world = card_->world();
    const world::Request request = world::parse_request(text, world);
    if (request.when && !request.when->axis) {
      throw driver::ArgumentError("steps of the path are counted at served cards alone: give a place, as X > 40");
    }
    if (request.when) wait_for(*request.when, text, longest);
    request.kind == world::Request::Kind::kPress ? world.press(request.button) : world.release(request.button);
    wait(world.clock_hz() / 50);
    return read();
  }
  // Checks the condition each millisecond of card time.
  void wait_for(const world::Request::Condition& condition, const std::string& text, nanoseconds longest) {
    world::World& world = card_->world();
    const std::uint64_t most = driver::clocks_of(longest, world.clock_hz(), "longest");
    const std::uint64_t look = std::max<std::uint64_t>(1, world.clock_hz() / 1000);
    for (std::uint64_t waited = 0; !world::holds(condition, world, 0); waited += look) {
      if (waited >= most) {
        throw driver::TimeoutError(fmt::format("{}: has not come within {:g} s of the card's time", text,
                                               static_cast<double>(longest.count()) * 1e-9),
                                   waited);
      }
      wait(look);
    }
  }
  void wait(std::uint64_t clocks) {
    if (!card_->engine().wait_or_interrupt(clocks)) {
      throw driver::InterruptedError("interrupted while a button was pressed");
    }
  }

  std::shared_ptr<CardInWorld> card_;
};

world::World make_world(const std::string& file, std::uint32_t clock_hz) {
  try {
    const bool built_in = file.empty() || file == "default";
    return world::World(built_in ? world::default_world() : world::load_world(file), clock_hz);
  } catch (const world::WorldError& error) {
    throw driver::ArgumentError(error.what());
  }
}

}  // namespace

std::string SimulatedMachine::press(const std::string& button, const std::string& when, nanoseconds longest) {
  return make(request_of("press", button, when), longest);
}
std::string SimulatedMachine::release(const std::string& button, const std::string& when, nanoseconds longest) {
  return make(request_of("release", button, when), longest);
}

CardInWorld::CardInWorld(const std::string& world_file, unsigned axes, std::uint32_t clock_hz)
    : world_(make_world(world_file, clock_hz)),
      engine_(std::make_unique<world::EngineInWorld>(sim::make_model_engine(sim::EngineOptions{axes, clock_hz, false}),
                                                     world_)) {}

std::unique_ptr<SimulatedMachine> open_served_machine(const std::string& url) {
  return std::make_unique<ServedMachine>(url);
}

std::unique_ptr<SimulatedMachine> machine_of(std::shared_ptr<CardInWorld> card) {
  return std::make_unique<MachineHere>(std::move(card));
}

}  // namespace trammel::bindings
