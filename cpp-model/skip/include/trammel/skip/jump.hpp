// Jumps from step to step: many clocks of the motion core at once, with exactly the result of clock().
//
// A jump begins where nothing is decided: no swap, decode, access or step is under way, and the ratio is constant or
// slews. Ticks may be in flight. Within a jump a path may make steps on its axes. The jump ends before the last tick
// of a path or piece is taken, before the prescaler makes a path tick, before a step that could wait long at its
// shaper, and before the ratio arrives or changes for the under-run guard.
//
// If an accumulation of the feed generator at edge t carries, its tick is taken at t+5 and reaches the prescaler at
// t+6 and the axes at t+9; its step shows on the path after edge t+12 and reaches the shaper at t+13. Ticks are
// numbered from the oldest one in flight at the start of the jump. Edges are counted from that clock (0), those of
// ticks in flight backwards. One object per jump; no allocation.
//
// On an arc in chords the axes step on the prescaler's path ticks, one clock later (t+10); a jump ends before the
// tick that ends a half chord.
// that ends a half chord.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/motion_core.hpp"
#include "trammel/model/step_record.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

class Jump {
 public:
  // `cycle`: edges so far; `limit`: maximum number of clocks, below 2^46.
  Jump(model::MotionCore& core, model::StepRecord& record, std::uint64_t cycle, std::uint64_t limit);

  // Returns the clocks passed; 0 if a jump is not worth its cost.
  std::uint64_t go();

 private:
  static constexpr std::uint64_t kNever = UINT64_MAX;
  static constexpr std::int64_t kLastTake = 4;  // clocks from an accumulation to the last edge before its tick is taken
  // Clocks from the arrival of a tick at the axis: to its step on the path, to the shaper.
  static constexpr std::int64_t kToPath = 3;
  static constexpr std::int64_t kToShaper = 4;
  static constexpr std::int64_t kShortest = 16;  // clocks; shorter jumps without a step are not worth their cost

  // The progress of an axis. Its generator has passed `ticks` ticks, and its shaper (in the core) is at edge `edge`.
  // One step may be under way from there.
  struct AxisCursor {
    std::uint64_t ticks = 0;      // ticks of the axes: path ticks on an arc in chords
    std::uint64_t at = 0;         // number of the axis tick that makes the next step
    std::uint64_t next = kNever;  // number of the feed tick that causes it
    std::int64_t edge = 0;
    bool under_way = false;
    bool backwards = false;
    bool path_due = false;     // the step's reports still to be made: on the path
    bool pin_due = false;      // and at the pin
    std::int64_t arrival = 0;  // edge at which the step's tick reaches the axis
    std::int64_t served = 0;   // edge at which the leading edge of the pulse shows
    model::StepShaper after;   // the shaper at edge `served`
  };

  std::uint64_t accumulations_to(std::int64_t edge) const;
  std::int64_t edge_of(std::uint64_t accumulation) const;
  std::uint64_t first_that_stops() const;
  void look_ahead(AxisCursor& t, model::PulseGenerator& generator) const;
  void walk();
  void stop_before(std::uint64_t tick);
  bool find(std::uint64_t tick, model::FeedGenerator& generator, std::uint64_t& done, std::int64_t& edge) const;
  bool step_all(std::uint64_t tick, std::int64_t arrival);
  bool may_step(unsigned axis, std::int64_t arrival, model::StepShaper& after, std::int64_t& served) const;
  void step(unsigned axis, std::uint64_t tick, std::int64_t arrival, std::int64_t served);
  void report_until(std::int64_t edge);
  void look_at_limits(std::int64_t edge, std::uint8_t counts, std::uint8_t back);
  void commit();
  unsigned commit_generator();
  void commit_axis(unsigned axis, std::uint64_t ticks);
  void place_takes(unsigned in_flight);
  std::uint64_t commit_chords(std::uint64_t prescaled, unsigned in_flight);

  model::MotionCore& core_;
  model::StepRecord& record_;
  const std::uint64_t cycle_;
  std::int64_t end_;  // the edge at which the jump ends
  const bool ticking_;
  const bool chords_;           // the path is an arc in chords
  const std::int64_t to_axis_;  // clocks from an accumulation to the axes
  const std::uint64_t first_;   // accumulations at edge 1
  const std::uint64_t second_;  // accumulations at edge 2
  unsigned in_flight_ = 0;      // at the start of the jump: bit k belongs to an accumulation at edge -k
  std::array<std::int64_t, 9> flight_{};
  std::size_t flying_ = 0;          // number of ticks in flight at the start
  std::uint64_t taken_before_ = 0;  // ticks of the path before tick 1

  // Accumulations and carries that the generator has made, and the edge of the last one.
  std::uint64_t done_ = 0;
  std::uint64_t made_ = 0;
  std::int64_t edge_ = 0;

  std::int64_t looked_until_ = 0;  // edge up to which the soft limits have advanced
  bool moved_ = false;
  std::int64_t next_report_ = INT64_MAX;  // not later than the first report that is due
  unsigned axes_;
  std::array<AxisCursor, card_map::kMaxAxes> cursors_{};
};

// Passes up to `limit` clocks under these inputs, from step to step. Returns their number; 0 if not worth its cost.
std::uint64_t advance(model::MotionCore& core, std::uint64_t limit, const model::MotionCore::Inputs& in,
                      std::uint64_t cycle, model::StepRecord& record);

}  // namespace trammel::skip
