// The least time of a path, found by an optimiser that does not assume ramps. It is the reference for speed plans.
#pragma once

#include <cstddef>
#include <vector>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::test {

// The least time from rest to rest, s, without acceleration at both ends and without a stop between. In each span the
// speed, the acceleration and the jerk along the path are at most the span's; at its end the speed is at most its exit
// speed. At borders the acceleration need not be 0, and no further rule limits it. `nodes`: number of places at which
// the speed is free; the error of the time is about 1 / nodes^2.
double least_seconds(const std::vector<planner::Span>& spans, std::size_t nodes);

}  // namespace trammel::test
