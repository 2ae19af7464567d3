// Zeng, Zhang & Huang: the errors of Lines 1 to 8, Figures 3 and 5, the velocity limit, and the meaning of the error.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "chapters.hpp"
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

chart::Panel line_panel(std::size_t index, const Track& track, const std::string& label) {
  const Line line = kPaperLines[index].line();
  const auto dx = static_cast<double>(line.end[0] - line.start[0]);
  const auto dy = static_cast<double>(line.end[1] - line.start[1]);
  const chart::Point normal{-dy / std::hypot(dx, dy), dx / std::hypot(dx, dy)};
  const chart::Point start{static_cast<double>(line.start[0]), static_cast<double>(line.start[1])};
  chart::Panel panel = plane(
      fmt::format("Line {}: ({},{}) to ({},{})", index + 1, line.start[0], line.start[1], line.end[0], line.end[1]),
      {});
  for (const int side : {-1, 0, 1}) {
    const chart::Point from{start[0] + side * normal[0], start[1] + side * normal[1]};
    const std::vector<chart::Point> ends{from, {from[0] + dx, from[1] + dy}};
    panel.series.push_back(ideal_series(side == 0 ? "line" : side < 0 ? "limits 1 and 2" : "", ends));
    if (side != 0) panel.series.back().colour = "#999999";
    if (side == 0) panel.series.back().dashed = false;
  }
  chart::Series path = walk_series(label);
  for (const TrackPoint& point : track) {
    path.points.push_back({static_cast<double>(point.position[0]), static_cast<double>(point.position[1])});
  }
  panel.series.push_back(path);
  return panel;
}

namespace {

void figure_three(Page& page) {
  page.heading("Figure 3: trajectories of Lines 1 to 8");
  Csv csv("line,method,clock_or_step,x,y,distance");
  std::vector<chart::Panel> panels;
  std::vector<std::vector<std::string>> rows{{"line", "one-shot", "one-shot-zero", "divider", "steer (steps)"}};
  unsigned equal = 0;
  unsigned ends = 0;
  unsigned inside = 0;
  unsigned steer_steps = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = kPaperLines[i].line();
    std::vector<std::string> row{std::to_string(i + 1)};
    for (std::size_t m = 0; m < kPaperMethods.size(); ++m) {
      const Track track = track_of(kPaperMethods[m], line);
      const double largest = largest_distance(line, track);
      equal += std::fabs(largest - kPaperLines[i].errors[m]) < 0.0005;
      row.push_back(fmt::format("{:.3f}", largest));
      for (const TrackPoint& point : track) {
        csv.row("{},{},{},{},{},{:.4f}", i + 1, info(kPaperMethods[m]).name, point.time, point.position[0],
                point.position[1], distance(line, point.position));
      }
      if (kPaperMethods[m] == Method::kSteer) {
        row.back() += fmt::format(" ({})", track.size() - 1);
        steer_steps += track.size() - 1 == kPaperLines[i].steer_steps;
      }
      if (kPaperMethods[m] != Method::kOneShot) continue;
      ends += track.back().position == line.end;
      inside += largest < 1;
      farthest = std::max(farthest, largest);
      panels.push_back(line_panel(i, track, "one-shot"));
    }
    rows.push_back(row);
  }
  page.pass("Figure 3, end points", "the error of the end point is zero",
            fmt::format("{} of 8 lines end exactly", ends), ends == 8);
  page.pass(
      "Figure 3, error band", "every trajectory stays between two limits, 1 pulse on either side of the line",
      fmt::format("{} of 8 trajectories stay between the limits; the largest distance is {:.3f}", inside, farthest),
      inside == 8);
  page.text(
      "Largest perpendicular distance from the line in pulses, measured after all steps of a clock (10 MHz, 2,000 "
      "clocks per line):");
  page.table(rows);
  page.pass("Errors of Lines 1 to 8", "below 1 pulse",
            fmt::format("{} of 32 errors equal those of exact arithmetic to three decimals", equal), equal == 32);
  page.pass("STEER on Lines 1 to 8", "(the first paper) one unit step at a time",
            fmt::format("{} of 8 step counts equal |dx| + |dy|", steer_steps), steer_steps == 8);
  page.picture("one-shot-figure-3", "Lines 1 to 8 by phase accumulators, with the limits at 1 pulse from the line",
               chart::grid_of(panels, 2, kLinePanelWidth, kLinePanelHeight), csv);
}

void figure_five(Page& page) {
  page.heading("Figure 5: interpolation operations");
  const auto walk = make_interpolator(Method::kPointByPoint, kPaperLines[0].line());
  const std::uint64_t operations = walk.total_time();
  const driver::OneShotPlan plan = driver::plan_line_clocks(paper_card(), {20, 40}, kPaperClocks);
  page.pass("Figure 5", "60 operations point by point, 1 for one-shot",
            fmt::format("{} operations point by point, {} for one-shot (one plan, one block write of {} words)",
                        operations, plan.size(), driver::one_shot_words(paper_card().axes)),
            operations == 60 && plan.size() == 1);
  Csv csv("line,point_by_point,one_shot");
  std::vector<chart::Point> operations_of_line;  // number of operations over the number of earlier pulses
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const std::uint64_t count = make_interpolator(Method::kPointByPoint, kPaperLines[i].line()).total_time();
    csv.row("{},{},1", i + 1, count);
  }
  for (std::uint64_t k = 1; k <= operations; ++k)
    operations_of_line.push_back({static_cast<double>(k - 1), static_cast<double>(k)});
  const std::vector<chart::Series> series{
      {"point by point", chart::colour(1), operations_of_line, chart::Mark::kDots, 2},
      {"one-shot", chart::colour(0), {{0, 1}}, chart::Mark::kDots, 4}};
  page.picture(
      "one-shot-figure-5", "Operations for Line 1, one dot each",
      chart::grid_of({{"Line 1, (0,0) to (20,40)", {"pulses sent before the operation"}, {"operation"}, series}}, 1,
                     560, 320),
      csv);
}

// A line with more pulses than a part can hold: the end points of the parts, and the ideal times there.
void split_line(Page& page) {
  const std::int64_t far = std::int64_t{1} << 34;
  const Line line = make_line({0, 0}, {far, far / 3});
  const std::uint64_t duration = std::uint64_t{1} << 42;
  const driver::OneShotPlan plan = driver::plan_line_clocks(paper_card(), {far, far / 3}, duration);
  Position at{};
  std::uint64_t clocks = 0;
  double stray = 0;
  double late = 0;  // clocks
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const driver::OneShotPart part = plan.part(i);
    at[0] += part.count[0];
    at[1] += part.count[1];
    clocks += part.length;
    stray = std::max(stray, distance(line, at));
    const double due = static_cast<double>(duration) * static_cast<double>(at[0]) / static_cast<double>(far);
    late = std::max(late, std::fabs(static_cast<double>(clocks) - due));
  }
  // A pulse takes 256 clocks here, so a part that ends within half a pulse of its ideal point is early or late by up to
  // half of that.
  page.pass(
      "Lines that are too long", "a line that is too long is divided into small lines",
      fmt::format("2^34 pulses are sent as {} lines. Their ends lie within {:.2f} pulses of the ideal line and "
                  "within {:.0f} clocks of constant velocity. The last line ends at the end point. All lines together "
                  "last 2^42 clocks, as requested, plus {}",
                  plan.size(), stray, late, clocks - duration),
      plan.size() > 1 && at == line.end && clocks >= duration && clocks - duration < plan.size() &&
          stray <= std::sqrt(0.5) && late <= 256);
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
  page.pass("Velocity over v_max", "a velocity above v_max must be entered again",
            fmt::format("Line 1 needs 200,000 pulses/s in y. With a limit of 100,000 the driver refuses it or, if told "
                        "so, slows it to {} clocks",
                        slowed),
            refused && slowed == 2 * kPaperClocks);
  split_line(page);
  const std::uint64_t slow =
      make_interpolator(Method::kOneShot, kPaperLines[0].line(), {10'000'000, 1, 60}).total_time();
  page.corrected(
      "Integer v", "v is an integer in lines per second, so a line lasts at most 1 s",
      fmt::format("v can be a ratio of integers: Line 1 at v = 1/60 lasts {} clocks, which is one minute", slow),
      slow == 600'000'000);
}

void error_meant(Page& page) {
  page.heading("Meaning of the error");
  std::vector<std::vector<std::string>> rows{{"line", "along the shorter axis", "perpendicular"}};
  bool smaller = true;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = kPaperLines[i].line();
    const double perpendicular = largest_distance(line, track_of(Method::kOneShot, line));
    const auto dx = static_cast<double>(line.end[0] - line.start[0]);
    const auto dy = static_cast<double>(line.end[1] - line.start[1]);
    const double along = perpendicular * std::hypot(dx, dy) / std::max(std::fabs(dx), std::fabs(dy));
    smaller = smaller && perpendicular <= along && along <= 1;
    rows.push_back({std::to_string(i + 1), fmt::format("{:.3f}", along), fmt::format("{:.3f}", perpendicular)});
  }
  page.text(
      "Largest distance of the one-shot method from the line, in pulses. This table gives both distances; all other "
      "tables give the perpendicular distance.");
  page.table(rows);
  page.pass("Meaning of the error",
            "the distance along one axis is below 1, so the distance from the line is below 1 too",
            "true, but a stronger bound holds: the perpendicular distance is smaller, at most sqrt(1/2)", smaller);
}

// The number of steps of Line 1 in which both axes pulse, and of all its steps.
std::pair<unsigned, unsigned> steps_of_both(Method method) {
  std::pair<unsigned, unsigned> steps;
  make_interpolator(method, kPaperLines[0].line()).run([&](const Step& step, const auto&) {
    steps.first += step.direction[0] != 0 && step.direction[1] != 0;
    ++steps.second;
  });
  return steps;
}

void one_pulse_each_time(Page& page) {
  const auto point = steps_of_both(Method::kPointByPoint);
  const auto dda = steps_of_both(Method::kDda);
  const auto deviation = steps_of_both(Method::kMinDeviation8);
  page.corrected("One pulse each time", "all three algorithms send one pulse each time",
                 fmt::format("only point by point does. On Line 1 digital integration pulses both axes at once in {} "
                             "of {} steps, minimum deviation in {} of {}, point by point in {} of {}",
                             dda.first, dda.second, deviation.first, deviation.second, point.first, point.second),
                 point.first == 0 && point.second == 60 && dda.first == 20 && dda.second == 40 &&
                     deviation.first == 20 && deviation.second == 40);
}

// The bounds of the three rival methods.
void rival_bounds(Page& page) {
  std::mt19937_64 random(4);
  struct Rival {
    Method method;
    double largest = 0;
  };
  std::array<Rival, 3> rivals{{{Method::kPointByPoint}, {Method::kDda}, {Method::kMinDeviation8}}};
  for (int i = 0; i < 2000; ++i) {
    const Line line = make_line({0, 0}, {uniform(random, -200, 200), uniform(random, -200, 200)});
    if (longest_axis(line) == 0) continue;
    // Distance along the axis in which the line is steepest, as bounded in the paper.
    const double along = std::hypot(static_cast<double>(line.end[0]), static_cast<double>(line.end[1])) /
                         static_cast<double>(longest_axis(line));
    for (Rival& rival : rivals) {
      make_interpolator(rival.method, line).run([&](const Step&, const auto& walk) {
        rival.largest = std::max(rival.largest, along * distance(line, walk.position()));
      });
    }
  }
  page.pass("Bound of minimum deviation", "one half of a pulse",
            fmt::format("at most {:.4f} along the shorter axis on 2,000 random lines", rivals[2].largest),
            rivals[2].largest <= 0.5 + 1e-12 && rivals[2].largest > 0.49);
  page.pass("Bounds of the other two methods", "one pulse",
            fmt::format("at most {:.4f} for point by point and {:.4f} for digital integration, on the same lines",
                        rivals[0].largest, rivals[1].largest),
            rivals[0].largest <= 1 + 1e-12 && rivals[1].largest <= 1 + 1e-12 && rivals[0].largest > 0.95);
  one_pulse_each_time(page);
}

void rivals(Page& page) {
  page.heading("The rival methods");
  const std::vector<Method> methods{Method::kPointByPoint, Method::kMinF4,   Method::kMinDeviation8,
                                    Method::kDda,          Method::kDdaHalf, Method::kOneShot};
  std::vector<std::vector<std::string>> rows{{"line"}};
  for (const Method method : methods) rows[0].push_back(std::string(info(method).name));
  bool ends = true;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = kPaperLines[i].line();
    std::vector<std::string> row{std::to_string(i + 1)};
    for (const Method method : methods) {
      const Track track = track_of(method, line);
      const double largest = largest_distance(line, track);
      ends = ends && track.back().position == line.end && largest < 1;
      row.push_back(fmt::format("{:.3f}", largest));
    }
    rows.push_back(row);
  }
  page.text("Largest perpendicular distance from the line, in pulses:");
  page.table(rows);
  page.pass("Rival methods", "point by point, digital integration, minimum deviation",
            "every method tried ends Lines 1 to 8 exactly; `trammel compare` gives all measures", ends);
  rival_bounds(page);
}

constexpr std::int64_t kVelocity = 5000;     // v of the paper's lines, lines per second
constexpr std::int64_t kClock = 10'000'000;  // f, Hz

// Whether a frequency of the driver, in 2^-40 pulses per clock, is |velocity| pulses per second, rounded.
bool rounds_to(std::uint64_t frequency, std::int64_t velocity) {
  // Both terms are below 2^58 for at most 200,000 pulses/s.
  const std::int64_t off = static_cast<std::int64_t>(frequency) * kClock - (std::abs(velocity) << 40);
  return 2 * std::abs(off) <= kClock;
}

// Formulas (5) to (8), their signs, and the driver's registers. (1) to (4) are identities and need no run.
void formulas(Page& page) {
  page.heading("Principle: Figure 1, formulas (1) to (8)");
  std::vector<std::vector<std::string>> rows{
      {"line", "k (1)", "v_x (6)", "v_y (5)", "p_x (8)", "p_y (7)", "FREQUENCY x", "FREQUENCY y"}};
  unsigned on_line = 0;
  unsigned negative = 0;
  double stray = 0;  // error of the end points given by the frequencies, pulses
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = kPaperLines[i].line();
    const std::array<std::int64_t, 2> p{line.end[0] - line.start[0], line.end[1] - line.start[1]};
    const driver::OneShotPart part = driver::plan_line_clocks(paper_card(), {p[0], p[1]}, kClock / kVelocity).part(0);
    bool equal = true;
    std::array<double, 2> reached{};
    for (std::size_t a = 0; a < 2; ++a) {
      const bool backwards = (part.negative >> a & 1U) != 0;
      equal = equal && part.count[a] == std::abs(p[a]) && backwards == (p[a] < 0);
      equal = equal && rounds_to(part.frequency[a], kVelocity * p[a]);
      reached[a] = std::ldexp(static_cast<double>(part.frequency[a] * part.length), -40) * (backwards ? -1 : 1);
    }
    const auto px = static_cast<double>(p[0]);
    const auto py = static_cast<double>(p[1]);
    stray = std::max(stray, std::fabs(px * reached[1] - py * reached[0]) / std::hypot(px, py));
    on_line += equal;
    negative += p[0] < 0;
    rows.push_back({std::to_string(i + 1), p[0] == 0 ? "-" : fmt::format("{}/{}", p[1], p[0]),
                    std::to_string(kVelocity * p[0]), std::to_string(kVelocity * p[1]), std::to_string(p[0]),
                    std::to_string(p[1]), std::to_string(part.frequency[0]), std::to_string(part.frequency[1])});
  }
  page.text(
      "The FREQUENCY columns show the register values that the driver computes, in units of 2^-40 pulses per clock.");
  page.table(rows);
  page.pass(
      "Formulas (5) to (8), Figure 1", "the sum of both velocities is parallel to the line, so every point is on it",
      fmt::format(
          "for {} of 8 lines the driver's frequencies are v_x and v_y, rounded to 2^-40 pulses per clock, and its "
          "counts and directions are p_x and p_y. The rounding moves the end point at most {:.1e} pulses off the line",
          on_line, stray),
      on_line == 8 && stray < 1e-8);
  page.corrected("p_x and p_y", "both are numbers of pulses (7), (8), and 0 <= x_t <= p_x",
                 fmt::format("p_x is negative for {} of the 8 lines (4, 5 and 7), and x_t starts at x_s. The count is "
                             "therefore |p_x|, the sign gives the direction, and |x_t - x_s| <= |p_x|",
                             negative),
                 negative == 3);
}

void unit_of_v(Page& page) {
  unsigned equal = 0;
  for (const PaperLine& line : kPaperLines) {
    equal += make_interpolator(Method::kOneShot, line.line()).total_time() == kPaperClocks;
  }
  // The y axis of Line 1: 40 pulses.
  const Spread interval = spread_of(pulse_times(track_of(Method::kOneShot, kPaperLines[0].line()), 1, 1));
  const double rate = static_cast<double>(kClock) / interval.largest;
  page.corrected("Unit of v", "v is in pulses per second",
                 fmt::format("v is in lines per second. At v = 5000, {} of 8 lines, although 32 to 53 pulses long, "
                             "last {} clocks (1/5000 s), and y of Line 1 makes {:g} pulses per second",
                             equal, kPaperClocks, rate),
                 equal == 8 && interval.least == interval.largest && rate == 200'000);
}

}  // namespace

void one_shot_lines(Page& page, const Progress& progress) {
  figure_three(page);
  progress(0.4);
  error_meant(page);
  figure_five(page);
  limits(page);
  rivals(page);
  formulas(page);
  unit_of_v(page);
}

}  // namespace trammel::app::reproduce
