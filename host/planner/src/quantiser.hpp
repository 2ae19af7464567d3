// From the speed plan's phases to the card's feed pieces, in whole ticks. Internal to the planner.
//
// A phase ends anywhere on the path; its piece begins and ends at the ticks that are nearest, with the speeds that the
// plan has there. A stop ends at the rate of one tick before it, which is the piece's floor: slower, its last tick
// would hang. A start begins at that rate too where acceleration may jump.
//
// This file cuts phases at ticks. PieceShaper gives each part its motion, feed_piece() the card's fields, BlockTimes
// tells the blocks how long they take, and StopDistances holds pieces until all that they depend on is known.
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
  // A piece begins after so many blocks at the latest. The first piece in the ring waits for those behind it: a ring
  // that holds three times as many blocks behind the speed plan's window holds two pieces behind the first one's
  // block, so that force() has one to complete, however long a phase is.
  static constexpr std::uint64_t kMaxBlocks = 1024;

  // `clock_hz`: enabled clocks per second; `stop_clocks`: T_s, how long the fastest rate counts for stop distances.
  // `smooth`: acceleration has no jumps; `card`: what pieces may say, and the clock at full ratio.
  Quantiser(PathRing& path, double clock_hz, double stop_clocks, const QueueLimits& queues, bool smooth,
            const CardLimits& card);

  // In order. The blocks that the phase covers are in the ring, with all but what comes from here.
  void add(const Phase& phase);
  // The first block's pieces are known, complete.
  bool ready() const { return stops_.ready(); }
  // How many pieces begin in block `index`, the first in the ring.
  std::uint64_t count(std::uint64_t index) const { return stops_.count(index); }
  // The next piece that begins in block `index`; false when there is none.
  bool take(std::uint64_t index, driver::FeedCommand& piece) { return stops_.take(index, piece); }
  // The first piece is complete as it is: no room for more behind it. Needs two pieces.
  void force() { stops_.force(); }
  // Nothing follows.
  void finish() { stops_.finish(); }

 private:
  // Where the phases are.
  struct Place {
    bool moving = false;
    bool turns = false;       // from a stop that nothing waits at, or in mid path
    std::uint64_t block = 0;  // in the ring
    double mm = 0;
    double base_mm = 0;           // a place whose tick is known, since when the scale has been the same
    std::uint64_t base_tick = 0;  // that tick
    std::uint64_t spanned = 0;    // blocks since a piece ended with one
  };
  // The end of what is sent.
  struct Sent {
    std::uint64_t tick = 0;
    double end_rate = 0;  // in the last piece's ticks
    Lead lead;
  };
  // A stretch of a phase that begins at `phase_begin` mm: from the last portion's end to `end`, about at `end_tick`.
  struct Portion {
    double phase_begin;
    double end;
    std::uint64_t end_tick;
    bool last;  // of the block or run of blocks with one piece
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
  double full_hz_;  // of the card: clocks a second at full ratio
  TickScale scale_;
  std::unique_ptr<PieceShaper> shaper_;
  BlockTimes times_;
  StopDistances stops_;
  Place at_;
  Pending pending_;
  Sent sent_;
  bool short_sight_ = false;  // of the phase
};

}  // namespace trammel::planner
