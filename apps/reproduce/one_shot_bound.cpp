// Zeng, Zhang & Huang, (9) to (24): the error's bound over random lines, and what becomes of it with integer dividers.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "chapters.hpp"
#include "picture.hpp"

namespace trammel::app::reproduce {
namespace {

using namespace interpolation;

constexpr int kLines = 1'000'000;

struct Bounds {
  std::int64_t over = 0;  // positions at a distance of one pulse or more along the shorter axis
  std::int64_t wrong_end = 0;
  std::int64_t positions = 0;
  double along = 0;  // largest distance along the shorter axis
  double perpendicular = 0;
};

void take(Bounds& bounds, const Line& line, std::uint64_t clocks) {
  const std::int64_t dx = line.end[0];
  const std::int64_t dy = line.end[1];
  const std::int64_t longer = std::max(std::abs(dx), std::abs(dy));
  if (longer == 0) return;
  // f = `clocks` and v = 1: a line of that many clocks.
  PulseTrainLine<2> walk(line, one_shot_timing({clocks, 1, 1}, PulseTiming::Kind::kAccumulatorHalf));
  std::int64_t largest = 0;
  while (!walk.done()) {
    walk.next();
    const Position p = walk.position();
    const std::int64_t d = std::abs(dx * p[1] - dy * p[0]);
    largest = std::max(largest, d);
    bounds.over += d >= longer;
    ++bounds.positions;
  }
  if (walk.position() != line.end || walk.time() > clocks) ++bounds.wrong_end;
  const auto d = static_cast<double>(largest);
  bounds.along = std::max(bounds.along, d / static_cast<double>(longer));
  bounds.perpendicular =
      std::max(bounds.perpendicular, d / std::hypot(static_cast<double>(dx), static_cast<double>(dy)));
}

void random_lines(Page& page, const Progress& progress) {
  page.heading("The proof's bound");
  std::mt19937_64 random(3);
  Bounds bounds;
  for (int i = 0; i < kLines; ++i) {
    const std::int64_t most = i % 2 == 0 ? 20 : 200;
    const Line line = make_line({0, 0}, {uniform(random, -most, most), uniform(random, -most, most)});
    const auto longest = static_cast<std::int64_t>(longest_axis(line));
    const auto clocks = static_cast<std::uint64_t>(uniform(random, std::max<std::int64_t>(longest, 1), 50'000));
    take(bounds, line, clocks);
    if (i % 20'000 == 0) progress(0.9 * i / kLines);
  }
  page.pass("Bound of the error, (11) to (24)", "below 1 pulse along the shorter axis",
            fmt::format("{} random lines in all octants, {} positions: {} at 1 pulse or more, the largest {:.4f}",
                        kLines, bounds.positions, bounds.over, bounds.along),
            bounds.over == 0 && bounds.along > 0.95);
  // sqrt(2) / 2: either axis is at most half a pulse off its place.
  page.pass("Bound, perpendicular", "not given",
            fmt::format("at most {:.4f} pulses, below sqrt(1/2) = 0.7071", bounds.perpendicular),
            bounds.perpendicular <= std::sqrt(0.5) + 1e-12 && bounds.perpendicular > 0.68);
  page.pass("End of the line", "the error of the end point is zero",
            fmt::format("{} of {} lines end wrong or late", bounds.wrong_end, kLines), bounds.wrong_end == 0);
}

struct DividerCase {
  std::int64_t x;
  std::int64_t y;
  std::uint64_t v;
  double expected;
};

void dividers(Page& page) {
  page.heading("Integer dividers");
  constexpr std::array<DividerCase, 4> kCases{
      {{29999, 10007, 1, 4.10}, {29999, 10007, 3, 7.59}, {30000, 10001, 1, 3.79}, {30000, 10001, 3, 7.59}}};
  Csv csv("dx,dy,v,x,distance_divider,distance_accumulator");
  std::vector<std::vector<std::string>> rows{
      {"line", "v", "dividers", "x ends at clock", "y ends at clock", "accumulators"}};
  std::vector<Series> series;
  const std::array<const char*, 4> colours{"#c03", "#e80", "#06c", "#393"};
  bool equal = true;
  bool apart = true;
  bool exact = true;
  for (std::size_t i = 0; i < kCases.size(); ++i) {
    const DividerCase& c = kCases[i];
    const Line line = make_line({0, 0}, {c.x, c.y});
    const interpolation::Options options{50'000'000, c.v, 1};
    double largest = 0;
    std::array<std::uint64_t, 2> ends{};
    Series stray{fmt::format("({},{}) v = {}", c.x, c.y, c.v), colours[i], {{0, 0}}, 1.2, false, false};
    std::int64_t next_sample = 0;
    make_interpolator(Method::kDivider, line, options).run([&](const Step& step, const auto& walk) {
      const double d = distance(line, walk.position());
      largest = std::max(largest, d);
      for (std::size_t a = 0; a < 2; ++a) {
        if (step.direction[a] != 0) ends[a] = walk.time();
      }
      // 120 of 30,000 pulses: the picture shows no more.
      const std::int64_t x = walk.position()[0];
      if (x < next_sample) return;
      next_sample = x + 250;
      stray.points.push_back({static_cast<double>(x), d});
    });
    double accumulators = 0;
    make_interpolator(Method::kOneShot, line, options).run([&](const Step&, const auto& walk) {
      accumulators = std::max(accumulators, distance(line, walk.position()));
    });
    for (const PicturePoint& p : stray.points) {
      csv.row("{},{},{},{:g},{:.4f},{:.4f}", c.x, c.y, c.v, p[0], p[1], accumulators);
    }
    equal = equal && std::fabs(largest - c.expected) < 0.005;
    apart = apart && ends[0] != ends[1];
    exact = exact && accumulators < 0.7072;
    rows.push_back({fmt::format("({},{})", c.x, c.y), std::to_string(c.v), fmt::format("{:.2f}", largest),
                    std::to_string(ends[0]), std::to_string(ends[1]), fmt::format("{:.3f}", accumulators)});
    series.push_back(stray);
  }
  page.table(rows);
  page.corrected("Pulse generators made of timers", "timers will do, and the error stays below 1 pulse",
                 "with whole dividers at 50 MHz the lines above stray by 3.79 to 7.59 pulses and the axes end at "
                 "different times; phase accumulators keep the bound",
                 equal && apart && exact);
  page.picture("one-shot-dividers", "Distance from the line with integer dividers, over x",
               draw({{"distance, pulses", series, false}}, {1, 720, 300}), csv);
}

}  // namespace

void one_shot_bound(Page& page, const Progress& progress) {
  random_lines(page, progress);
  dividers(page);
}

}  // namespace trammel::app::reproduce
