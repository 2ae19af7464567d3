// The picture of a comparison: how far each method is from the curve along the way, its step intervals, and the
// vibration of the simulated motors over speed.
#pragma once

#include <string>
#include <vector>

#include "compare_report.hpp"
#include "trammel/measure/ideal_curve.hpp"
#include "trammel/measure/trace.hpp"

namespace trammel::app {

// `traces` in the order of comparison.methods. An SVG below 5 MB, whatever the curve.
std::string comparison_svg(const Comparison& comparison, const std::vector<measure::Trace>& traces,
                           const measure::IdealCurve& curve);

}  // namespace trammel::app
