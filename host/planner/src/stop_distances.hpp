// Holds feed pieces until their stop distances are known. Internal to the planner.
//
// T_s: the enabled clocks that a hold by SLEW alone takes from full ratio, which is 2 T_s clocks. A piece with the slew
// shift k lowers the ratio r by s = 2^k / (2 T_s) in a clock, in which r p ticks pass, p its rate. So for each tick n
// d(r^2)/dn = -2 s / p <= -1 / W, where W = T_s * highest rate / 2^k. A hold that begins at r takes at most S r^2 ticks
// if S is no less than the W of each piece that it comes into: S is the largest of them.
//
// In a clock r enabled clocks pass: d(r^2) is -2 s for each of them. So from the end of a piece, at r = 1, a hold comes
// into those behind as far as the sum of their clocks * 2^k is below T_s; from before, or from a lower ratio, no
// further. A piece is complete when all is known that follows so far, or to the stop.
#pragma once

#include <cstdint>
#include <vector>

#include "feed_piece.hpp"
#include "path_ring.hpp"
#include "queued_paths.hpp"

namespace trammel::planner {

class StopDistances {
 public:
  // `path` must outlive it. `stop_clocks`: T_s, the enabled clocks that a hold by SLEW alone takes from full ratio.
  StopDistances(const PathRing& path, double stop_clocks, const QueueLimits& queues);

  // In order.
  void put(const FeedPiece& piece);
  // The last piece, if it has not been taken, ends at a stop after all.
  void end_at_stop();
  // Completes what is known by now.
  void complete();
  // Nothing follows the last piece.
  void finish();
  // The first piece is complete as it is: no room for more behind it. Throws std::logic_error with less than two.
  void force();

  // The first block's pieces are known, complete.
  bool ready() const;
  // How many pieces begin in block `index`, the first in the ring.
  std::uint64_t count(std::uint64_t index) const;
  // The next piece that begins in block `index`; false when there is none.
  bool take(std::uint64_t index, driver::FeedCommand& command);

 private:
  static constexpr std::size_t kPieces = 16384;

  void see_next();
  void complete_first();
  bool knows_queues() const;
  double held_by_pieces() const;
  double held_from(const FeedPiece& first);
  double least_held(const FeedPiece& first);
  double needed(const FeedPiece& first) const;
  double find_stop();
  double distance(const FeedPiece& first);
  // Of what is numbered on, in a ring.
  static std::size_t slot(std::uint64_t i) { return static_cast<std::size_t>(i % kPieces); }
  FeedPiece& at(std::uint64_t i) { return pieces_[slot(i)]; }
  const FeedPiece& at(std::uint64_t i) const { return pieces_[slot(i)]; }

  const PathRing& path_;
  double stop_clocks_;
  std::uint64_t pieces_held_;
  QueuedPaths paths_;
  std::vector<FeedPiece> pieces_;  // a ring
  bool ruled_ = false;             // the piece completed last has a stop distance
  double filled_ = 0;              // tick up to which the host fills the queues when the program begins
  std::uint64_t stop_ = 0;         // the next piece that ends at a stop, or the last one that was looked at
  std::uint64_t first_ = 0;
  std::uint64_t completed_ = 0;  // from the first: complete
  std::uint64_t seen_ = 0;       // their rates count in `highest_`
  std::uint64_t last_ = 0;
  double seen_clocks_ = 0;              // of the pieces behind completed_ to seen_, times 2^k
  std::vector<std::uint64_t> highest_;  // a ring: pieces from completed_ to seen_ before which none has as large a W
  std::uint64_t highest_first_ = 0;
  std::uint64_t highest_last_ = 0;
};

}  // namespace trammel::planner
