#include "trammel/skip/feed_generator.hpp"

#include <algorithm>

namespace trammel::skip {

namespace {

// Carries handled at a time, so that the sums of phases fit in 64 bits.
constexpr std::uint64_t kMaxCarries = std::uint64_t{1} << 14;
// Updates for which one check of the clamp is enough.
constexpr std::uint64_t kStretch = 64;

}  // namespace

FeedAhead::Advanced FeedAhead::advance(std::uint64_t limit, std::uint64_t carries) {
  Advanced gone;
  while (gone.carries < carries && gone.enables < limit) {
    const std::uint64_t some = std::min(carries - gone.carries, kMaxCarries);
    if (s_.constant)
      advance_constant(gone, limit - gone.enables, some);
    else
      advance_varying(gone, limit - gone.enables, some);
  }
  return gone;
}

void FeedAhead::advance_constant(Advanced& gone, std::uint64_t limit, std::uint64_t carries) {
  const std::uint64_t to_go = (carries << 48) - s_.phase;
  const std::uint64_t needed = s_.slope == 0 ? limit : (to_go - 1) / s_.slope + 1;
  const std::uint64_t enables = std::min(limit, needed);
  const std::uint64_t sum = s_.phase + enables * s_.slope;
  gone.enables += enables;
  gone.carries += sum >> 48;
  s_.phase = sum & (model::FeedGenerator::kOne - 1);
  s_.count = static_cast<std::uint32_t>((s_.count + enables) % model::FeedGenerator::kUpdateClocks);
}

void FeedAhead::advance_varying(Advanced& gone, std::uint64_t limit, std::uint64_t carries) {
  const std::uint64_t target = carries << 48;
  std::uint64_t sum = s_.phase;
  std::uint64_t left = limit;
  while (left != 0 && sum < target && !s_.constant) {
    if (s_.count == 0) {
      left -=
          whole_updates(sum, target, left / model::FeedGenerator::kUpdateClocks) * model::FeedGenerator::kUpdateClocks;
      if (left == 0 || s_.constant) break;
    }
    const std::uint64_t most = std::min<std::uint64_t>(left, model::FeedGenerator::kUpdateClocks - s_.count);
    const bool arrives = sum + most * s_.slope >= target;
    const std::uint64_t enables = arrives ? (target - sum - 1) / s_.slope + 1 : most;
    sum += enables * s_.slope;
    left -= enables;
    s_.count = static_cast<std::uint32_t>((s_.count + enables) % model::FeedGenerator::kUpdateClocks);
    if (s_.count == 0) block_.update();
  }
  gone.enables += limit - left;
  gone.carries += sum >> 48;
  s_.phase = sum & (model::FeedGenerator::kOne - 1);
}

// True if rate and acceleration keep the slope between the floor and 1 for this number of updates.
bool FeedAhead::unclamped_for(std::uint64_t updates) const {
  const auto negative = [](model::uint128 value) { return value >> 127 != 0; };
  const auto magnitude = [&](model::uint128 value) { return negative(value) ? model::uint128{0} - value : value; };
  const model::uint128 difference = magnitude(s_.acceleration) + magnitude(s_.jerk) * updates;
  if (difference >> 63 != 0 || negative(s_.rate)) return false;
  const model::uint128 span = difference * updates;
  return s_.rate >= span + s_.floor_rate && (s_.rate + span) >> 64 == 0;
}

// Passes updates from a count of 0, up to the one that would reach the target. The hot loop of a changing rate.
std::uint64_t FeedAhead::whole_updates(std::uint64_t& sum, std::uint64_t target, std::uint64_t most) {
  std::uint64_t gone = 0;
  while (gone < most && unclamped_for(kStretch)) {
    auto rate = static_cast<std::uint64_t>(s_.rate);
    auto acceleration = static_cast<std::uint64_t>(s_.acceleration);
    const auto jerk = static_cast<std::uint64_t>(s_.jerk);
    const std::uint64_t stretch = std::min(kStretch, most - gone);
    std::uint64_t updates = 0;
    for (; updates < stretch; ++updates) {
      const std::uint64_t next = sum + (rate >> 16) * model::FeedGenerator::kUpdateClocks;
      if (next >= target) break;
      sum = next;
      rate += acceleration;
      acceleration += jerk;
    }
    s_.rate = rate;
    s_.acceleration = model::FeedGenerator::sign_extended(acceleration);
    if (updates != 0) s_.slope = rate >> 16;
    gone += updates;
    if (updates != stretch) break;
  }
  if (gone != 0) s_.constant = s_.acceleration == 0 && s_.jerk == 0;
  return gone;
}

}  // namespace trammel::skip
