// Common parts of both kinds of `trammel serve`: options, the card, its switches, the end by a signal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/world_choice.hpp"
#include "trammel/sim/engines.hpp"
#include "trammel/simulation/operation.hpp"

namespace trammel::app {

struct ServeOptions {
  std::optional<std::string> engine;  // default: rtl; with --hm2: model
  std::optional<std::uint32_t> clock_hz;
  unsigned axes = 4;
  std::string listen = "127.0.0.1";
  std::uint16_t port = 0;
  bool terminal = false;
  std::optional<std::string> token;
  bool fast = false;
  std::uint32_t baud = 0;
  double silence = 60;
  bool once = false;
  std::vector<std::string> input_at;
  WorldChoice world;
  std::optional<std::string> hm2;  // HOST[:PORT]
  double hm2_lose = 0;             // percent

  std::uint32_t clock() const;
  bool is_model() const { return engine.value_or(hm2 ? "model" : "rtl") == "model"; }
};

sim::SimulationOptions served_engine(const ServeOptions& options);

// Prints a note of the server.
void say_served(const std::string& text);

// Makes the first signal end the server in order; the next one has its default effect.
void end_serving_at_signals();
bool serving_ended();

// Switches that are pressed at given card times: each is pressed when its time has passed, between two turns of the
// server.
class Switches {
 public:
  explicit Switches(const ServeOptions& options);
  const std::vector<simulation::OperatorEvent>& events() const { return events_; }
  void press_due(sim::Engine& engine);

 private:
  double clock_hz_;
  std::vector<simulation::OperatorEvent> events_;
  std::size_t next_ = 0;
};

}  // namespace trammel::app
