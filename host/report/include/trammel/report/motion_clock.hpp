// The commanded motion in time, from the commands alone: when the feed generator makes each tick, and speed,
// acceleration and jerk between. Time is the motion clock: enabled clocks of the card, which stand in holds and
// barriers. Not thread-safe.
//
// A piece adds the rate R_k = r + k a + k (k - 1) / 2 j to the phase in each of the 32 clocks of its k-th update, never
// less than its floor (which a piece is taken to meet once at most); the next one's rate is in force 6 clocks after the
// clock that brings the piece's last tick. The sums are taken in doubles: off by less than a clock.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "trammel/driver/commands.hpp"

namespace trammel::report {

// A stretch of one path under one piece.
struct MotionSegment {
  std::uint64_t path = 0;    // as it was given
  std::uint64_t clocks = 0;  // duration
  // Where it begins: ticks a clock, a clock^2, a clock^3. The stairs of the updates are taken as the curve through
  // their middles.
  double rate = 0;
  double acceleration = 0;
  double jerk = 0;
};

class MotionClock {
 public:
  using Sink = std::function<void(const MotionSegment&)>;
  explicit MotionClock(Sink sink) : sink_(std::move(sink)) {}

  // In the order of the stream. Ticks count from the start of the program.
  void piece(const driver::FeedCommand& piece);
  void path(std::uint64_t path, std::uint64_t ticks);
  // What has come so far ends at rest.
  void barrier();

  // Of all paths so far.
  std::uint64_t ticks() const { return path_ticks_; }
  // Behind a barrier: the clock at which the next piece begins.
  std::uint64_t next_begins() const { return clock_; }
  // The clock that brings a tick. Of ascending ticks, each of a path whose pieces were given.
  std::uint64_t clock_of(std::uint64_t tick);

 private:
  // A piece from the clock on at which its rate is in force.
  class Piece {
   public:
    Piece(const driver::FeedCommand& piece, std::uint64_t clock, double ticks, std::uint64_t end_tick);
    std::uint64_t clock() const { return clock_; }
    std::uint64_t end_tick() const { return end_tick_; }
    // Ticks, fractions counted, since the start of the program when so many clocks of it are over.
    double ticks_after(std::uint64_t clocks) const;
    // The clocks after which that first reaches a tick.
    std::uint64_t clocks_to(double tick) const;
    // After so many of the `all` clocks that it lasts.
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
    double bound_from_;  // from this update on
    double bound_to_;    // and before this one
    double bound_rate_;  // the rate is this
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
  std::deque<Closed> waiting_;  // for the paths that they move
  std::deque<Path> paths_;      // not yet emitted to their ends
  std::deque<Piece> pieces_;    // for clock_of()
  std::uint64_t emitted_ = 0;   // clocks
  std::uint64_t piece_ticks_ = 0;
  std::uint64_t path_ticks_ = 0;
  std::uint64_t clock_ = 0;  // where the next piece begins
  double begin_ = 0;
  bool open_ = false;  // the last piece's end is not yet known
};

}  // namespace trammel::report
