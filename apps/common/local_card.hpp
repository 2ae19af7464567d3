// A simulated card of this process that runs in its own thread, as that of `trammel serve` does.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "command_line.hpp"
#include "trammel/transport/card_url.hpp"
#include "world_choice.hpp"

namespace trammel::app {

struct LocalCardChoice {
  std::string engine = "rtl";
  std::uint32_t clock_hz = 1'000'000;
  bool fast = false;  // at full speed instead of real time
  WorldChoice world;

  // Adds --engine, --clock, --fast, --world and --world-events.
  void add_to(CLI::App& command);
};

class LocalCard {
 public:
  // Starts to run at once. `axes`: 1 to 8. Throws UsageError for a world that cannot be read, and driver::LinkError.
  LocalCard(const LocalCardChoice& choice, unsigned axes);
  ~LocalCard();
  LocalCard(const LocalCard&) = delete;
  LocalCard& operator=(const LocalCard&) = delete;

  // The card's URL, with its token.
  transport::CardUrl url() const;
  // Ends the card. Returns the number of its path steps, and a hash of their order, as in run::PathIdentity.
  std::string end();

 private:
  class Served;
  std::unique_ptr<Served> served_;
};

}  // namespace trammel::app
