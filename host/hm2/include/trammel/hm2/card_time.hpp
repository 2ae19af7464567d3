// The card's time, for code that serves the card: a simulated card runs only when told to, hardware by itself. Used by
// one thread.
#pragma once

#include <cstdint>

#include "trammel/sim/engine.hpp"

namespace trammel::hm2 {

class CardTime {
 public:
  virtual ~CardTime() = default;
  // Clocks since the card's reset.
  virtual std::uint64_t now() const = 0;
  // Returns at that clock, or at once if the clock has passed.
  virtual void run_to(std::uint64_t clock) = 0;
};

class EngineTime final : public CardTime {
 public:
  // `engine` must outlive this object.
  explicit EngineTime(sim::Engine& engine) : engine_(engine) {}
  std::uint64_t now() const override { return engine_.cycles(); }
  void run_to(std::uint64_t clock) override {
    if (clock > now()) engine_.wait(clock - now());
  }

 private:
  sim::Engine& engine_;
};

}  // namespace trammel::hm2
