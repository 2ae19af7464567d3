// The simulated machine behind a card, shared by the C and Python bindings: one in this process, or the one of `trammel
// serve --world`. One thread at a time uses an object; that of a card in this process is for the card's thread.
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
  double carriage_mm = 0;      // position of the carriage; degrees for A, B and C
  double commanded_mm = 0;     // position commanded by the card
  std::int64_t carriage = 0;   // position of the carriage in pulses
  std::int64_t commanded = 0;  // commanded position in pulses
  std::int64_t lost = 0;       // pulses between the motor's position and its commanded position
  bool powered = false;
};

struct WorldContact {
  std::string name;
  std::optional<unsigned> input;  // the card's input; nullopt: the emergency stop's pin
  bool is_button = false;         // true: a button; false: a switch, which a carriage presses
  bool pressed = false;
};

struct WorldState {
  double time_s = 0;  // card time since its start
  std::vector<WorldAxis> axes;
  std::vector<WorldContact> contacts;  // switches, then buttons, each in the order of the world file
  std::uint32_t inputs = 0;            // levels at the card's pins, bit n: input n
  bool emergency_stop = false;         // the emergency stop's pin is active
};

// Parses the text that world::state_json() writes. Throws driver::LinkError for another text, since it comes from a
// server.
WorldState parse_world_state(const std::string& json);

class SimulatedMachine {
 public:
  virtual ~SimulatedMachine() = default;
  // The state as a line of JSON, as world::state_json() writes it.
  virtual std::string read() = 0;
  // Restarts the count of the path's steps and their identity. Throws driver::StateError for a card in this process,
  // which does not count them.
  virtual std::string count() = 0;
  // Presses or releases a button, at once or when a condition is met ("X > 40": mm of a carriage, as in the state), and
  // waits for 20 ms of card time. Throws driver::ArgumentError, with the existing names, for an unknown name;
  // driver::InterruptedError by an InterruptScope. A condition that is not met within `longest` is dropped: a card in
  // this process throws driver::TimeoutError (`longest` is card time), a served one driver::LinkError (real time); its
  // object is then unusable.
  std::string press(const std::string& button, const std::string& when, std::chrono::nanoseconds longest);
  std::string release(const std::string& button, const std::string& when, std::chrono::nanoseconds longest);

 private:
  // `request`: "press estop when X > 40", in the server's syntax.
  virtual std::string make(const std::string& request, std::chrono::nanoseconds longest) = 0;
};

// Connects to the machine of a served card. Throws as transport::ServedWorld.
std::unique_ptr<SimulatedMachine> open_served_machine(const std::string& url);

// A simulated card with a machine behind its pins: the golden model.
class CardInWorld {
 public:
  // `world_file`: a path; empty or "default": the built-in world. Throws driver::ArgumentError for a file that cannot
  // be read or has an invalid entry, and std::invalid_argument for `axes` or `clock_hz` out of range.
  CardInWorld(const std::string& world_file, unsigned axes, std::uint32_t clock_hz);

  world::World& world() { return world_; }
  sim::Engine& engine() { return *engine_; }

 private:
  world::World world_;
  std::unique_ptr<sim::Engine> engine_;
};

std::unique_ptr<SimulatedMachine> machine_of(std::shared_ptr<CardInWorld> card);

}  // namespace trammel::bindings
