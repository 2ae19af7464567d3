// Functions shared by the chapters' pictures.
#include <cmath>
#include <utility>

#include "chapters.hpp"

namespace trammel::app::reproduce {

chart::Series walk_series(const std::string& label, std::vector<chart::Point> points) {
  return {label, chart::colour(1), std::move(points)};
}

chart::Series ideal_series(const std::string& label, std::vector<chart::Point> points) {
  return {label, chart::colour(2), std::move(points), chart::Mark::kLine, 1, true};
}

chart::Panel plane(const std::string& title, std::vector<chart::Series> series) {
  chart::Panel panel{title, {"x, pulses"}, {"y, pulses"}, std::move(series)};
  panel.equal_scale = true;
  return panel;
}

chart::Panel wave_panel(const std::string& title, double end) {
  chart::Panel panel{title, {"clocks"}, {""}, {}};
  panel.x.low = 0;
  panel.x.high = end;
  panel.y.numbers = false;
  return panel;
}

chart::Series wave(std::size_t axis, const std::vector<double>& rising, const std::vector<double>& falling,
                   double end) {
  const double low = axis == 0 ? 1.2 : 0.0;
  chart::Series series{axis == 0 ? "x" : "y", chart::colour(axis), {{0, low}}, chart::Mark::kStairs, 1};
  for (std::size_t i = 0; i < rising.size(); ++i) {
    series.points.push_back({rising[i], low + 0.8});
    series.points.push_back({falling[i], low});
  }
  if (series.points.back()[0] < end) series.points.push_back({end, low});
  return series;
}

std::vector<chart::Point> circle_points(double radius, int degrees) {
  std::vector<chart::Point> points;
  for (int angle = 0; angle <= degrees; angle += 2) {
    const double radians = angle * std::acos(-1.0) / 180;
    points.push_back({radius * std::cos(radians), radius * std::sin(radians)});
  }
  return points;
}

}  // namespace trammel::app::reproduce
