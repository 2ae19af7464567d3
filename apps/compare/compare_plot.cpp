#include "compare_plot.hpp"

#include <algorithm>
#include <string>

#include "trammel/chart/chart.hpp"

namespace trammel::app {
namespace {

namespace measure = measure;

constexpr double kWidth = 1100;
constexpr double kTop = 40;
constexpr double kRowHeight = 190;
constexpr double kMotorHeight = 460;
// Largest number of points of a polyline: two panels of ten methods stay below 1 MB.
constexpr std::size_t kMaxPoints = 2000;

// Keeps the largest point of each group of neighbours, in at most kMaxPoints groups, so that peaks remain.
std::vector<chart::Point> thinned(const std::vector<chart::Point>& points) {
  const std::size_t group = points.size() / kMaxPoints + 1;
  std::vector<chart::Point> result;
  for (std::size_t i = 0; i < points.size(); i += group) {
    const auto end = points.begin() + static_cast<std::ptrdiff_t>(std::min(i + group, points.size()));
    result.push_back(*std::max_element(points.begin() + static_cast<std::ptrdiff_t>(i), end,
                                       [](const chart::Point& a, const chart::Point& b) { return a[1] < b[1]; }));
  }
  return result;
}

std::vector<chart::Point> distances(const measure::Trace& trace, const measure::IdealCurve& curve) {
  std::vector<chart::Point> points = {{0, 0}};
  measure::TracePosition position = trace.start();
  for (const measure::Event& event : trace.events()) {
    for (std::size_t a = 0; a < trace.axes(); ++a) position[a] += event.direction[a];
    const double time = 100 * static_cast<double>(event.time) / static_cast<double>(trace.total_time());
    points.push_back({time, curve.distance(position)});
  }
  return thinned(points);
}

// The axis with the most pulses (the first if several have as many). Its motor is excited most often.
std::size_t busiest_axis(const measure::Trace& trace) {
  std::size_t busiest = 0;
  for (std::size_t a = 1; a < trace.axes(); ++a) {
    if (trace.times(a).size() > trace.times(busiest).size()) busiest = a;
  }
  return busiest;
}

std::vector<chart::Point> intervals(const measure::Trace& trace, const measure::IdealCurve& curve) {
  std::vector<chart::Point> points;
  const std::vector<double> deviations = measure::interval_deviations(trace, curve, busiest_axis(trace));
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    points.push_back({100 * static_cast<double>(i) / static_cast<double>(deviations.size()), 100 * deviations[i]});
  }
  return thinned(points);
}

// One row per method: distance over the time of the curve, and the intervals of its busiest axis; all rows have the
// same scale.
void add_rows(chart::Figure& figure, const Comparison& comparison, const std::vector<measure::Trace>& traces,
              const measure::IdealCurve& curve) {
  std::vector<chart::Panel> left;
  std::vector<chart::Panel> right;
  double farthest = 0.5;
  double low = -1;
  double high = 1;
  for (std::size_t m = 0; m < traces.size(); ++m) {
    const std::string name(interpolation::info(comparison.methods[m].method).name);
    const chart::Series distance{"", chart::colour(m), distances(traces[m], curve), chart::Mark::kStairs, 1.2};
    const chart::Series interval{"", chart::colour(m), intervals(traces[m], curve), chart::Mark::kLine, 1.2};
    for (const chart::Point& point : distance.points) farthest = std::max(farthest, point[1]);
    for (const chart::Point& point : interval.points) {
      low = std::min(low, point[1]);
      high = std::max(high, point[1]);
    }
    left.push_back({name + ": distance from the curve", {"% of the time"}, {"pulses"}, {distance}});
    right.push_back(
        {name + ": intervals of its busiest axis", {"% of its pulses"}, {"% off the even one"}, {interval}});
  }
  for (std::size_t m = 0; m < traces.size(); ++m) {
    left[m].y.low = 0;
    left[m].y.high = farthest;
    right[m].y.low = low;
    right[m].y.high = high;
    const double top = kTop + kRowHeight * static_cast<double>(m);
    figure.add(left[m], {0, top, kWidth / 2, kRowHeight});
    figure.add(right[m], {kWidth / 2, top, kWidth / 2, kRowHeight});
  }
}

// Ripple over speed; at speeds with lost steps, a cross at the bottom instead.
chart::Panel motor_panel(const Comparison& comparison) {
  chart::Panel panel{"Simulated motors: rms speed ripple; a cross at the foot: steps lost",
                     {"pulses/s along the path", true},
                     {"% of the speed", true},
                     {}};
  double least = 100;
  for (const auto& sweep : comparison.sweeps) {
    for (const measure::Vibration& vibration : sweep) {
      if (!vibration.lost_steps && vibration.rms_ripple > 1e-4) least = std::min(least, 100 * vibration.rms_ripple);
    }
  }
  // The crosses are below the smallest ripple, in one row per method.
  double foot = least / 1.15;
  for (std::size_t m = 0; m < comparison.sweeps.size(); ++m) {
    chart::Series ripple{std::string(interpolation::info(comparison.methods[m].method).name), chart::colour(m), {}};
    chart::Series lost{"", chart::colour(m), {}, chart::Mark::kCrosses, 3};
    const auto finish_line = [&] {
      if (!ripple.points.empty()) panel.series.push_back(ripple);
      if (!ripple.points.empty()) ripple.label.clear();
      ripple.points.clear();
    };
    for (std::size_t i = 0; i < comparison.speeds.size(); ++i) {
      const measure::Vibration& vibration = comparison.sweeps[m][i];
      if (vibration.lost_steps) {
        finish_line();
        lost.points.push_back({comparison.speeds[i], foot});
      } else {
        ripple.points.push_back({comparison.speeds[i], 100 * vibration.rms_ripple});
      }
    }
    finish_line();
    if (!lost.points.empty()) {
      panel.series.push_back(lost);
      foot /= 1.12;
    }
  }
  return panel;
}

}  // namespace

std::string comparison_svg(const Comparison& comparison, const std::vector<measure::Trace>& traces,
                           const measure::IdealCurve& curve) {
  const double motor_top = kTop + kRowHeight * static_cast<double>(traces.size());
  chart::Figure figure(kWidth, motor_top + kMotorHeight, comparison.title);
  add_rows(figure, comparison, traces, curve);
  figure.add(motor_panel(comparison), {0, motor_top, kWidth, kMotorHeight});
  return figure.svg();
}

}  // namespace trammel::app
