// The least time of a path, by an optimiser that knows nothing of ramps: a judge of speed plans.
#pragma once

#include <cstddef>
#include <vector>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::test {

// From rest to rest, without acceleration at both ends; no stop between. In each span the speed, the acceleration and
// the jerk along the path are at most the span's, at its end the speed is at most its exit speed. At borders the
// acceleration is what it is: not 0, and less than either span's limit by no rule. `nodes`: places at which the speed
// is free; the time is off by some 1 / nodes^2.
double least_seconds(const std::vector<planner::Span>& spans, std::size_t nodes);

}  // namespace trammel::test
