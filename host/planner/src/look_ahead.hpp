// Holds the blocks that the speed of the first one depends on. Internal to the planner.
#pragma once

#include <cstdint>
#include <memory>

#include "junction.hpp"
#include "path_ring.hpp"
#include "quantiser.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class Planner::LookAhead {
 public:
  LookAhead(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card,
            const PlannerSettings& settings);

  // Plans until the first block is complete, and reads as many blocks as this takes. Null after the last block.
  PathEntry* first();
  // How many pieces begin in the first block.
  std::uint64_t pieces() const { return quantiser_.count(path_.begin()); }
  // A piece that begins in the first block, in order; false after its last.
  bool piece(driver::FeedCommand& piece) { return quantiser_.take(path_.begin(), piece); }
  void pop() { path_.pop(); }
  const PathTicks& ticks() const { return ticks_; }
  const PlanWork& work() const { return plan_->work(); }

 private:
  void go_on();
  void read_block();
  void add_motion(PathEntry& entry);
  std::uint64_t halfwords(const Block& block) const;
  void end_run(PathEntry& last);
  void push_span(const PathEntry& entry, double exit_speed);
  void place(PathEntry& entry, double density);
  double wanted_density(const Block& block) const;
  double even_density(const Block& block) const;
  double least_density(const Block& block) const;
  bool suits(double density, const Block& block) const;
  double hold_speed(const Block& block) const;

  BlockBuilder& blocks_;
  PlannerSettings settings_;
  double clock_hz_;  // enabled clocks per second
  unsigned axes_;    // of the card
  bool pwm_;         // S sets the duty of the pulses on the outputs
  std::uint64_t line_halfwords_;
  double gap_free_ticks_;
  Junctions junctions_;
  // By axis, mm/s: at this speed a hold by SLEW takes as much acceleration as holds may take.
  std::vector<double> hold_speeds_;
  PathRing path_;
  Quantiser quantiser_;
  std::unique_ptr<SpeedPlan> plan_;
  PathEntry* tail_ = nullptr;  // the last motion; its span waits for the corner at its end
  PathTicks ticks_;            // of the last motion
  std::uint64_t queued_ = 0;   // halfwords of all blocks read so far
  bool draining_ = false;      // a run has ended, and its phases are being taken
  bool ended_ = false;
};

}  // namespace trammel::planner
