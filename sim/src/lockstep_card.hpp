// RTL card and golden model on the same bus; every output and all visible state is compared in every cycle.
// The model goes ahead, since the host needs its answers; the RTL follows in batches, which is faster than clocking the
// two in turn. What the host sees is the model's: an answer of the RTL that differs is a mismatch like any other.
//
// Not thread-safe. With RtlThread::kOwn the RTL follows in a thread of its own, a batch beside the model: that thread
// has the Verilated card, and a batch from the time it is given until it is judged; all else, the events, the model
// with its steps, and every exception, stays with the thread that calls.
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

  // Both start in reset's state. `card` has as many axes as `config`. The RTL is at most `batch` clocks behind, with a
  // thread of its own twice as many.
  LockstepCard(std::unique_ptr<VerilatedCard> card, const model::CardModel::Config& config, std::uint64_t seed,
               std::size_t batch = kBatch, RtlThread thread = RtlThread::kCallers);
  // The RTL catches up. A mismatch that is found only here ends the process with its report: nobody is left to catch
  // it.
  ~LockstepCard();
  LockstepCard(const LockstepCard&) = delete;
  LockstepCard& operator=(const LockstepCard&) = delete;

  // Rising edges with the same inputs. Throws lockstep::Mismatch on the first difference, as late as the RTL may be
  // behind; what the model did after it is not compared.
  void run(const model::CardModel::Inputs& in, std::uint64_t clocks);
  // The RTL catches up. Throws lockstep::Mismatch on the first difference.
  void settle();

  // Keeps an event for the report of a later mismatch; `what` is a string literal.
  void event(const char* what, std::uint64_t value) {
    events_.add(cycles_ + batches_[0].clocks + batches_[1].clocks, what, value);
  }

  model::CardModel& model() { return model_; }
  const model::CardModel& model() const { return model_; }
  const model::Axi4LitePort::Outputs& bus() const { return model_.bus(); }
  // What was compared up to the last settle().
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
    std::future<std::size_t> same;  // valid while the batch is given: clocks before the first difference
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
  std::uint64_t signals_;  // of a record
  std::array<Batch, 2> batches_;
  std::size_t filled_ = 0;  // the batch that the model fills; the other may be given
  std::vector<CardRecord> rtl_;
  lockstep::EventLog events_;
  std::uint64_t cycles_ = 0;
  std::uint64_t comparisons_ = 0;
  std::unique_ptr<Worker> worker_;  // none: batches are done where they are given. Last: it uses the others
};

}  // namespace trammel::sim
