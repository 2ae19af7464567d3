// The simulated machine behind a card, as C and Python have it: one in this process, or the one of
// `trammel serve --world`. One object, one thread at a time; that of a card in this process is for the card's thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trammel/driver/bus.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/world/world.hpp"

namespace trammel::bindings {

struct WorldAxis {
  char letter = '\0';
  double carriage_mm = 0;     // where the carriage stands; degrees for A, B and C
  double commanded_mm = 0;    // what the card has made
  std::int64_t carriage = 0;  // the same in pulses
  std::int64_t commanded = 0;
  std::int64_t lost = 0;  // pulses by which the motor is held beside its commanded place
  bool powered = false;
};

struct WorldContact {
  std::string name;
  std::optional<unsigned> input;  // of the card; none: the emergency stop's pin
  bool is_button = false;         // else a switch, which a carriage presses
  bool pressed = false;
};

struct WorldState {
  double time_s = 0;  // of the card, since its start
  std::vector<WorldAxis> axes;
  std::vector<WorldContact> contacts;  // switches, then buttons, as the world file has them
  std::uint32_t inputs = 0;            // levels at the card's pins, bit n: input n
  bool emergency_stop = false;         // whether its pin says stop
};

// The state as world::state_json() writes it. Throws driver::LinkError for another text: it comes from a server.
WorldState parse_world_state(const std::string& json);

class SimulatedMachine {
 public:
  virtual ~SimulatedMachine() = default;
  // A line of JSON, as world::state_json() writes it.
  virtual std::string read() = 0;
  // The path's steps and their identity are counted anew from here. Throws driver::StateError where nobody counts them:
  // for a card in this process.
  virtual std::string count() = 0;
  // Presses or releases a button, at once or when a condition has come ("X > 40": mm of a carriage, as the state has
  // it), and waits for 20 ms of the card's time. Throws driver::ArgumentError, with the names that there are, for what
  // is not there; driver::InterruptedError by an InterruptScope. A condition that has not come within `longest` is
  // forgotten: driver::TimeoutError (card time) here, driver::LinkError (real time) at a server, whose object is then
  // of no use.
  std::string press(const std::string& button, const std::string& when, std::chrono::nanoseconds longest);
  std::string release(const std::string& button, const std::string& when, std::chrono::nanoseconds longest);

 private:
  // "press estop when X > 40", as a server takes it.
  virtual std::string make(const std::string& request, std::chrono::nanoseconds longest) = 0;
};

// At the machine of a served card. Throws as transport::ServedWorld.
std::unique_ptr<SimulatedMachine> open_served_machine(const std::string& url);

// A simulated card with a machine behind its pins: the golden model.
class CardInWorld {
 public:
  // `world_file`: a path; empty or "default": the built-in one. Throws driver::ArgumentError for a file that cannot be
  // read or has a wrong entry, and std::invalid_argument for a card out of range.
  CardInWorld(const std::string& world_file, unsigned axes, std::uint32_t clock_hz);

  world::World& world() { return world_; }
  sim::Engine& engine() { return *engine_; }

 private:
  world::World world_;
  std::unique_ptr<sim::Engine> engine_;
};

std::unique_ptr<SimulatedMachine> machine_of(std::shared_ptr<CardInWorld> card);

}  // namespace trammel::bindings
