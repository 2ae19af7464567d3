// Builds the plan from the events of a pass. Internal to the runner.
#pragma once

#include <algorithm>

#include "pipeline.hpp"
#include "trammel/run/feed_report.hpp"
#include "trammel/run/observer.hpp"

namespace trammel::run {

class PlanGatherer final : public Observer {
 public:
  explicit PlanGatherer(const Pipeline& pipeline) : pipeline_(pipeline) {
    plan_.file = pipeline.file();
    plan_.start = plan_.end = pipeline.start();
  }

  // Adds a block, from either the first or the second pass, once each.
  void planned(const planner::PlannedBlock& block, std::uint64_t /*first*/) override { add(block); }
  void sending(const planner::PlannedBlock& block) override { add(block); }

  void probe() { ++plan_.probes; }
  // The plan up to now.
  Plan plan() const {
    Plan plan = plan_;
    plan.feeds_not_reached = feeds_.entries();
    plan.accepted = pipeline_.accepted();
    plan.lines_on_probes = pipeline_.lines_on_probes();
    return plan;
  }

 private:
  void add(const planner::PlannedBlock& planned) {
    feeds_.add(planned);
    if (planner::moves(planned.block)) {
      ++plan_.segments;
      plan_.rapids += planned.block.rapid ? 1 : 0;
    }
    plan_.commands += planned.commands;
    plan_.seconds += planned.seconds;
    PlannedMotion& motion = plan_.motion;
    motion.stops += planned.stop ? 1 : 0;
    motion.velocity_jump = std::max(motion.velocity_jump, planned.velocity_jump);
    motion.acceleration_step = std::max(motion.acceleration_step, planned.acceleration_step);
    if (planner::moves(planned.block)) {
      ++plan_.blends.corners[static_cast<std::size_t>(planned.block.corner)];
      plan_.blends.distance = std::max(plan_.blends.distance, planned.block.distance);
    }
    plan_.end = planned.block.end;
  }

  const Pipeline& pipeline_;
  Plan plan_;
  FeedReport feeds_;
};

}  // namespace trammel::run
