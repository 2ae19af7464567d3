// Holds feed pieces until their stop distances are known. Internal to the planner.
//
// T_s: the enabled clocks that a hold by SLEW alone takes from full ratio; the hold lasts 2 T_s clocks. A piece with
// the slew shift k lowers the ratio r by s = 2^k / (2 T_s) per clock. In that clock r p ticks pass, where p is the rate
// of the piece. So for each tick n: d(r^2)/dn = -2 s / p <= -1 / W, where W = T_s * highest rate / 2^k. If S is at
// least the W of each piece that a hold reaches, a hold that begins at r takes at most S r^2 ticks. The stop distance S
// is therefore the largest of these W.
//
// In a clock, r enabled clocks pass, so each enabled clock changes r^2 by -2 s. A hold that begins at the end of a
// piece, at r = 1, therefore reaches the next pieces as long as the sum of their clocks * 2^k is below T_s. A hold that
// begins earlier, or at a lower ratio, reaches no farther. A piece is complete when all pieces that far, or up to the
// stop, are known.
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

  // Adds the next piece.
  void put(const FeedPiece& piece);
  // The last piece, if it has not been taken, ends at a stop after all.
  void end_at_stop();
  // Completes the pieces for which all is known by now.
  void complete();
  // Nothing follows the last piece.
  void finish();
  // Completes the first piece as it is, because there is no room for more pieces. Throws std::logic_error if there are
  // fewer than two pieces.
  void force();

  // Whether all pieces of the first block are known and complete.
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
  // Index into a ring for item i.
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
  std::uint64_t completed_ = 0;  // pieces before this one are complete
  std::uint64_t seen_ = 0;       // pieces before this one are counted in `highest_`
  std::uint64_t last_ = 0;
  double seen_clocks_ = 0;  // clocks * 2^k of the pieces after completed_, up to seen_
  // A ring: pieces from completed_ to seen_ after which, up to seen_, no piece has as large a W. The first has the
  // largest.
  std::vector<std::uint64_t> highest_;
  std::uint64_t highest_first_ = 0;
  std::uint64_t highest_last_ = 0;
};

}  // namespace trammel::planner
