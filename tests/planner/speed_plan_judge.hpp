// Judges of a speed plan, from its phases and the spans alone: the motion is integrated in closed form (cubics) and
// held against every limit at every border and at the speed's extremes; and the time of the best plan whose
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

// The first thing that is wrong, or nothing. Jumps of acceleration are allowed where `jumps` says so.
std::string fault_of(const std::vector<Phase>& phases, const std::vector<Span>& spans, bool jumps = false);

// The plan without limits of jerk that takes the least time: a phase a span or several.
struct Trapezoid {
  std::vector<Phase> phases;
  double duration = 0;
  double bends = 0;  // the largest acceleration by the least jerk of each stretch of rising or falling speed, summed up
};
Trapezoid trapezoid_of(const std::vector<Span>& spans);

}  // namespace trammel::test
