// RTL card and golden model, clocked together; every output and all visible state is compared in every cycle.
// Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>

#include "lockstep.hpp"
#include "trammel/model/card_model.hpp"
#include "verilated_card.hpp"

namespace trammel::sim {

class LockstepCard {
 public:
  // Both start in reset's state. `card` has as many axes as `config`.
  LockstepCard(std::unique_ptr<VerilatedCard> card, const model::CardModel::Config& config, std::uint64_t seed);

  // One rising edge of both. Throws lockstep::Mismatch on the first difference.
  void clock(const model::CardModel::Inputs& in);

  // Keeps an event for the report of a later mismatch; `what` is a string literal.
  void event(const char* what, std::uint64_t value) { checker_.event(what, value); }

  model::CardModel& model() { return model_; }
  const model::CardModel& model() const { return model_; }
  std::uint64_t cycles() const { return checker_.cycles(); }
  std::uint64_t comparisons() const { return comparisons_; }

 private:
  void compare();
  void name_difference();

  std::unique_ptr<VerilatedCard> card_;
  model::CardModel model_;
  lockstep::Checker checker_;
  VerilatedCard::Ports ports_;
  std::uint64_t comparisons_ = 0;
};

}  // namespace trammel::sim
