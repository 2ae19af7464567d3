// The speed plan with limited jerk: speed and acceleration have no jump, and a ramp, which may span any number of
// spans, keeps the acceleration and jerk of each. An infinite jerk is no limit. Rounding may exceed a limit: 10^-9 of
// it is what the tests allow; where speeds of neighbouring spans differ by their last bits alone, 1.4 * 10^-8 of the
// jerk was seen in 3 of 40,000 random programs.
//
// At its lowest and highest speeds, and where a limit of speed holds it between, the plan has no acceleration. It is
// made anew for a whole window, and phases are given up to about the window's half; where the speed has to fall because
// the window ends, little by little, so that it does not stop when the window shows more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class SCurvePlan final : public SpeedPlan {
 public:
  // Upper bounds of work(), for every program.
  //
  // Windows per span pushed, besides one per run. Each window that does not give the rest of its first span gives a
  // whole rise of the speed that ends in it. Limits change at borders of spans alone, so this rise reached the highest
  // speed that the rest of the span allows; the next window begins with that speed and gives the rest.
  static constexpr std::uint64_t kMaxWindows = 2;
  // Ramps per span of a window. A span has at most two caps, its speed and its corner; n spans have 2 n caps. Each cap
  // takes three ramps at most to be tried, and where it splits a gap, two for the level motion at it: 10 n. That leaves
  // up to 2 n + 1 gaps without caps. Each takes two ramps, and two for each speed that the search for its peak tries
  // (100, both ends twice): 210 (2 n + 1), and n is at least 1.
  static constexpr std::uint64_t kMaxRamps = 10 + 3 * 210;

  // Looks `window` spans ahead, at least 1. All memory is taken here, but for ramps over rows of arcs. A long window
  // takes many ramps to plan: `meanwhile`, where there is one, is called before each. What it throws passes through;
  // the plan is then of no further use.
  explicit SCurvePlan(std::size_t window, std::function<void()> meanwhile = {});
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
