#include "trammel/report/motion_clock.hpp"

#include <algorithm>
#include <cmath>

#include "trammel/card_map.hpp"
#include "trammel/driver/feed_ramp.hpp"

namespace trammel::report {
namespace {

constexpr double kUpdate = card_map::constant::kUpdateClocks;
constexpr std::uint64_t kRounding = 2;  // ticks
constexpr double kFastest = 1 - 0x1p-48;

}  // namespace

MotionClock::Piece::Piece(const driver::FeedCommand& piece, std::uint64_t clock, double ticks, std::uint64_t end_tick)
    : clock_(clock),
      begin_(ticks),
      end_tick_(end_tick),
      rate_(static_cast<double>(piece.rate) * 0x1p-64),
      acceleration_(static_cast<double>(piece.acceleration) * 0x1p-64),
      jerk_(static_cast<double>(piece.jerk) * 0x1p-64),
      floor_(static_cast<double>(piece.floor) * 0x1p-32) {
  const double low = first_beyond(floor_, 1, true);
  const double high = first_beyond(kFastest, 1, false);
  bound_from_ = std::min(low, high);
  bound_rate_ = low <= high ? floor_ : kFastest;
  bound_to_ = bound_from_ < INFINITY ? first_beyond(bound_rate_, bound_from_, low > high) : INFINITY;
}

double MotionClock::Piece::rate_at(double update) const {
  return rate_ + update * acceleration_ + update * (update - 1) / 2 * jerk_;
}

// The first update, from `least` on, whose rate is below `bound` (or above it); infinite if there is none.
double MotionClock::Piece::first_beyond(double bound, double least, bool below) const {
  const auto beyond = [&](double update) { return below ? rate_at(update) < bound : rate_at(update) > bound; };
  if (beyond(least)) return least;
  const double linear = acceleration_ - jerk_ / 2;
  const double constant = rate_ - bound;
  double roots[2] = {INFINITY, INFINITY};
  if (jerk_ == 0) {
    if (linear != 0) roots[0] = -constant / linear;
  } else {
    const double square = linear * linear - 2 * jerk_ * constant;
    if (square < 0) return INFINITY;
    // Avoids the difference of two nearly equal numbers.
    const double sum = -(linear + std::copysign(std::sqrt(square), linear));
    roots[0] = sum / jerk_;
    if (sum != 0) roots[1] = 2 * constant / sum;
  }
  double first = INFINITY;
  for (const double root : roots) {
    if (!(root >= least) || !std::isfinite(root)) continue;
    const double update = std::floor(root) + 1;
    if (beyond(update)) first = std::min(first, update);
  }
  return first;
}

// Ticks of `updates` whole updates, without the bounds of the rate.
double MotionClock::Piece::sum(double updates) const {
  const double pairs = updates * (updates - 1) / 2;
  return kUpdate * (updates * rate_ + pairs * acceleration_ + pairs * (updates - 2) / 3 * jerk_);
}

double MotionClock::Piece::ticks_after(std::uint64_t clocks) const {
  const auto all = static_cast<double>(clocks);
  const double update = std::floor(all / kUpdate);
  const double rest = all - update * kUpdate;
  if (update < bound_from_) return begin_ + sum(update) + rest * rate_at(update);
  const double bounded = begin_ + sum(bound_from_);
  if (update < bound_to_) return bounded + (all - bound_from_ * kUpdate) * bound_rate_;
  return bounded + (bound_to_ - bound_from_) * kUpdate * bound_rate_ + sum(update) - sum(bound_to_) +
         rest * rate_at(update);
}

std::uint64_t MotionClock::Piece::clocks_to(double tick) const {
  if (ticks_after(0) >= tick) return 0;
  constexpr std::uint64_t kMax = std::uint64_t{1} << 62;
  std::uint64_t before = 0;
  std::uint64_t reached = 64;
  while (reached < kMax && ticks_after(reached) < tick) {
    before = reached;
    reached *= 2;
  }
  while (reached - before > 1) {
    const std::uint64_t middle = before + (reached - before) / 2;
    (ticks_after(middle) < tick ? before : reached) = middle;
  }
  return reached;
}

MotionSegment MotionClock::Piece::at(std::uint64_t clocks, std::uint64_t all) const {
  MotionSegment segment;
  // A piece that ends before its first update has a constant rate; its acceleration has no effect.
  if (static_cast<double>(all) <= kUpdate) {
    segment.rate = rate_;
    return segment;
  }
  const double update = static_cast<double>(clocks) / kUpdate - 0.5;  // an update's rate is the one at its middle
  if (update + 0.5 >= bound_from_ && update + 0.5 < bound_to_) {
    segment.rate = bound_rate_;
    return segment;
  }
  segment.rate = std::max(0.0, rate_at(update));
  segment.acceleration = (acceleration_ + (2 * update - 1) / 2 * jerk_) / kUpdate;
  segment.jerk = jerk_ / (kUpdate * kUpdate);
  return segment;
}

void MotionClock::piece(const driver::FeedCommand& piece) {
  if (open_) close(false);
  piece_ticks_ += piece.ticks;
  pieces_.emplace_back(piece, clock_, begin_, piece_ticks_);
  open_ = true;
  emit_closed();
}

void MotionClock::close(bool last) {
  const Piece& piece = pieces_.back();
  std::uint64_t clocks = piece.clocks_to(static_cast<double>(piece.end_tick()));
  // The clocks of the swap belong to the next piece, because on another path this piece's acceleration would be
  // meaningless.
  waiting_.push_back({piece, piece.clock() + clocks});
  if (!last) clocks += driver::kFeedSwapDelay;
  clock_ = piece.clock() + clocks;
  begin_ = last ? static_cast<double>(piece.end_tick()) : piece.ticks_after(clocks);
  open_ = false;
}

void MotionClock::path(std::uint64_t path, std::uint64_t ticks) {
  path_ticks_ += ticks;
  paths_.push_back({path, path_ticks_});
  emit_closed();
}

void MotionClock::barrier() {
  if (open_) close(true);
  emit_closed();
}

void MotionClock::emit_closed() {
  while (!waiting_.empty() && !paths_.empty()) {
    const Closed& now = waiting_.front();
    const Path& path = paths_.front();
    const std::uint64_t path_end = now.piece.clock() + now.piece.clocks_to(static_cast<double>(path.end_tick));
    // Path and piece end together, except for a tick of rounding. A segment of that tick would show the acceleration of
    // one on the geometry of the other.
    const std::uint64_t piece_end = now.piece.end_tick();
    const bool together = std::max(path.end_tick, piece_end) - std::min(path.end_tick, piece_end) <= kRounding;
    const bool path_ends = together || path_end <= now.end_clock;
    const std::uint64_t end = path_ends ? path_end : now.end_clock;
    if (end > emitted_) {
      const std::uint64_t begin = now.piece.clock();
      MotionSegment segment = now.piece.at(std::max(emitted_, begin) - begin, now.end_clock - begin);
      segment.path = path.path;
      segment.clocks = end - emitted_;
      sink_(segment);
      emitted_ = end;
    }
    if (path_ends) paths_.pop_front();
    if (together || !path_ends) waiting_.pop_front();
  }
}

std::uint64_t MotionClock::clock_of(std::uint64_t tick) {
  const auto at = static_cast<double>(tick);
  // A piece continues for some clocks after its last tick, and a tick of the next piece may occur in them.
  while (pieces_.size() > 1 && pieces_[1].ticks_after(0) < at) pieces_.pop_front();
  return pieces_.front().clock() + pieces_.front().clocks_to(at);
}

}  // namespace trammel::report
