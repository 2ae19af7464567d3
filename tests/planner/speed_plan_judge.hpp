// Checks of a speed plan from its phases and the spans alone. The motion is integrated in closed form (cubics) and
// compared with every limit at every border and at the extremes of the speed. Also, the time of the best plan whose
// acceleration may jump.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::test {

using planner::Phase;
using planner::Span;
using planner::SpeedPlan;

std::vector<Phase> plan_all(SpeedPlan& plan, const std::vector<Span>& spans);
double duration_of(const std::vector<Phase>& phases);

// The first fault, or an empty text. `jumps`: the acceleration may jump.
std::string fault_of(const std::vector<Phase>& phases, const std::vector<Span>& spans, bool jumps = false);

// The plan without limits of jerk that takes the least time, with one or more phases per span.
struct Trapezoid {
  std::vector<Phase> phases;
  double duration = 0;
  double bends = 0;  // s; sum, over stretches of rising or falling speed, of largest acceleration / least jerk
};
Trapezoid trapezoid_of(const std::vector<Span>& spans);

}  // namespace trammel::test
