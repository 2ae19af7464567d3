// The speed plan with limited jerk: speed and acceleration have no jump, a ramp may span any number of spans and keeps
// the least acceleration and jerk of those that it touches. An infinite jerk is no limit.
//
// At its lowest and highest speeds, and where a limit of speed holds it between, the plan has no acceleration. It is
// made anew for a whole window, and phases are given up to about the window's half.
#pragma once

#include <cstddef>
#include <memory>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class SCurvePlan final : public SpeedPlan {
 public:
  // Looks `window` spans ahead, at least 1. All memory is taken here.
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
