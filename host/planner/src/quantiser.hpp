// From the speed plan's phases to the card's feed pieces, in whole ticks. Internal to the planner.
//
// A phase may end anywhere on the path. Its piece begins and ends at the nearest ticks, with the speeds that the plan
// has there. A stop ends at the rate that the plan has one tick (S-curve) or half a tick (trapezoid) before it, which
// is the piece's floor; at a lower rate the last tick would take too long. A start begins at that rate too: always in
// trapezoid plans, and in S-curve plans if nothing waits at the stop before.
//
// This file cuts phases at ticks. PieceShaper computes the motion of each part, feed_piece() the fields of the command,
// and BlockTimes the durations of the blocks. StopDistances holds pieces until all that they depend on is known.
#pragma once

#include <cstdint>
#include <memory>

#include "block_times.hpp"
#include "path_ring.hpp"
#include "piece_shaper.hpp"
#include "stop_distances.hpp"
#include "tick_scale.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/planner/card_limits.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class Quantiser {
 public:
  // A piece begins after so many blocks at the latest. The first piece in the ring waits for later pieces. A ring with
  // room for three times as many blocks after the speed plan's window holds two pieces after the first piece's block,
  // so force() has a piece to complete, however long a phase is.
  static constexpr std::uint64_t kMaxBlocks = 1024;

  // `clock_hz`: enabled clocks per second; `stop_clocks`: T_s of stop_distances.hpp. `smooth`: acceleration has no
  // jumps; `card`: the optional fields of pieces, and the clock at full ratio.
  Quantiser(PathRing& path, double clock_hz, double stop_clocks, const QueueLimits& queues, bool smooth,
            const CardLimits& card);

  // Adds the next phase. The blocks that it covers are in the ring, complete except for the fields that this class
  // sets.
  void add(const Phase& phase);
  // Whether all pieces of the first block are known and complete.
  bool ready() const { return stops_.ready(); }
  // How many pieces begin in block `index`, the first in the ring.
  std::uint64_t count(std::uint64_t index) const { return stops_.count(index); }
  // The next piece that begins in block `index`; false when there is none.
  bool take(std::uint64_t index, driver::FeedCommand& piece) { return stops_.take(index, piece); }
  // Completes the first piece as it is, because there is no room for more pieces. There must be at least two pieces.
  void force() { stops_.force(); }
  // Nothing follows the last phase.
  void finish() { stops_.finish(); }

 private:
  // The end of the phases so far.
  struct Place {
    bool moving = false;
    bool turns = false;       // began at rest: at a stop without a wait, or in mid path
    std::uint64_t block = 0;  // the block at this place, as an index into the ring
    double mm = 0;
    double base_mm = 0;           // a place with a known tick; the scale has not changed since
    std::uint64_t base_tick = 0;  // the tick at base_mm
    std::uint64_t spanned = 0;    // blocks since the last piece that ended with a block
  };
  // The end of the last piece.
  struct Sent {
    std::uint64_t tick = 0;
    double end_rate = 0;  // ticks per clock, in the density of the last piece
    Lead lead;
  };
  // A stretch of the phase that begins at `phase_begin` mm: from the last portion's end to `end` mm, which is close to
  // `end_tick`.
  struct Portion {
    double phase_begin;
    double end;
    std::uint64_t end_tick;
    bool last;  // last portion of a block, or of a run of blocks that share pieces
    bool stop;
  };

  void begin_run(bool waits);
  void change_density(double density);
  std::uint64_t end_tick(const Phase& phase, const PathEntry& block) const;
  double millimetres(std::uint64_t tick) const;
  void portion(const Phase& phase, const Portion& portion);
  PhasePart part_of(const Portion& portion) const;
  bool shape(const Phase& phase, const Portion& portion, const PhasePart& part);
  void put_pending(bool stop);
  void put(const FeedMotion& motion, std::uint64_t end_tick, bool stop);
  std::uint8_t slew_shift(const FeedPiece& piece, std::uint64_t end_tick) const;

  PathRing& path_;
  bool smooth_;
  bool classes_;
  bool slew_shifts_;
  double full_hz_;  // of the card: clocks per second at full ratio
  TickScale scale_;
  std::unique_ptr<PieceShaper> shaper_;
  BlockTimes times_;
  StopDistances stops_;
  Place at_;
  Pending pending_;
  Sent sent_;
  bool short_sight_ = false;  // Phase::short_sight of the present phase
};

}  // namespace trammel::planner
