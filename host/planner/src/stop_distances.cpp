#include "stop_distances.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "trammel/card_map.hpp"

namespace trammel::planner {
namespace {

// A card that holds for want of paths goes on with twice the stop distance and a reserve. What it needs must be there
// while the host fills a queue that is half empty: no stop distance is more than this part of full queues.
constexpr double kFillOfReach = 4;
constexpr double kReserve = card_map::constant::kUnderrunReserveTicks;

std::uint32_t ticks32(double ticks) { return static_cast<std::uint32_t>(std::min(std::ceil(ticks), 4294967295.0)); }

// While a piece that begins in the block is in force, all up to the stop is queued: the pieces come before the only
// path. What follows may come in part; a stop distance beyond the stop would make the card hold until the rest is
// there.
bool ends_queued(const PathEntry& entry) {
  const Geometry geometry = entry.block.geometry;
  return entry.stop && (geometry == Geometry::kLine || geometry == Geometry::kArc ||
                        (geometry == Geometry::kArcChord && entry.block.parts == 1));
}

}  // namespace

StopDistances::StopDistances(const PathRing& path, double stop_clocks, const QueueLimits& queues)
    : path_(path), stop_clocks_(stop_clocks), queues_(queues), pieces_(kPieces), highest_(kPieces) {}

void StopDistances::put(const FeedPiece& piece) { at(last_++) = piece; }

void StopDistances::end_at_stop() {
  if (last_ != first_) at(last_ - 1).stop = true;
}

bool StopDistances::ready() const {
  return path_[path_.begin()].timed && (completed_ == last_ || at(completed_).block > path_.begin());
}

std::uint64_t StopDistances::count(std::uint64_t index) const {
  std::uint64_t next = first_;
  while (next != completed_ && at(next).block == index) ++next;
  return next - first_;
}

bool StopDistances::take(std::uint64_t index, driver::FeedCommand& command) {
  if (first_ == completed_ || at(first_).block != index) return false;
  command = at(first_++).command;
  return true;
}

// Stop distances: a piece is complete when all is known that follows within T_s, or to the stop.
void StopDistances::complete() {
  while (completed_ != last_) {
    if (seen_ == completed_) see_next();
    while (seen_ != last_ && !at(seen_ - 1).stop && seen_clocks_ < stop_clocks_) see_next();
    const bool known = at(seen_ - 1).stop || seen_clocks_ >= stop_clocks_;
    if (!known && last_ - completed_ < kPieces / 2) return;
    complete_first();
  }
}

void StopDistances::force() {
  if (last_ - completed_ < 2) throw std::logic_error("the ring of blocks is full, and no piece is complete");
  complete_first();
}

void StopDistances::see_next() {
  const FeedPiece& next = at(seen_);
  while (highest_last_ != highest_first_ && at(highest_[slot(highest_last_ - 1)]).highest_rate <= next.highest_rate)
    --highest_last_;
  highest_[slot(highest_last_++)] = seen_;
  seen_clocks_ = seen_ == completed_ ? 0 : seen_clocks_ + next.clocks;
  ++seen_;
}

// Ticks that are queued behind a piece's begin when queues are full; where less is known than fits, the rest is taken
// to be as long.
double StopDistances::reach(const FeedPiece& first) {
  const std::uint64_t pieces = std::min(queues_.pieces, last_ - completed_);
  const FeedPiece& last = at(completed_ + pieces - 1);
  const double ticks = static_cast<double>(last.begin + last.command.ticks - first.begin);
  return std::min(path_reach(first), ticks * static_cast<double>(queues_.pieces) / static_cast<double>(pieces));
}

// By the paths. The commands of a block have equal ticks, and its pieces begin anywhere in it.
double StopDistances::path_reach(const FeedPiece& first) {
  const auto fit = static_cast<double>(queues_.halfwords);
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
  const auto before = [](std::uint64_t at, std::uint64_t from) { return static_cast<double>(at - from); };
  const PathEntry& begin = path_[first.block];
  const double gone = share(before(first.begin, begin.begin_ticks), before(begin.end_ticks, begin.begin_ticks)) *
                      static_cast<double>(begin.halfwords);
  reached_ = std::max(reached_, first.block);
  while (reached_ + 1 != path_.end() && before(path_[reached_ + 1].queued, begin.queued) - gone < fit) ++reached_;
  const PathEntry& end = path_[reached_];
  const double known = std::min(fit, before(end.queued + end.halfwords, begin.queued) - gone);
  const double part = known - (before(end.queued, begin.queued) - gone);
  const double ticks = before(end.begin_ticks, begin.begin_ticks) - before(first.begin, begin.begin_ticks) +
                       part / static_cast<double>(end.halfwords) * before(end.end_ticks, end.begin_ticks);
  return ticks * fit / known;
}

void StopDistances::complete_first() {
  FeedPiece& first = at(completed_);
  const std::uint64_t highest = highest_[slot(highest_first_)];
  const double rate = at(highest).highest_rate;
  // At least 1: 0 says that the piece ends at rest.
  if (!first.stop) {
    double wanted = std::ceil(stop_clocks_ * rate);
    // A stop that begins in the piece goes on at its rates, and to the program's own stop at most.
    if (const FeedPiece& last = at(seen_ - 1); last.stop) {
      const std::uint64_t behind = last.begin + last.command.ticks - first.begin - first.command.ticks;
      wanted = std::min(wanted, std::ceil(stop_clocks_ * first.highest_rate) + static_cast<double>(behind));
    }
    wanted = std::min(wanted, reach(first) / kFillOfReach - kReserve);
    first.command.stop_distance = wanted > 1 && !ends_queued(path_[first.block]) ? ticks32(wanted) : 1;
  }
  if (highest == completed_) ++highest_first_;
  ++completed_;
  seen_clocks_ -= completed_ < seen_ ? at(completed_).clocks : seen_clocks_;
}

}  // namespace trammel::planner
