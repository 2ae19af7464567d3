// RTL card and golden model on the same bus; every output and all visible state is compared in every cycle. The model
// runs first, because the host needs its answers. The RTL follows in batches, which is faster than clocking the two in
// turn. The host sees the model's answers; a different answer of the RTL is a mismatch like any other.
//
// Not thread-safe. With RtlThread::kOwn the RTL follows in its own thread, one batch at a time, while the model runs
// on. That thread owns the Verilated card, and a batch from give() to judge(). Everything else stays with the calling
// thread: the events, the model with its steps, and all exceptions.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <memory>
#include <vector>

#include "card_record.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/sim/lockstep.hpp"
#include "verilated_card.hpp"
#include "worker.hpp"

namespace trammel::sim {

enum class RtlThread { kCallers, kOwn };

class LockstepCard {
 public:
  static constexpr std::size_t kBatch = 2048;  // clocks

  // Both start in the state after reset. `card` has as many axes as `config`. The RTL is at most `batch` clocks behind,
  // or twice as many with its own thread.
  LockstepCard(std::unique_ptr<VerilatedCard> card, const model::CardModel::Config& config, std::uint64_t seed,
               std::size_t batch = kBatch, RtlThread thread = RtlThread::kCallers);
  // Lets the RTL catch up. A mismatch that is found only here ends the process with its report, because no caller can
  // catch it.
  ~LockstepCard();
  LockstepCard(const LockstepCard&) = delete;
  LockstepCard& operator=(const LockstepCard&) = delete;

  // Runs `clocks` rising edges with the same inputs. Throws lockstep::Mismatch on the first difference, late by as much
  // as the RTL is behind. Clocks of the model after the difference are not compared.
  void run(const model::CardModel::Inputs& in, std::uint64_t clocks);
  // Lets the RTL catch up. Throws lockstep::Mismatch on the first difference.
  void settle();

  // Records an event for the report of a later mismatch. `what` is a string literal.
  void event(const char* what, std::uint64_t value) {
    events_.add(cycles_ + batches_[0].clocks + batches_[1].clocks, what, value);
  }

  model::CardModel& model() { return model_; }
  const model::CardModel& model() const { return model_; }
  const model::Axi4LitePort::Outputs& bus() const { return model_.bus(); }
  // Cycles and comparisons up to the last settle().
  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t comparisons() const { return comparisons_; }

 private:
  struct Stretch {
    model::CardModel::Inputs in;
    std::size_t clocks;
  };
  struct Batch {
    std::vector<Stretch> stretches;
    std::vector<CardRecord> golden;
    std::size_t clocks = 0;
    std::future<std::size_t> same;  // valid from give() to judge(): clocks before the first difference
    CardRecord different;           // the RTL's record of that difference

    void clear();
  };

  void give(Batch& batch);
  std::size_t follow(Batch& batch);
  void judge(Batch& batch);
  void compare(Batch& batch);

  std::unique_ptr<VerilatedCard> card_;
  model::CardModel model_;
  std::uint64_t seed_;
  std::uint64_t signals_;  // signals in a record
  std::array<Batch, 2> batches_;
  std::size_t filled_ = 0;  // index of the batch that the model fills; the other may be at the RTL
  std::vector<CardRecord> rtl_;
  lockstep::EventLog events_;
  std::uint64_t cycles_ = 0;
  std::uint64_t comparisons_ = 0;
  std::unique_ptr<Worker> worker_;  // null: batches run in the calling thread. Last member: it uses the others
};

}  // namespace trammel::sim
