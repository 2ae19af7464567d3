#include "trammel/model/feed_generator.hpp"

#include <algorithm>

namespace trammel::model {

namespace {

// Carries at a time, so that phases do not leave 64 bits.
constexpr std::uint64_t kMaxCarries = std::uint64_t{1} << 14;
// Updates for which the clamp is judged at once.
constexpr std::uint64_t kStretch = 64;

}  // namespace

FeedGenerator::Advanced FeedGenerator::advance(std::uint64_t limit, std::uint64_t carries) {
  Advanced gone;
  while (gone.carries < carries && gone.enables < limit) {
    const std::uint64_t some = std::min(carries - gone.carries, kMaxCarries);
    if (constant_)
      advance_constant(gone, limit - gone.enables, some);
    else
      advance_varying(gone, limit - gone.enables, some);
  }
  return gone;
}

void FeedGenerator::advance_constant(Advanced& gone, std::uint64_t limit, std::uint64_t carries) {
  const std::uint64_t to_go = (carries << 48) - phase_;
  const std::uint64_t needed = slope_ == 0 ? limit : (to_go - 1) / slope_ + 1;
  const std::uint64_t enables = std::min(limit, needed);
  const std::uint64_t sum = phase_ + enables * slope_;
  gone.enables += enables;
  gone.carries += sum >> 48;
  phase_ = sum & (kOne - 1);
  count_ = static_cast<std::uint32_t>((count_ + enables) % kUpdateClocks);
}

void FeedGenerator::advance_varying(Advanced& gone, std::uint64_t limit, std::uint64_t carries) {
  const std::uint64_t target = carries << 48;
  std::uint64_t sum = phase_;
  std::uint64_t left = limit;
  while (left != 0 && sum < target && !constant_) {
    if (count_ == 0) {
      left -= whole_updates(sum, target, left / kUpdateClocks) * kUpdateClocks;
      if (left == 0 || constant_) break;
    }
    const std::uint64_t most = std::min<std::uint64_t>(left, kUpdateClocks - count_);
    const bool arrives = sum + most * slope_ >= target;
    const std::uint64_t enables = arrives ? (target - sum - 1) / slope_ + 1 : most;
    sum += enables * slope_;
    left -= enables;
    count_ = static_cast<std::uint32_t>((count_ + enables) % kUpdateClocks);
    if (count_ == 0) update();
  }
  gone.enables += limit - left;
  gone.carries += sum >> 48;
  phase_ = sum & (kOne - 1);
}

// Rate and its difference stay between floor and 1 for so many updates.
bool FeedGenerator::unclamped_for(std::uint64_t updates) const {
  const auto negative = [](uint128 value) { return value >> 127 != 0; };
  const auto magnitude = [&](uint128 value) { return negative(value) ? uint128{0} - value : value; };
  const uint128 difference = magnitude(acceleration_) + magnitude(jerk_) * updates;
  if (difference >> 63 != 0 || negative(rate_)) return false;
  const uint128 span = difference * updates;
  return rate_ >= span + floor_rate_ && (rate_ + span) >> 64 == 0;
}

// Updates without a carry that reaches the target, from a count of 0. The hot loop of a changing rate.
std::uint64_t FeedGenerator::whole_updates(std::uint64_t& sum, std::uint64_t target, std::uint64_t most) {
  std::uint64_t gone = 0;
  while (gone < most && unclamped_for(kStretch)) {
    auto rate = static_cast<std::uint64_t>(rate_);
    auto acceleration = static_cast<std::uint64_t>(acceleration_);
    const auto jerk = static_cast<std::uint64_t>(jerk_);
    const std::uint64_t stretch = std::min(kStretch, most - gone);
    std::uint64_t updates = 0;
    for (; updates < stretch; ++updates) {
      const std::uint64_t next = sum + (rate >> 16) * kUpdateClocks;
      if (next >= target) break;
      sum = next;
      rate += acceleration;
      acceleration += jerk;
    }
    rate_ = rate;
    acceleration_ = sign_extended(acceleration);
    if (updates != 0) slope_ = rate >> 16;
    gone += updates;
    if (updates != stretch) break;
  }
  if (gone != 0) constant_ = acceleration_ == 0 && jerk_ == 0;
  return gone;
}

}  // namespace trammel::model
