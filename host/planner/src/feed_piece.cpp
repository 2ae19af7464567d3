#include "feed_piece.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::planner {
namespace {

constexpr double kMinRate = 0x1p-32;  // one unit of the floor's field

std::uint64_t fixed64(double rate) { return static_cast<std::uint64_t>(std::min(rate, 1 - 0x1p-53) * 0x1p64); }
// A smooth piece shorter than an update can have a change beyond the field. The card does not add it.
std::int64_t signed64(double change) {
  constexpr double kMost = 0x1.fffffffffffffp62;  // the largest double below 2^63
  return static_cast<std::int64_t>(std::clamp(change * 0x1p64, -kMost, kMost));
}
std::uint32_t fixed32(double rate) { return static_cast<std::uint32_t>(std::clamp(rate, kMinRate, 0.5) * 0x1p32); }

// Keeps the floor below the rates of a smooth motion that goes on, by the change of rate in four updates, so that the
// motion does not reach its floor before the piece is over.
double spare_below(const FeedMotion& motion, bool smooth) {
  if (!smooth || motion.rests || motion.jerk == 0) return 0;
  return 4 * std::abs(kUpdate * (motion.acceleration + motion.clocks * motion.jerk));
}

}  // namespace

// U: clocks of an update. The mean of r + a t + j t^2 / 2 over the first update is r + a U / 2 + j U^2 / 6. The next
// mean is greater by U (a + j U), and this difference grows by j U^2 per update.
FeedPiece feed_piece(const FeedMotion& motion, std::uint64_t ticks, double lead, bool smooth) {
  FeedPiece piece;
  piece.clocks = motion.clocks;
  const double turning = turning_rate(motion);
  piece.highest_rate = std::max({motion.rate, motion.end_rate, turning});
  driver::FeedCommand& command = piece.command;
  command.ticks = ticks;
  const bool one_rate = motion.clocks < kUpdate;
  const double rate = one_rate ? (static_cast<double>(ticks) - lead) / motion.clocks
                               : motion.rate + kUpdate / 2 * motion.acceleration + kUpdate * kUpdate / 6 * motion.jerk;
  command.rate = fixed64(std::max(rate, kMinRate));
  // Within one update the card never adds the acceleration. Smooth pieces have it all the same: it has no jump.
  command.acceleration = one_rate && !smooth ? 0 : signed64(kUpdate * (motion.acceleration + kUpdate * motion.jerk));
  command.jerk = one_rate ? 0 : signed64(kUpdate * kUpdate * motion.jerk);
  command.floor = fixed32(std::min({motion.rate, motion.end_rate, turning, rate}) - spare_below(motion, smooth));
  if (motion.rests && motion.jerk != 0) command.floor = fixed32(std::min(motion.end_rate, piece.highest_rate));
  return piece;
}

double overshoot(const driver::FeedCommand& command, const FeedMotion& motion, double lead) {
  constexpr double kUnit = 0x1p-64;
  const double rate = static_cast<double>(command.rate) * kUnit;
  const double acceleration = static_cast<double>(command.acceleration) * kUnit;
  const double jerk = static_cast<double>(command.jerk) * kUnit;
  const double floor = static_cast<double>(command.floor) * 0x1p-32;
  const double ticks = static_cast<double>(command.ticks) - lead;
  const auto gone = [&](double clocks) {
    const double updates = std::floor(clocks / kUpdate);
    const double before = updates - 1;
    const double now = rate + updates * (acceleration + before / 2 * jerk);
    const double whole = updates * (rate + before / 2 * (acceleration + (updates - 2) / 3 * jerk));
    return kUpdate * whole + (clocks - kUpdate * updates) * std::max(now, floor);
  };
  // Finds the first clock at which the last tick has come: first a clock near it, then clock by clock.
  double clocks = std::floor(motion.clocks);
  for (int i = 0; i < 4; ++i) {
    const double step = std::floor((ticks - gone(clocks)) / motion.end_rate);
    if (step == 0) break;
    clocks = std::max(0.0, clocks + step);
  }
  for (int i = 0; i < 16 && clocks > 0 && gone(clocks - 1) >= ticks; ++i) --clocks;
  for (int i = 0; i < 16 && gone(clocks) < ticks; ++i) ++clocks;
  const double beyond = gone(clocks + kFeedSwapDelay) - ticks;
  const double expected = kFeedSwapDelay * motion.end_rate;
  return beyond >= 0 && beyond <= expected + 1 + motion.end_rate ? beyond : expected;
}

}  // namespace trammel::planner
