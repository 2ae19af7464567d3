// RTL card and golden model on the same bus; every output and all visible state is compared in every cycle.
// The model goes ahead, since the host needs its answers; the RTL follows in batches, which is faster than clocking the
// two in turn. What the host sees is the model's: an answer of the RTL that differs is a mismatch like any other.
// Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "card_record.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/sim/lockstep.hpp"
#include "verilated_card.hpp"

namespace trammel::sim {

class LockstepCard {
 public:
  static constexpr std::size_t kBatch = 2048;  // clocks

  // Both start in reset's state. `card` has as many axes as `config`. The RTL is at most `batch` clocks behind.
  LockstepCard(std::unique_ptr<VerilatedCard> card, const model::CardModel::Config& config, std::uint64_t seed,
               std::size_t batch = kBatch);
  // The RTL catches up. A mismatch that is found only here ends the process with its report: nobody is left to catch
  // it.
  ~LockstepCard();
  LockstepCard(const LockstepCard&) = delete;
  LockstepCard& operator=(const LockstepCard&) = delete;

  // Rising edges with the same inputs. Throws lockstep::Mismatch on the first difference, up to a batch late.
  void run(const model::CardModel::Inputs& in, std::uint64_t clocks);
  // The RTL catches up. Throws lockstep::Mismatch on the first difference.
  void settle();

  // Keeps an event for the report of a later mismatch; `what` is a string literal.
  void event(const char* what, std::uint64_t value) { events_.add(cycles_ + golden_clocks_, what, value); }

  model::CardModel& model() { return model_; }
  const model::CardModel& model() const { return model_; }
  // What was compared up to the last settle().
  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t comparisons() const { return comparisons_; }

 private:
  struct Stretch {
    model::CardModel::Inputs in;
    std::size_t clocks;
  };

  void compare(std::size_t clocks);

  std::unique_ptr<VerilatedCard> card_;
  model::CardModel model_;
  std::uint64_t seed_;
  std::uint64_t signals_;           // of a record
  std::vector<Stretch> stretches_;  // of the batch
  std::vector<CardRecord> golden_;
  std::vector<CardRecord> rtl_;
  std::size_t golden_clocks_ = 0;  // of the batch
  lockstep::EventLog events_;
  std::uint64_t cycles_ = 0;
  std::uint64_t comparisons_ = 0;
};

}  // namespace trammel::sim
