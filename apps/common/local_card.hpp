// A simulated card of this process that runs by itself, as one of `trammel serve` does.
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
  bool fast = false;  // as fast as it can, not in real time
  WorldChoice world;

  // --engine, --clock, --fast, --world and --world-events.
  void add_to(CLI::App& command);
};

class LocalCard {
 public:
  // Begins to run at once. `axes`: 1 to 8. Throws UsageError for a world that cannot be read, and driver::LinkError.
  LocalCard(const LocalCardChoice& choice, unsigned axes);
  ~LocalCard();
  LocalCard(const LocalCard&) = delete;
  LocalCard& operator=(const LocalCard&) = delete;

  // With its token.
  transport::CardUrl url() const;
  // How many steps it has made on the path, and a number for their order, as of run::PathIdentity. Ends the card.
  std::string end();

 private:
  class Served;
  std::unique_ptr<Served> served_;
};

}  // namespace trammel::app
