// Zeng, Zhang & Huang: the errors of Lines 1 to 8, Figures 3 and 5, the velocity limit, and what the error means.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "chapters.hpp"
#include "picture.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/one_shot.hpp"

namespace trammel::app::reproduce {

using namespace interpolation;

Track track_of(Method method, const Line& line) {
  Track track;
  track.push_back({0, line.start});
  make_interpolator(method, line).run([&](const Step&, const auto& walk) {
    track.push_back({walk.time(), walk.position()});
  });
  return track;
}

double largest_distance(const Line& line, const Track& track) {
  double largest = 0;
  for (const TrackPoint& point : track) largest = std::max(largest, distance(line, point.position));
  return largest;
}

Panel line_panel(std::size_t index, const Track& track, const std::string& label) {
  const Line line = paper_line(index);
  const auto dx = static_cast<double>(line.end[0] - line.start[0]);
  const auto dy = static_cast<double>(line.end[1] - line.start[1]);
  const PicturePoint normal{-dy / std::hypot(dx, dy), dx / std::hypot(dx, dy)};
  const PicturePoint start{static_cast<double>(line.start[0]), static_cast<double>(line.start[1])};
  Panel panel;
  panel.title =
      fmt::format("Line {}: ({},{}) to ({},{})", index + 1, line.start[0], line.start[1], line.end[0], line.end[1]);
  for (const int side : {-1, 0, 1}) {
    const PicturePoint from{start[0] + side * normal[0], start[1] + side * normal[1]};
    Series ideal{side == 0 ? "line" : "", side == 0 ? "#393" : "#999", {}, 0.8, side != 0, false};
    ideal.points = {from, {from[0] + dx, from[1] + dy}};
    panel.series.push_back(ideal);
  }
  Series path{label, "#c03", {}, 1.2, false, false};
  for (const TrackPoint& point : track) {
    path.points.push_back({static_cast<double>(point.position[0]), static_cast<double>(point.position[1])});
  }
  panel.series.push_back(path);
  return panel;
}

namespace {

constexpr std::array<Method, 4> kMethods{Method::kOneShot, Method::kOneShotZero, Method::kDivider, Method::kSteer};
// Exact arithmetic, 2,000 clocks a line; pulses, in the order of kMethods.
constexpr std::array<std::array<double, 4>, 8> kErrors{{{0.447, 0.447, 0.447, 0.894},
                                                        {0.316, 0.632, 0.949, 0.632},
                                                        {0.316, 0.632, 0.949, 0.632},
                                                        {0.316, 0.632, 0.949, 0.632},
                                                        {0, 0, 0, 0.707},
                                                        {0.636, 0.742, 0.742, 0.742},
                                                        {0.678, 0.678, 0.735, 0.678},
                                                        {0, 0, 0, 0}}};
constexpr std::array<std::size_t, 8> kSteerSteps{60, 40, 40, 40, 60, 65, 75, 40};

void figure_three(Page& page) {
  page.heading("Figure 3: trajectories of Lines 1 to 8");
  Csv csv("line,method,clock_or_step,x,y,distance");
  std::vector<Panel> panels;
  std::vector<std::vector<std::string>> rows{{"line", "one-shot", "one-shot-zero", "divider", "steer (steps)"}};
  unsigned equal = 0;
  unsigned ends = 0;
  unsigned inside = 0;
  unsigned steer_steps = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = paper_line(i);
    std::vector<std::string> row{std::to_string(i + 1)};
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      const Track track = track_of(kMethods[m], line);
      const double largest = largest_distance(line, track);
      equal += std::fabs(largest - kErrors[i][m]) < 0.0005;
      row.push_back(fmt::format("{:.3f}", largest));
      for (const TrackPoint& point : track) {
        csv.row("{},{},{},{},{},{:.4f}", i + 1, info(kMethods[m]).name, point.time, point.position[0],
                point.position[1], distance(line, point.position));
      }
      if (kMethods[m] == Method::kSteer) {
        row.back() += fmt::format(" ({})", track.size() - 1);
        steer_steps += track.size() - 1 == kSteerSteps[i];
      }
      if (kMethods[m] != Method::kOneShot) continue;
      ends += track.back().position == line.end;
      inside += largest < 1;
      farthest = std::max(farthest, largest);
      panels.push_back(line_panel(i, track, "one-shot"));
    }
    rows.push_back(row);
  }
  page.pass("Figure 3, end points", "the error of the end point is zero", fmt::format("{} of 8 ends exact", ends),
            ends == 8);
  page.pass("Figure 3, error band", "every trajectory between the limits 1 pulse from the line",
            fmt::format("{} of 8 within, the largest distance {:.3f}", inside, farthest), inside == 8);
  page.text(
      "Largest distance from the line, perpendicular, after all steps of a clock (pulses; 10 MHz, 2,000 clocks "
      "a line):");
  page.table(rows);
  page.pass("Errors of Lines 1 to 8", "below 1 pulse",
            fmt::format("{} of 32 errors equal those of exact arithmetic to three decimals", equal), equal == 32);
  page.pass("STEER on Lines 1 to 8", "(the first paper) one unit step at a time",
            fmt::format("{} of 8 step counts |dx| + |dy|", steer_steps), steer_steps == 8);
  page.picture("one-shot-figure-3", "Lines 1 to 8, phase accumulators, with the band of 1 pulse",
               draw(panels, {4, 250, 250}), csv);
}

void figure_five(Page& page) {
  page.heading("Figure 5: interpolation operations");
  const auto walk = make_interpolator(Method::kPointByPoint, paper_line(0));
  const std::uint64_t operations = walk.total_time();
  const driver::OneShotPlan plan = driver::plan_line_clocks(paper_card(), {20, 40}, kPaperClocks);
  page.pass("Figure 5", "60 operations point by point, 1 for one-shot",
            fmt::format("{} and {} (one plan, one block write of {} words)", operations, plan.size(),
                        driver::one_shot_words(paper_card().axes)),
            operations == 60 && plan.size() == 1);
  Csv csv("line,point_by_point,one_shot");
  std::vector<PicturePoint> operations_of_line;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const std::uint64_t count = make_interpolator(Method::kPointByPoint, paper_line(i)).total_time();
    csv.row("{},{},1", i + 1, count);
  }
  for (std::uint64_t k = 1; k <= operations; ++k) operations_of_line.push_back({static_cast<double>(k), 1});
  const std::vector<Series> series{{"point by point", "#c03", operations_of_line, 2, false, true},
                                   {"one-shot", "#06c", {{1, 0}}, 3, false, true}};
  page.picture("one-shot-figure-5", "Operations for Line 1, a dot each",
               draw({{"operations", series, false}}, {1, 640, 150}), csv);
}

void limits(Page& page) {
  page.heading("The velocity limit and long lines");
  driver::LineLimits limits;
  limits.max_velocity[1] = 100'000;
  bool refused = false;
  try {
    driver::plan_line_clocks(paper_card(), {20, 40}, kPaperClocks, limits);
  } catch (const driver::ArgumentError&) {
    refused = true;
  }
  limits.policy = driver::LimitPolicy::kSlow;
  const std::uint64_t slowed = driver::plan_line_clocks(paper_card(), {20, 40}, kPaperClocks, limits).clocks();
  page.pass(
      "Velocity over v_max", "must be entered again",
      fmt::format("Line 1 needs 200,000 pulses/s in y: refused at a limit of 100,000, or slowed to {} clocks", slowed),
      refused && slowed == 2 * kPaperClocks);
  const std::int64_t far = std::int64_t{1} << 34;
  const driver::OneShotPlan plan = driver::plan_line_clocks(paper_card(), {far, far / 3}, std::uint64_t{1} << 42);
  std::int64_t sum_x = 0;
  std::int64_t sum_y = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    sum_x += plan.part(i).count[0];
    sum_y += plan.part(i).count[1];
  }
  page.pass("A line too long", "most lines need one operation",
            fmt::format("2^34 pulses are split into {} parts whose pulses add up", plan.size()),
            plan.size() > 1 && sum_x == far && sum_y == far / 3);
  const std::uint64_t slow = make_interpolator(Method::kOneShot, paper_line(0), {10'000'000, 1, 60}).total_time();
  page.corrected("v an integer", "v, an integer, in lines a second: a line lasts 1 s at most",
                 fmt::format("v as a ratio of integers: Line 1 at v = 1/60 lasts {} clocks, one minute", slow),
                 slow == 600'000'000);
}

void error_meant(Page& page) {
  page.heading("What the error means");
  std::vector<std::vector<std::string>> rows{{"line", "along the shorter axis", "perpendicular"}};
  bool smaller = true;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = paper_line(i);
    const double perpendicular = largest_distance(line, track_of(Method::kOneShot, line));
    const auto dx = static_cast<double>(line.end[0] - line.start[0]);
    const auto dy = static_cast<double>(line.end[1] - line.start[1]);
    const double along = perpendicular * std::hypot(dx, dy) / std::max(std::fabs(dx), std::fabs(dy));
    smaller = smaller && perpendicular <= along && along <= 1;
    rows.push_back({std::to_string(i + 1), fmt::format("{:.3f}", along), fmt::format("{:.3f}", perpendicular)});
  }
  page.table(rows);
  page.corrected("Error, its meaning", "the distance, bounded along one axis",
                 "the perpendicular distance is smaller; both stand in the table, the other tables are perpendicular",
                 smaller);
}

void rivals(Page& page) {
  page.heading("The rivals");
  const std::vector<Method> methods{Method::kPointByPoint, Method::kMinF4,   Method::kMinDeviation8,
                                    Method::kDda,          Method::kDdaHalf, Method::kOneShot};
  std::vector<std::vector<std::string>> rows{{"line"}};
  for (const Method method : methods) rows[0].push_back(std::string(info(method).name));
  bool ends = true;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = paper_line(i);
    std::vector<std::string> row{std::to_string(i + 1)};
    for (const Method method : methods) {
      const Track track = track_of(method, line);
      const double largest = largest_distance(line, track);
      ends = ends && track.back().position == line.end && largest < 1;
      row.push_back(fmt::format("{:.3f}", largest));
    }
    rows.push_back(row);
  }
  page.table(rows);
  page.pass("Rivals named", "point by point, digital integration, minimum deviation",
            "each runs here on Lines 1 to 8, ends exact; `trammel compare` has all measures", ends);
  auto circle = make_interpolator(Method::kRotation, make_circle(25));
  circle.run([](const Step&, const auto&) {});
  page.pass("Coarse stage", "arcs and splines become short lines first",
            "so do splines here, on the host; the card makes arcs itself, a circle of radius 25 back at its start",
            circle.position() == Position{25, 0, 0, 0});
}

}  // namespace

void one_shot_lines(Page& page, const Progress& progress) {
  figure_three(page);
  progress(0.4);
  error_meant(page);
  figure_five(page);
  limits(page);
  rivals(page);
}

}  // namespace trammel::app::reproduce
