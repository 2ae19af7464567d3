#include "lockstep_card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "trammel/skip/card.hpp"

namespace trammel::sim {

namespace {

constexpr std::size_t kResetClocks = 4;

}  // namespace

LockstepCard::LockstepCard(std::unique_ptr<VerilatedCard> card, const model::CardModel::Config& config,
                           std::uint64_t seed, std::size_t batch, RtlThread thread)
    : card_(std::move(card)), model_(config), seed_(seed), signals_(signals_compared(config.axes)), rtl_(batch) {
  for (Batch& b : batches_) b.golden.resize(batch);
  model::CardModel::Inputs reset;
  reset.rst = true;
  CardRecord unused;
  for (std::size_t i = 0; i < kResetClocks; ++i) {
    card_->run(reset, 1, &unused);
    skip::clock(model_, reset);
  }
  // The reset is registered, so it lasts one clock longer.
  card_->run({}, 1, &unused);
  skip::clock(model_, {});
  if (thread == RtlThread::kOwn) worker_ = std::make_unique<Worker>();
}

LockstepCard::~LockstepCard() {
  try {
    settle();
  } catch (const std::exception& error) {
    fmt::print(stderr, "found at the end of a lockstep: {}\n", error.what());
    std::abort();
  }
}

void LockstepCard::Batch::clear() {
  if (same.valid()) same.wait();
  same = {};
  stretches.clear();
  clocks = 0;
}

void LockstepCard::run(const model::CardModel::Inputs& in, std::uint64_t clocks) {
  while (clocks != 0) {
    Batch& batch = batches_[filled_];
    const std::size_t some = std::min<std::uint64_t>(clocks, batch.golden.size() - batch.clocks);
    batch.stretches.push_back({in, 0});
    // Counts clock by clock, because the receiver of the model's steps may throw.
    for (std::size_t i = 0; i < some; ++i) {
      skip::clock(model_, in);
      batch.golden[batch.clocks++].show(model_);
      ++batch.stretches.back().clocks;
    }
    if (batch.clocks == batch.golden.size()) {
      give(batch);
      if (worker_) filled_ ^= 1;
      judge(batches_[filled_]);
    }
    clocks -= some;
  }
}

void LockstepCard::settle() {
  give(batches_[filled_]);
  judge(batches_[filled_ ^ 1]);
  judge(batches_[filled_]);
}

void LockstepCard::give(Batch& batch) {
  Worker::Job job([this, &batch] { return follow(batch); });
  batch.same = job.get_future();
  if (worker_)
    worker_->give(std::move(job));
  else
    job();
}

// Compares all records at once, and one by one only if they differ.
std::size_t LockstepCard::follow(Batch& batch) {
  CardRecord* record = rtl_.data();
  for (const Stretch& stretch : batch.stretches) {
    card_->run(stretch.in, stretch.clocks, record);
    record += stretch.clocks;
  }
  if (std::memcmp(rtl_.data(), batch.golden.data(), batch.clocks * sizeof(CardRecord)) == 0) return batch.clocks;
  std::size_t same = 0;
  while (std::memcmp(&rtl_[same], &batch.golden[same], sizeof(CardRecord)) == 0) ++same;
  batch.different = rtl_[same];
  return same;
}

// A batch is compared only once, even if that ends in a mismatch; then both batches are dropped.
void LockstepCard::judge(Batch& batch) {
  if (!batch.same.valid()) return;
  try {
    compare(batch);
  } catch (...) {
    for (Batch& b : batches_) b.clear();
    throw;
  }
  batch.clear();
  events_.settle(cycles_);
}

void LockstepCard::compare(Batch& batch) {
  const std::size_t same = batch.same.get();
  const std::size_t compared = std::min(same + 1, batch.clocks);
  cycles_ += compared;
  lockstep::count_compared(compared);
  comparisons_ += compared * signals_;
  if (same == batch.clocks) return;
  // Events logged at cycle `cycles_ - 1` or earlier came before the clock of the difference.
  lockstep::fail("card", cycles_, seed_, differences(batch.different, batch.golden[same]), events_.text(cycles_ - 1));
}

}  // namespace trammel::sim
