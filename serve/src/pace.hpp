// Advances the card's time relative to the host's.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::serve {

class CardServer::Pace {
 public:
  using Clock = std::chrono::steady_clock;

  Pace(sim::Engine& engine, const Settings& settings) : engine_(engine), settings_(settings) { anchor(); }

  // Number of clocks that the card may run now, at most `wanted`: all of them, or in real time as many as it is behind
  // the host's clock.
  std::uint64_t due(std::uint64_t wanted);
  // Runs at most `clocks` clocks, in a piece that is short enough for the server to respond.
  void run(std::uint64_t clocks);

 private:
  void anchor();

  sim::Engine& engine_;
  const Settings& settings_;
  Clock::time_point anchor_time_;
  std::uint64_t anchor_cycle_ = 0;
  Clock::time_point told_{};  // last report that the card is slower than real time
};

}  // namespace trammel::serve
