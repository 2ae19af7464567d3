#include "compare_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace trammel::app {
namespace {

namespace measure = measure;

constexpr double kWidth = 1100;
constexpr double kLeft = 150;  // of the small panels
constexpr double kPanelWidth = 440;
constexpr double kRight = kLeft + kPanelWidth + 50;
constexpr double kRowHeight = 56;
constexpr double kTop = 90;
constexpr double kMotorHeight = 300;
// Points of one polyline at most: two panels of ten methods stay below 1 MB.
constexpr std::size_t kMostPoints = 2000;

constexpr std::array<const char*, 10> kColours = {"#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd",
                                                  "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22", "#17becf"};

constexpr const char* kStyle = R"(<style>
text{font:13px sans-serif;fill:#222} .small{font-size:11px;fill:#555} .title{font-size:18px;font-weight:bold}
.frame{fill:#fcfcfc;stroke:#bbb} .grid{stroke:#ddd} polyline{stroke-width:1.3}
</style>
)";

struct Sample {
  double x;
  double y;
};

// A rectangle with linear scales; y upwards.
struct Panel {
  double left, top, width, height;
  double x_low, x_high, y_low, y_high;

  double x(double value) const { return left + width * (value - x_low) / (x_high - x_low); }
  double y(double value) const { return top + height * (1 - (value - y_low) / (y_high - y_low)); }
  std::string frame() const {
    return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n", left, top, width,
                       height);
  }
  // Steps: each value is held until the next one.
  std::string held(const std::vector<Sample>& samples, const char* colour) const {
    std::string text = "<polyline fill=\"none\" points=\"";
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i > 0) text += fmt::format("{:.1f},{:.1f} ", x(samples[i].x), y(samples[i - 1].y));
      text += fmt::format("{:.1f},{:.1f} ", x(samples[i].x), y(samples[i].y));
    }
    return text + fmt::format("\" stroke=\"{}\"/>\n", colour);
  }
  std::string line(const std::vector<Sample>& samples, const char* colour) const {
    std::string text = "<polyline fill=\"none\" points=\"";
    for (const Sample& sample : samples) text += fmt::format("{:.1f},{:.1f} ", x(sample.x), y(sample.y));
    return text + fmt::format("\" stroke=\"{}\"/>\n", colour);
  }
};

// Of each of at most kMostPoints groups of neighbours, the largest: peaks stay.
std::vector<Sample> thinned(const std::vector<Sample>& samples) {
  const std::size_t group = samples.size() / kMostPoints + 1;
  std::vector<Sample> result;
  for (std::size_t i = 0; i < samples.size(); i += group) {
    const auto end = samples.begin() + static_cast<std::ptrdiff_t>(std::min(i + group, samples.size()));
    result.push_back(*std::max_element(samples.begin() + static_cast<std::ptrdiff_t>(i), end,
                                       [](const Sample& a, const Sample& b) { return a.y < b.y; }));
  }
  return result;
}

std::vector<Sample> distance_samples(const measure::Trace& trace, const measure::IdealCurve& curve) {
  std::vector<Sample> samples = {{0, 0}};
  measure::TracePosition position = trace.start();
  for (const measure::Event& event : trace.events()) {
    for (std::size_t a = 0; a < trace.axes(); ++a) position[a] += event.direction[a];
    const double time = static_cast<double>(event.time) / static_cast<double>(trace.total_time());
    samples.push_back({time, curve.distance(position)});
  }
  return thinned(samples);
}

// The axis with the most pulses; the first of equals. It is the one a motor is shaken by most often.
std::size_t busiest_axis(const measure::Trace& trace) {
  std::size_t busiest = 0;
  for (std::size_t a = 1; a < trace.axes(); ++a) {
    if (trace.times(a).size() > trace.times(busiest).size()) busiest = a;
  }
  return busiest;
}

std::vector<Sample> interval_samples(const measure::Trace& trace, const measure::IdealCurve& curve) {
  std::vector<Sample> samples;
  const std::vector<double> deviations = measure::interval_deviations(trace, curve, busiest_axis(trace));
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    samples.push_back({static_cast<double>(i) / static_cast<double>(deviations.size()), 100 * deviations[i]});
  }
  return thinned(samples);
}

struct Extent {
  double low = 0;
  double high = 0;
  void take(const std::vector<Sample>& samples) {
    for (const Sample& sample : samples) {
      low = std::min(low, sample.y);
      high = std::max(high, sample.y);
    }
  }
};

// One row a method: distance along the way, and the intervals of its busiest axis; all rows at one scale.
std::string rows(const Comparison& comparison, const std::vector<measure::Trace>& traces,
                 const measure::IdealCurve& curve) {
  std::vector<std::vector<Sample>> distances;
  std::vector<std::vector<Sample>> intervals;
  Extent distance{0, 0.5};
  Extent interval{-1, 1};
  for (const measure::Trace& trace : traces) {
    distances.push_back(distance_samples(trace, curve));
    intervals.push_back(interval_samples(trace, curve));
    distance.take(distances.back());
    interval.take(intervals.back());
  }
  std::string text = fmt::format(
      "<text x=\"{}\" y=\"{}\">distance from the curve over time, 0 to {:.2f} pulses</text>\n<text x=\"{}\" "
      "y=\"{}\">interval deviation of the busiest axis, {:.0f} to {:.0f} %</text>\n",
      kLeft, kTop - 10, distance.high, kRight, kTop - 10, interval.low, interval.high);
  for (std::size_t m = 0; m < traces.size(); ++m) {
    const double top = kTop + kRowHeight * static_cast<double>(m);
    const char* colour = kColours[m % kColours.size()];
    const Panel left{kLeft, top, kPanelWidth, kRowHeight - 8, 0, 1, distance.low, 1.05 * distance.high};
    const Panel right{kRight, top, kPanelWidth, kRowHeight - 8, 0, 1, 1.05 * interval.low, 1.05 * interval.high};
    text += fmt::format("<text x=\"10\" y=\"{:.1f}\" style=\"fill:{}\">{}</text>\n", top + kRowHeight / 2, colour,
                        interpolation::info(comparison.methods[m].method).name);
    text += left.frame() + left.held(distances[m], colour);
    text += right.frame() + right.line({{0, 0}, {1, 0}}, "#ddd") + right.line(intervals[m], colour);
  }
  return text;
}

// Ripple over speed, both logarithmic, until steps are lost: there the line ends with a cross.
std::string motor_panel(const Comparison& comparison, double top) {
  constexpr double kLowest = -4;
  const Panel panel{kLeft,
                    top,
                    kRight + kPanelWidth - kLeft,
                    kMotorHeight,
                    std::log10(comparison.speeds.front()),
                    std::log10(comparison.speeds.back()),
                    kLowest,
                    1};
  std::string text =
      fmt::format(
          "<text x=\"{}\" y=\"{}\">rms speed ripple of the simulated motors, relative to the speed along the "
          "path, over pulses/s along the path (cross: steps lost)</text>\n",
          kLeft, top - 10) +
      panel.frame();
  for (double power = kLowest; power <= 1; ++power) {
    text += panel.line({{panel.x_low, power}, {panel.x_high, power}}, "#ddd");
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"small\" text-anchor=\"end\">{:g} %</text>\n",
                        kLeft - 6, panel.y(power) + 4, 100 * std::pow(10, power));
  }
  for (std::size_t i = 0; i < comparison.speeds.size(); i += 3) {
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"small\" text-anchor=\"middle\">{:.0f}/s</text>\n",
                        panel.x(std::log10(comparison.speeds[i])), top + kMotorHeight + 16, comparison.speeds[i]);
  }
  for (std::size_t m = 0; m < comparison.sweeps.size(); ++m) {
    const char* colour = kColours[m % kColours.size()];
    std::vector<Sample> samples;
    for (std::size_t i = 0; i < comparison.speeds.size(); ++i) {
      const measure::Vibration& vibration = comparison.sweeps[m][i];
      const double speed = std::log10(comparison.speeds[i]);
      if (vibration.lost_steps) {
        const double height = samples.empty() ? 0 : samples.back().y;
        text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" style=\"fill:{}\" text-anchor=\"middle\">x</text>\n",
                            panel.x(speed), panel.y(height) + 4, colour);
        break;
      }
      samples.push_back({speed, std::log10(std::clamp(vibration.rms_ripple, 1e-4, 10.0))});
    }
    text += panel.line(samples, colour);
  }
  return text;
}

}  // namespace

std::string comparison_svg(const Comparison& comparison, const std::vector<measure::Trace>& traces,
                           const measure::IdealCurve& curve) {
  const double motor_top = kTop + kRowHeight * static_cast<double>(traces.size()) + 40;
  const double height = motor_top + kMotorHeight + 40;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n{2}"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"10\" y=\"34\" class=\"title\">{3}</text>\n",
      kWidth + 40, height, kStyle, comparison.title);
  svg += rows(comparison, traces, curve);
  svg += motor_panel(comparison, motor_top);
  return svg + "</svg>\n";
}

}  // namespace trammel::app
