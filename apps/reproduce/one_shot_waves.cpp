// Zeng, Zhang & Huang, Figure 4: the pulses of both methods on the line (0,0) to (10,20), and the evenness of their
// intervals.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "chapters.hpp"

namespace trammel::app::reproduce {

using namespace interpolation;

std::vector<double> pulse_times(const Track& track, std::size_t axis, double period) {
  std::vector<double> times;
  for (std::size_t i = 1; i < track.size(); ++i) {
    if (track[i].position[axis] == track[i - 1].position[axis]) continue;
    times.push_back(static_cast<double>(track[i].time) * period);
  }
  return times;
}

Spread spread_of(const std::vector<double>& times) {
  Spread spread;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double interval = times[i] - times[i - 1];
    spread.least = i == 1 ? interval : std::min(spread.least, interval);
    spread.largest = std::max(spread.largest, interval);
  }
  return spread;
}

namespace {

// `high`: duration of a drawn pulse of x and of y, clocks; 0 draws only its instant.
void add_pulses(Csv& csv, chart::Panel& panel, const char* method, const Track& track, double period, double end,
                const std::array<double, 2>& high) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::vector<double> times = pulse_times(track, axis, period);
    for (std::size_t i = 0; i < times.size(); ++i) {
      csv.row("{},{},{},{:g}", method, axis == 0 ? 'x' : 'y', i + 1, times[i]);
    }
    std::vector<double> falling = times;
    for (double& time : falling) time += high[axis];
    panel.series.push_back(wave(axis, times, falling, end));
  }
}

// Over all axes of Lines 1 to 8: the largest difference between two intervals of one axis.
struct Unevenness {
  double units = 0;     // in units of the method's time
  double relative = 0;  // relative to the axis's mean interval
};

Unevenness unevenness(Method method) {
  Unevenness worst;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Track track = track_of(method, kPaperLines[i].line());
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::vector<double> times = pulse_times(track, axis, 1);
      if (times.size() < 2) continue;
      const Spread spread = spread_of(times);
      const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
      worst.units = std::max(worst.units, spread.largest - spread.least);
      worst.relative = std::max(worst.relative, (spread.largest - spread.least) / mean);
    }
  }
  return worst;
}

}  // namespace

void one_shot_waves(Page& page, const Progress& progress) {
  page.heading("Figure 4: waveforms of (0,0) to (10,20)");
  const Line line = make_line({0, 0}, {10, 20});
  const Track one_shot = track_of(Method::kOneShot, line);
  const Track by_point = track_of(Method::kPointByPoint, line);
  // A step every 100 clocks, the pulse interval of y in the one-shot line: the equal velocity of the paper.
  constexpr double kPeriod = 100;
  const double end = kPeriod * static_cast<double>(by_point.size() - 1);
  Csv csv("method,axis,pulse,clock");
  std::vector<chart::Panel> panels(2);
  panels[0] = wave_panel("(a) one-shot", end);
  panels[1] = wave_panel("(b) point by point", end);
  // The paper's duty ratio is 50 %, of intervals of 200 and 100 clocks. The point-by-point rule determines the time of
  // a pulse, not its duration.
  add_pulses(csv, panels[0], "one-shot", one_shot, 1, end, {100, 50});
  add_pulses(csv, panels[1], "point-by-point", by_point, kPeriod, end, {0, 0});
  const Spread x = spread_of(pulse_times(one_shot, 0, 1));
  const Spread y = spread_of(pulse_times(one_shot, 1, 1));
  const Spread other = spread_of(pulse_times(by_point, 1, kPeriod));
  page.pass("Figure 4 (a)", "the frequency of both axes stays the same",
            fmt::format("x makes a pulse every {:g} clocks, y every {:g}", x.largest, y.largest),
            x.least == 200 && x.largest == 200 && y.least == 100 && y.largest == 100);
  page.pass("Figure 4 (b)", "the frequency of y changes",
            fmt::format("the pulses of y are {:g} to {:g} clocks apart", other.least, other.largest),
            other.largest > other.least);
  page.pass("Figure 4, time", "one-shot takes less time at equal velocity",
            fmt::format("{} clocks for one-shot, {:g} for point by point", kPaperClocks, end), end == 3000);
  page.picture(
      "one-shot-figure-4",
      "Pulses over clocks at 10 MHz, v = 5000: (a) with the paper's duty ratio of 50 %; (b) only the times of the "
      "pulses, because the method does not define their length",
      chart::grid_of(panels, 1, 900, 190), csv);
  progress(0.5);
  const Unevenness even = unevenness(Method::kOneShot);
  const Unevenness uneven = unevenness(Method::kPointByPoint);
  page.corrected(
      "Velocities unchanged", "both velocities stay the same during the line",
      fmt::format("only to within {:g} clock if f / (v p) is not a whole number. Over Lines 1 to 8 the intervals "
                  "of an axis differ by at most {:.1f} % of their mean; point by point they differ by up to {:.0f} %",
                  even.units, 100 * even.relative, 100 * uneven.relative),
      even.units == 1 && even.relative < uneven.relative);
}

}  // namespace trammel::app::reproduce
