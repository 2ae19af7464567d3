// The speed plan with limited jerk: speed and acceleration have no jump, and a ramp, which may span any number of
// spans, keeps the acceleration and jerk of each. An infinite jerk is no limit.
//
// At its lowest and highest speeds, and where a limit of speed holds it between, the plan has no acceleration. It is
// made anew for a whole window, and phases are given up to about the window's half; where the speed has to fall because
// the window ends, little by little, so that it does not stop when the window shows more.
#pragma once

#include <cstddef>
#include <memory>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class SCurvePlan final : public SpeedPlan {
 public:
  // Looks `window` spans ahead, at least 1. All memory is taken here, but for ramps over rows of arcs.
  explicit SCurvePlan(std::size_t window);
  ~SCurvePlan() override;

  bool full() const override;
  void push(const Span& span) override;
  void finish() override;
  bool next(Phase& phase) override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trammel::planner
