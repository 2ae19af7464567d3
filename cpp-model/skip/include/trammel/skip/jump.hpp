// Going from step to step: many clocks of the motion core at once, exactly as clock() would.
//
// A jump begins where nothing is decided: no swap, decode, access or step under way, a ratio that stands or slews.
// Ticks may be in flight. Within it a path may make steps on its axes; a jump ends before a path's or piece's last tick
// is taken, before the prescaler makes a path tick, before a step that could wait long at its shaper, and before a
// ratio arrives or is another for the under-run guard.
//
// An accumulation of the feed generator at edge t that carries is a tick that is taken at t+5, reaches the prescaler at
// t+6 and the axes at t+9; its step shows on the path after edge t+12 and reaches the shaper at t+13. Ticks are
// numbered from the oldest that was in flight as the jump began; edges are counted from that clock (0), those of ticks
// in flight backwards. One object a jump; no allocation.
//
// On an arc in chords the axes step on the prescaler's path ticks, a clock later (t+10); a jump ends before the tick
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
  // `cycle`: edges so far; `limit`: clocks at most, below 2^46.
  Jump(model::MotionCore& core, model::StepRecord& record, std::uint64_t cycle, std::uint64_t limit);

  // Returns the clocks that are gone; 0 where it was not worth it.
  std::uint64_t go();

 private:
  static constexpr std::uint64_t kNever = UINT64_MAX;
  static constexpr std::int64_t kLastTake = 4;  // from an accumulation: the last edge before its tick is taken
  // From the axis.
  static constexpr std::int64_t kToPath = 3;
  static constexpr std::int64_t kToShaper = 4;
  static constexpr std::int64_t kShortest = 16;

  // An axis on its way. Its generator stands after `ticks` ticks, its shaper (the core's) at edge `edge`; it may have
  // one step under way from there.
  struct AxisCursor {
    std::uint64_t ticks = 0;      // of the axes: path ticks on an arc in chords
    std::uint64_t at = 0;         // that which makes the next step
    std::uint64_t next = kNever;  // number of the feed tick that it comes from
    std::int64_t edge = 0;
    bool under_way = false;
    bool backwards = false;
    bool path_due = false;  // reports that are still to be made
    bool pin_due = false;
    std::int64_t arrival = 0;  // of its tick at the axis
    std::int64_t served = 0;   // the edge at which the pulse's leading edge shows
    model::StepShaper after;   // the shaper then
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
  const bool chords_;           // ticking on an arc in chords
  const std::int64_t to_axis_;  // from an accumulation
  const std::uint64_t first_;   // accumulations at edge 1
  const std::uint64_t second_;  // and at edge 2
  unsigned in_flight_ = 0;      // as the jump begins: bit k from an accumulation at edge -k
  std::array<std::int64_t, 9> flight_{};
  std::size_t flying_ = 0;          // ticks that were in flight
  std::uint64_t taken_before_ = 0;  // ticks of the path before tick 1

  // The generator stands after so many accumulations and carries, the last at this edge.
  std::uint64_t done_ = 0;
  std::uint64_t made_ = 0;
  std::int64_t edge_ = 0;

  std::int64_t looked_until_ = 0;  // the edge that the soft limits stand at
  bool moved_ = false;
  std::int64_t next_report_ = INT64_MAX;  // not later than the first report due
  unsigned axes_;
  std::array<AxisCursor, card_map::kMaxAxes> cursors_{};
};

// What of a jump's clocks `limit` may be gone under these inputs: from step to step; 0 where it is not worth it.
std::uint64_t advance(model::MotionCore& core, std::uint64_t limit, const model::MotionCore::Inputs& in,
                      std::uint64_t cycle, model::StepRecord& record);

}  // namespace trammel::skip
