// How the card's time goes on beside the host's.
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

  // Clocks that the card may run now, `wanted` at most: all of them, or as many as it is behind life.
  std::uint64_t due(std::uint64_t wanted);
  // Runs them, in a piece that leaves the server awake.
  void run(std::uint64_t clocks);

 private:
  void anchor();

  sim::Engine& engine_;
  const Settings& settings_;
  Clock::time_point anchor_time_;
  std::uint64_t anchor_cycle_ = 0;
  Clock::time_point told_{};  // that it is slower than life
};

}  // namespace trammel::serve
