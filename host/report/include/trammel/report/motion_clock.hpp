// Computes the commanded motion in time from the commands: the time of each tick of the feed generator, and speed,
// acceleration and jerk between. The time is the motion clock, which counts enabled clocks of the card and stops in
// holds and barriers. Not thread-safe.
//
// A piece adds the rate R_k = r + k a + k (k - 1) / 2 j to the phase in each of the 32 clocks of its k-th update. The
// rate is never below the piece's floor (it is assumed to meet the floor at most once). The next piece's rate takes
// effect 6 clocks after the clock of the piece's last tick. The sums are computed in doubles, with an error of less
// than a clock.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "trammel/driver/commands.hpp"

namespace trammel::report {

// A part of one path within one feed piece.
struct MotionSegment {
  std::uint64_t path = 0;    // as passed to path()
  std::uint64_t clocks = 0;  // duration
  // Values at the beginning: ticks per clock, per clock^2, per clock^3. The steps of the updates are replaced by the
  // curve through their middles.
  double rate = 0;
  double acceleration = 0;
  double jerk = 0;
};

class MotionClock {
 public:
  using Sink = std::function<void(const MotionSegment&)>;
  explicit MotionClock(Sink sink) : sink_(std::move(sink)) {}

  // Call in the order of the stream. Ticks count from the start of the program.
  void piece(const driver::FeedCommand& piece);
  void path(std::uint64_t path, std::uint64_t ticks);
  // All commands so far end at rest.
  void barrier();

  // Total ticks of all paths so far.
  std::uint64_t ticks() const { return path_ticks_; }
  // After a barrier: the clock at which the next piece begins.
  std::uint64_t next_begins() const { return clock_; }
  // The clock of a tick. Ticks must ascend, and the pieces of their paths must have been given.
  std::uint64_t clock_of(std::uint64_t tick);

 private:
  // A piece, from the clock at which its rate takes effect.
  class Piece {
   public:
    Piece(const driver::FeedCommand& piece, std::uint64_t clock, double ticks, std::uint64_t end_tick);
    std::uint64_t clock() const { return clock_; }
    std::uint64_t end_tick() const { return end_tick_; }
    // Ticks, including fractions, from the start of the program to `clocks` clocks of the piece.
    double ticks_after(std::uint64_t clocks) const;
    // The number of clocks after which ticks_after() first reaches `tick`.
    std::uint64_t clocks_to(double tick) const;
    // The segment that begins after `clocks` of the piece's `all` clocks.
    MotionSegment at(std::uint64_t clocks, std::uint64_t all) const;

   private:
    double rate_at(double update) const;
    double first_beyond(double bound, double least, bool below) const;
    double sum(double updates) const;
    std::uint64_t clock_;
    double begin_;  // ticks
    std::uint64_t end_tick_;
    double rate_;
    double acceleration_;
    double jerk_;
    double floor_;
    double bound_from_;  // from this update on,
    double bound_to_;    // and before this one,
    double bound_rate_;  // the rate has this value
  };
  struct Path {
    std::uint64_t path;
    std::uint64_t end_tick;
  };
  void close(bool last);
  void emit(const Piece& piece, std::uint64_t end_clock);
  void emit_closed();

  Sink sink_;
  struct Closed {
    Piece piece;
    std::uint64_t end_clock;
  };
  std::deque<Closed> waiting_;  // pieces that wait for their paths
  std::deque<Path> paths_;      // paths not completely emitted
  std::deque<Piece> pieces_;    // pieces for clock_of()
  std::uint64_t emitted_ = 0;   // clocks
  std::uint64_t piece_ticks_ = 0;
  std::uint64_t path_ticks_ = 0;
  std::uint64_t clock_ = 0;  // begin of the next piece
  double begin_ = 0;
  bool open_ = false;  // the last piece's end is not yet known
};

}  // namespace trammel::report
