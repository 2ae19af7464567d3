// The speed plan with limited jerk. Speed and acceleration have no jump. A ramp may cover any number of spans and keeps
// the acceleration and jerk of each; an infinite jerk is no limit. Rounding may exceed a limit. The tests allow 10^-9
// of it. Where the speeds of neighbouring spans differ in their last bits only, 1.4 * 10^-8 of the jerk was seen in 3
// of 40,000 random programs.
//
// The acceleration is 0 at each lowest and highest speed, and where a speed limit holds the speed between these. Each
// plan covers a whole window; next() gives its phases up to about half of the window. While the speed falls only
// because the window ends, next() gives less at a time, so that the motion need not stop when the window shows more.
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
  // Windows per span pushed, plus one per run. A window that does not give the rest of its first span gives a whole
  // rise of the speed that ends in that span. Limits change at borders of spans only, so this rise reaches the highest
  // speed that the rest of the span allows. The next window begins with that speed and gives the rest.
  static constexpr std::uint64_t kMaxWindows = 2;
  // Ramps per span of a window. A span has at most two caps, its speed and its corner, so n spans have 2 n caps. A cap
  // takes at most three ramps to try, and two more for the level motion at the cap if it splits a gap: 10 n. This
  // leaves up to 2 n + 1 gaps without caps. Each of these takes two ramps, and two per speed that the search for its
  // peak tries (100, and both ends twice): 210 (2 n + 1), and n is at least 1.
  static constexpr std::uint64_t kMaxRamps = 10 + 3 * 210;

  // Looks `window` spans ahead, at least 1. Allocates all memory here, except for ramps over rows of arcs. A long
  // window takes many ramps to plan: `meanwhile`, if set, is called before each. Its exceptions pass through; the plan
  // is of no further use after one.
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
