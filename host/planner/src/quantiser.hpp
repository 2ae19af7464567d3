// From the speed plan's phases to the card's feed pieces, in whole ticks. Internal to the planner.
//
// A phase ends anywhere on the path; its piece begins and ends at the ticks that are nearest, with the speeds that the
// plan has there. The feed generator holds a rate for 32 clocks and then adds the acceleration, and to that the jerk:
// the rates of a piece are the means of the planned speed over 32 clocks each, so that positions at whole updates are
// the plan's. A stop ends at the rate of one tick before it, which is the piece's floor: slower, its last tick would
// hang. A start begins at that rate too where acceleration may jump.
#pragma once

#include <cstdint>
#include <vector>

#include "path_ring.hpp"
#include "tick_fit.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

// What the card's queues hold.
struct QueueLimits {
  std::uint64_t halfwords = 0;  // of geometry
  std::uint64_t pieces = 0;
};

class Quantiser {
 public:
  // A piece begins after so many blocks at the latest. The first piece in the ring waits for those behind it: a ring
  // that holds three times as many blocks behind the speed plan's window holds two pieces behind the first one's
  // block, so that force() has one to complete, however long a phase is.
  static constexpr std::uint64_t kMostBlocks = 1024;

  // `clock_hz`: enabled clocks a second; `stop_clocks`: T_s, how long the fastest rate counts for stop distances.
  // `smooth`: acceleration has no jumps; `classes`: pieces say theirs.
  Quantiser(PathRing& path, double clock_hz, double stop_clocks, const QueueLimits& queues, bool smooth, bool classes);

  // In order. The blocks that the phase covers are in the ring, with all but what comes from here.
  void add(const Phase& phase);
  // The first block's pieces are known, complete.
  bool ready() const;
  // How many pieces begin in block `index`, the first in the ring.
  std::uint64_t count(std::uint64_t index) const;
  // The next piece that begins in block `index`; false when there is none.
  bool take(std::uint64_t index, driver::FeedCommand& piece);
  // The first piece is complete as it is: no room for more behind it. Needs two pieces.
  void force();

 private:
  // Rates in ticks a clock, times in clocks, from the piece's start.
  struct Motion {
    double rate = 0;
    double acceleration = 0;
    double jerk = 0;
    double clocks = 0;
    double end_rate = 0;
    bool rests = false;  // at its end, whether the program stops there or not
  };
  struct Instant {
    double clocks;
    double rate;
  };
  struct Piece {
    driver::FeedCommand command;
    double most = 0;  // the highest rate
    double clocks = 0;
    std::uint64_t block = 0;  // where it begins
    std::uint64_t begin = 0;  // tick
    bool stop = false;
  };
  // Phases too short for a piece each.
  struct Pending {
    std::uint64_t end = 0;  // tick; where there are none: that of the piece before
    Motion motion;
    double acceleration = 0;  // of the last one
  };

  void change_density(double rate_a_speed);
  void portion(const Phase& phase, double begin, double end, std::uint64_t end_tick, bool last, bool stop);
  std::uint64_t end_tick(const Phase& phase, const PathEntry& block) const;
  Motion ramp(const Phase& phase, double ticks, double lead) const;
  Motion motion_of(const Phase& phase, double from, double to, double ticks, bool stop) const;
  static void begin_at(double rate, double ticks, Motion& motion);
  static Motion steady(double rate, double end_rate, double ticks);
  static double turning_rate(const Motion& motion);
  Motion steady_behind(double lead, double rate, double end_rate, double ticks) const;
  void put_pending(bool stop);
  void put(const Motion& motion, std::uint64_t end_tick, bool stop);
  static double overshoot(const driver::FeedCommand& piece, const Motion& motion, double lead);
  void time_blocks(const Motion& motion, double lead, std::uint64_t end_tick, bool stop);
  static Instant instant(const Motion& motion, double distance, double ticks);
  void complete();
  void see_next();
  static bool ends_queued(const PathEntry& entry);
  void complete_first();
  double reach(const Piece& first);
  double path_reach(const Piece& first);
  // Of what is numbered on, in a ring.
  static std::size_t slot(std::uint64_t i) { return static_cast<std::size_t>(i % kPieces); }
  Piece& piece(std::uint64_t i) { return pieces_[slot(i)]; }
  const Piece& piece(std::uint64_t i) const { return pieces_[slot(i)]; }

  PathRing& path_;
  bool smooth_;
  bool classes_;
  double clock_hz_;
  double stop_clocks_;
  QueueLimits queues_;
  TickFit fit_;  // of motion that is not smooth

  // Where the phases are.
  bool moving_ = false;
  bool turns_ = false;    // from a stop that nothing waits at, or in mid path
  std::uint64_t at_ = 0;  // block
  double mm_ = 0;
  double base_mm_ = 0;  // where the density is what it is from
  std::uint64_t base_tick_ = 0;
  double rate_a_speed_ = 0;  // ticks a clock at 1 mm/s
  std::uint64_t tick_ = 0;   // end of the last piece
  double end_rate_ = 0;      // of the last piece, in its ticks
  double lead_ = 0;          // ticks of the next piece that pass at the last one's rate
  double ahead_ = 0;         // of these, those for which the speed's time does not pass
  Pending pending_;
  std::uint64_t spanned_ = 0;  // blocks since a piece ended with one
  bool short_sight_ = false;

  // Where the pieces are.
  std::uint64_t timed_ = 0;  // block that is not timed yet
  double block_clocks_ = 0;  // of it, so far
  double block_rate_ = 0;

  static constexpr std::size_t kPieces = 16384;

  std::vector<Piece> pieces_;  // a ring
  std::uint64_t reached_ = 0;  // block, with whose commands a full queue ends
  std::uint64_t first_ = 0;
  std::uint64_t completed_ = 0;  // from the first: complete
  std::uint64_t seen_ = 0;       // their rates count in `highest_`
  std::uint64_t last_ = 0;
  double seen_clocks_ = 0;              // of the pieces from completed_ to seen_
  std::vector<std::uint64_t> highest_;  // a ring: pieces from completed_ to seen_ before which none is as fast
  std::uint64_t highest_first_ = 0;
  std::uint64_t highest_last_ = 0;
};

}  // namespace trammel::planner
