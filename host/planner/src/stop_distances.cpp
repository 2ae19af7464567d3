#include "stop_distances.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "trammel/card_map.hpp"

namespace trammel::planner {
namespace {

// A card in an under-run hold resumes when twice the stop distance and a reserve are queued.
constexpr double kResumeFactor = 2;
constexpr double kReserve = card_map::constant::kUnderrunReserveTicks;

std::uint64_t end_of(const FeedPiece& piece) { return piece.begin + piece.command.ticks; }
// Clocks and rate of a piece without slew shift that affects a hold as this piece does.
double slewing_clocks(const FeedPiece& piece) { return piece.clocks * (1 << piece.command.slew_shift); }
double slewing_rate(const FeedPiece& piece) { return piece.highest_rate / (1 << piece.command.slew_shift); }
std::uint32_t ticks32(double ticks) {
  return static_cast<std::uint32_t>(std::clamp(std::ceil(ticks), 1.0, 4294967295.0));
}

// Whether everything up to the stop is queued while a piece that begins in this block is in force. It is if the block
// has one path and ends in a stop: its pieces come before the path. The commands after the stop may come in part. A
// stop distance that reaches beyond the stop would make the card hold until the rest of them has come.
bool ends_queued(const PathEntry& entry) {
  const Geometry geometry = entry.block.geometry;
  return entry.stop && (geometry == Geometry::kLine || geometry == Geometry::kArc ||
                        (geometry == Geometry::kArcChord && entry.block.parts == 1));
}

}  // namespace

StopDistances::StopDistances(const PathRing& path, double stop_clocks, const QueueLimits& queues)
    : path_(path),
      stop_clocks_(stop_clocks),
      pieces_held_(std::max<std::uint64_t>(1, queues.pieces / 2)),
      paths_(path, queues.halfwords / 2),
      pieces_(kPieces),
      highest_(kPieces) {}

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

void StopDistances::complete() {
  while (completed_ != last_) {
    if (seen_ == completed_) see_next();
    while (seen_ != last_ && !at(seen_ - 1).stop && seen_clocks_ < stop_clocks_) see_next();
    const bool known = at(seen_ - 1).stop || seen_clocks_ >= stop_clocks_;
    if (!(known && knows_queues()) && last_ - completed_ < kPieces / 2) return;
    complete_first();
  }
}

void StopDistances::force() {
  if (last_ - completed_ < 2) throw std::logic_error("the ring of blocks is full, and no piece is complete");
  complete_first();
}

void StopDistances::finish() {
  paths_.end();
  complete();
}

void StopDistances::see_next() {
  const FeedPiece& next = at(seen_);
  while (highest_last_ != highest_first_ && slewing_rate(at(highest_[slot(highest_last_ - 1)])) <= slewing_rate(next))
    --highest_last_;
  highest_[slot(highest_last_++)] = seen_;
  seen_clocks_ = seen_ == completed_ ? 0 : seen_clocks_ + slewing_clocks(next);
  ++seen_;
}

// Whether all commands are known that half-full queues hold while the first piece is in force.
bool StopDistances::knows_queues() const {
  if (at(completed_).stop || paths_.ended() || last_ - completed_ > pieces_held_) return true;
  if (last_ - completed_ < 2) return false;
  return paths_.covers(at(completed_ + 1).block, at(last_ - 1).block);
}

// The tick up to which the pieces in a half-full feed queue reach when the first piece begins. A block's pieces come
// before its paths, so if a piece does not fit, the paths end with the block before.
double StopDistances::held_by_pieces() const {
  const std::uint64_t behind = completed_ + pieces_held_;
  if (behind < last_) return static_cast<double>(path_[at(behind).block].begin_ticks);
  return paths_.ended() ? QueuedPaths::kUnlimited : static_cast<double>(end_of(at(last_ - 1)));
}

// The tick up to which half-full queues hold paths and pieces when the first piece begins.
double StopDistances::held_from(const FeedPiece& first) {
  return std::min(held_by_pieces(), paths_.held(first.block, first.begin));
}

// The least number of ticks in half-full queues after any tick of the first piece.
double StopDistances::least_held(const FeedPiece& first) {
  const std::uint64_t end = end_of(first);
  double least = held_by_pieces() - static_cast<double>(end);
  std::uint64_t tick = first.begin;
  for (std::uint64_t index = first.block; tick < end; tick = path_[index++].end_ticks) {
    least = std::min(least, paths_.held(index, tick) - static_cast<double>(tick));
  }
  return least;
}

// Ticks that a stop takes from any tick of the first piece.
double StopDistances::needed(const FeedPiece& first) const {
  const double needed = std::ceil(stop_clocks_ * slewing_rate(at(highest_[slot(highest_first_)])));
  // A stop that begins in the piece continues at the piece's rates, and to the program's own stop at most.
  const FeedPiece& last = at(seen_ - 1);
  if (!last.stop) return needed;
  return std::min(needed,
                  std::ceil(stop_clocks_ * slewing_rate(first)) + static_cast<double>(end_of(last) - end_of(first)));
}

// The end of the first piece's run, if it is known.
double StopDistances::find_stop() {
  stop_ = std::max(stop_, completed_);
  while (stop_ + 1 < last_ && !at(stop_).stop) ++stop_;
  return at(stop_).stop ? static_cast<double>(end_of(at(stop_))) : QueuedPaths::kUnlimited;
}

// The stop distance of the first piece.
double StopDistances::distance(const FeedPiece& first) {
  const double held = held_from(first);
  const double stop = find_stop();
  // All commands of the rest of the run are queued in time, so no wait is needed before its end.
  const double to_stop = stop - static_cast<double>(end_of(first)) - kReserve - 1;
  double most = least_held(first) / kResumeFactor - kReserve;
  if (stop <= held) most = std::max(most, to_stop);
  // While the host fills the queues for the first time, a run may begin with only its own commands queued.
  if (stop <= filled_) most = std::min(most, to_stop);
  return std::min(needed(first), most);
}

void StopDistances::complete_first() {
  FeedPiece& first = at(completed_);
  if (completed_ == 0) filled_ = held_from(first);
  // A path that is a run by itself gets no stop distance. With one, the card would hold when the next block's pieces
  // have come and their path has not. If a stop distance is in force, 1 replaces it; 0 would leave it in force.
  if (!first.stop) {
    const bool queued = ends_queued(path_[first.block]);
    first.command.stop_distance = !queued ? ticks32(distance(first)) : ruled_ ? 1 : 0;
  }
  ruled_ = first.command.stop_distance != 0;
  if (highest_[slot(highest_first_)] == completed_) ++highest_first_;
  ++completed_;
  seen_clocks_ -= completed_ < seen_ ? slewing_clocks(at(completed_)) : seen_clocks_;
}

}  // namespace trammel::planner
