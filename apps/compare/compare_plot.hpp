// The picture of a comparison: each method's distance from the curve along the path, its step intervals, and the
// vibration of the simulated motors over speed.
#pragma once

#include <string>
#include <vector>

#include "compare_report.hpp"
#include "trammel/measure/ideal_curve.hpp"
#include "trammel/measure/trace.hpp"

namespace trammel::app {

// `traces`: in the order of comparison.methods. Returns an SVG below 5 MB for every curve.
std::string comparison_svg(const Comparison& comparison, const std::vector<measure::Trace>& traces,
                           const measure::IdealCurve& curve);

}  // namespace trammel::app
