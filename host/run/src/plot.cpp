#include "trammel/run/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "trammel/chart/chart.hpp"

namespace trammel::run {
namespace {

constexpr double kWidth = 1040;
constexpr double kTop = 40;
constexpr double kPathHeight = 500;
constexpr double kSideHeight = 300;
constexpr double kSpeedHeight = 240;
constexpr const char* kAxisNames = "XYZ";

struct View {
  std::size_t across;
  std::size_t up;
};

std::array<double, 3> spans_of(const std::vector<PathPoint>& points) {
  std::array<double, 3> spans{};
  if (points.empty()) return spans;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(), [i](const PathPoint& a, const PathPoint& b) { return a.at[i] < b.at[i]; });
    spans[i] = high->at[i] - low->at[i];
  }
  return spans;
}

// XY, XZ and YZ if three axes move, XY first; else the plane in which the path lies, XY or XZ for a single axis.
std::vector<View> views_of(const std::vector<PathPoint>& points) {
  const std::array<double, 3> spans = spans_of(points);
  const auto moves = [&](std::size_t i) { return spans[i] > 0; };
  if (moves(0) && moves(1) && moves(2)) return {{0, 1}, {0, 2}, {1, 2}};
  if (!moves(2)) return {{0, 1}};
  return {moves(1) ? View{1, 2} : View{0, 2}};
}

chart::Point seen(const Point& point, View view) { return {point[view.across], point[view.up]}; }

// The rapid or the feed motions as one line, which is interrupted at motions of the other kind.
std::vector<chart::Point> ways(const std::vector<PathPoint>& points, View view, bool rapid) {
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  std::vector<chart::Point> line;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].rapid != rapid) continue;
    const bool goes_on = i > 1 && points[i - 1].rapid == rapid;
    if (!goes_on && !line.empty()) line.push_back({kGap, kGap});
    if (!goes_on) line.push_back(seen(points[i - 1].at, view));
    line.push_back(seen(points[i].at, view));
  }
  return line;
}

chart::Panel plane(const Plot& plot, View view, const std::string& title) {
  chart::Panel panel{title,
                     {fmt::format("{}, {}", kAxisNames[view.across], plot.unit)},
                     {fmt::format("{}, {}", kAxisNames[view.up], plot.unit)},
                     {}};
  panel.equal_scale = true;
  return panel;
}

chart::Panel path_panel(const Plot& plot, View view, const std::string& title) {
  chart::Panel panel = plane(plot, view, title);
  std::vector<chart::Point> made;
  for (const PathPoint& point : plot.executed) made.push_back(seen(point.at, view));
  // Rapids are drawn last, so that their dashes remain visible over pulses.
  panel.series = {
      {"commanded", chart::colour(1), ways(plot.commanded, view, false), chart::Mark::kLine, 2.2},
      {plot.executed_thinned ? "pulses, thinned" : "pulses", chart::colour(0), made, chart::Mark::kLine, 0.8},
      {"rapids", "#444444", ways(plot.commanded, view, true), chart::Mark::kLine, 1.2, true}};
  // A series without points gets no entry in the legend.
  for (chart::Series& series : panel.series) {
    if (series.points.empty()) series.label.clear();
  }
  if (made.empty()) return panel;
  panel.series.push_back({"start", chart::colour(2), {made.front()}, chart::Mark::kCircles, 6});
  panel.series.push_back({"end", chart::colour(2), {made.back()}, chart::Mark::kDots, 4});
  return panel;
}

chart::Panel detail_panel(const Plot& plot, View view) {
  chart::Panel panel = plane(plot, view, "Magnified: every pulse of one stretch");
  std::vector<chart::Point> commanded;
  std::vector<chart::Point> made;
  for (const Point& point : plot.detail_commanded) commanded.push_back(seen(point, view));
  for (const Point& point : plot.detail_executed) made.push_back(seen(point, view));
  panel.series = {{"commanded", chart::colour(1), commanded, chart::Mark::kLine, 2.2},
                  {"", chart::colour(0), made, chart::Mark::kLine, 0.8},
                  {"pulses", chart::colour(0), made, chart::Mark::kDots, 2.2}};
  return panel;
}

// The plane in which the stretch has the largest area.
View detail_view(const Plot& plot) {
  std::vector<PathPoint> points;
  for (const Point& point : plot.detail_executed) points.push_back({point, false});
  const std::array<double, 3> spans = spans_of(points);
  View best{0, 1};
  for (const View view : {View{0, 2}, View{1, 2}}) {
    if (spans[view.across] * spans[view.up] > spans[best.across] * spans[best.up]) best = view;
  }
  if (spans[0] == 0 && spans[1] == 0 && spans[2] > 0) return {0, 2};
  return best;
}

chart::Panel speed_panel(const Plot& plot) {
  chart::Panel panel{"Speed along the path, from the intervals of the steps",
                     {"time, s"},
                     {fmt::format("{}/s", plot.unit)},
                     {{"", chart::colour(2), {}, chart::Mark::kLine, 1.3}}};
  for (const PathSpeed::Sample& sample : plot.speed) panel.series[0].points.push_back({sample.seconds, sample.speed});
  panel.x.low = 0;
  panel.y.low = 0;
  // Leaves room above the curve, because a line at the frame would not be visible. Times and speeds are never negative.
  constexpr double kRoom = 1.06;
  double most = 0;
  for (const PathSpeed::Sample& sample : plot.speed) most = std::max(most, sample.speed);
  panel.y.high = most > 0 ? kRoom * most : 1;
  if (plot.speed.empty()) panel.x.high = 1;
  return panel;
}

}  // namespace

std::string svg(const Plot& plot) {
  std::vector<PathPoint> all = plot.commanded;
  all.insert(all.end(), plot.executed.begin(), plot.executed.end());
  const std::vector<View> views = views_of(all);
  const double sides = views.size() > 1 ? kSideHeight : 0;
  chart::Figure figure(kWidth, kTop + kPathHeight + sides + kSpeedHeight, plot.title);
  const double detail_left = 0.58 * kWidth;
  figure.add(path_panel(plot, views.front(), views.size() > 1 ? "Path, from above" : "Path"),
             {0, kTop, detail_left, kPathHeight});
  figure.add(detail_panel(plot, detail_view(plot)), {detail_left, kTop, kWidth - detail_left, kPathHeight});
  double left = 0;
  for (std::size_t i = 1; i < views.size(); ++i) {
    chart::Panel side = path_panel(plot, views[i], i == 1 ? "Path, from the front" : "Path, from the right");
    side.legend = false;
    figure.add(side, {left, kTop + kPathHeight, kWidth / 2, kSideHeight});
    left += kWidth / 2;
  }
  figure.add(speed_panel(plot), {0, kTop + kPathHeight + sides, kWidth, kSpeedHeight});
  return figure.svg();
}

}  // namespace trammel::run
