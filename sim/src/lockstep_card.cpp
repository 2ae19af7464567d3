#include "lockstep_card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace trammel::sim {

namespace {

constexpr std::size_t kResetClocks = 4;

}  // namespace

LockstepCard::LockstepCard(std::unique_ptr<VerilatedCard> card, const model::CardModel::Config& config,
                           std::uint64_t seed, std::size_t batch)
    : card_(std::move(card)),
      model_(config),
      seed_(seed),
      signals_(signals_compared(config.axes)),
      golden_(batch),
      rtl_(batch) {
  model::CardModel::Inputs reset;
  reset.rst = true;
  CardRecord unused;
  for (std::size_t i = 0; i < kResetClocks; ++i) {
    card_->run(reset, 1, &unused);
    model_.clock(reset);
  }
  // The reset is registered: one more clock under it.
  card_->run({}, 1, &unused);
  model_.clock({});
}

LockstepCard::~LockstepCard() {
  try {
    settle();
  } catch (const std::exception& error) {
    fmt::print(stderr, "found at the end of a lockstep: {}\n", error.what());
    std::abort();
  }
}

void LockstepCard::run(const model::CardModel::Inputs& in, std::uint64_t clocks) {
  while (clocks != 0) {
    const std::size_t some = std::min<std::uint64_t>(clocks, golden_.size() - golden_clocks_);
    stretches_.push_back({in, 0});
    // Counted clock by clock: who receives the model's steps may throw.
    for (std::size_t i = 0; i < some; ++i) {
      model_.clock(in);
      golden_[golden_clocks_++].show(model_);
      ++stretches_.back().clocks;
    }
    if (golden_clocks_ == golden_.size()) settle();
    clocks -= some;
  }
}

void LockstepCard::settle() {
  CardRecord* record = rtl_.data();
  for (const Stretch& stretch : stretches_) {
    card_->run(stretch.in, stretch.clocks, record);
    record += stretch.clocks;
  }
  const std::size_t clocks = golden_clocks_;
  // A batch is compared once, also when that ends in a mismatch.
  stretches_.clear();
  golden_clocks_ = 0;
  compare(clocks);
  events_.settle();
}

// All records at once; they are told apart only when something differs.
void LockstepCard::compare(std::size_t clocks) {
  std::size_t same = clocks;
  if (std::memcmp(rtl_.data(), golden_.data(), clocks * sizeof(CardRecord)) != 0) {
    same = 0;
    while (same < clocks && std::memcmp(&rtl_[same], &golden_[same], sizeof(CardRecord)) == 0) ++same;
  }
  const std::size_t compared = same == clocks ? clocks : same + 1;
  cycles_ += compared;
  comparisons_ += compared * signals_;
  if (same == clocks) return;
  // An event of this many cycles came before the clock that made the difference.
  lockstep::fail("card", cycles_, seed_, differences(rtl_[same], golden_[same]), events_.text(cycles_ - 1));
}

}  // namespace trammel::sim
