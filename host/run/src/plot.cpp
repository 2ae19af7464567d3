#include "trammel/run/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace trammel::run {

void ThinnedPath::add(const Point& point) {
  last_ = point;
  if (given_++ % stride_ != 0) return;
  kept_.push_back(point);
  if (kept_.size() < 2 * limit_) return;
  for (std::size_t i = 0; i < limit_; ++i) kept_[i] = kept_[2 * i];
  kept_.resize(limit_);
  stride_ *= 2;
}

std::vector<Point> ThinnedPath::points() const {
  std::vector<Point> all = kept_;
  if (given_ > 0) all.push_back(last_);
  return all;
}

void SpeedOverTime::add(std::uint64_t cycle, std::size_t axis, double millimetres) {
  while (cycle / bin_width_ >= kBins) {
    for (std::size_t i = 0; i < kBins / 2; ++i) {
      for (std::size_t a = 0; a < 3; ++a) bins_[i][a] = bins_[2 * i][a] + bins_[2 * i + 1][a];
    }
    std::fill(bins_.begin() + kBins / 2, bins_.end(), Point{});
    bin_width_ *= 2;
    used_ = (used_ + 1) / 2;
  }
  const auto bin = static_cast<std::size_t>(cycle / bin_width_);
  bins_[bin][axis] += millimetres;
  used_ = std::max(used_, bin + 1);
}

std::vector<SpeedOverTime::Sample> SpeedOverTime::samples() const {
  std::vector<Sample> result;
  const double width = static_cast<double>(bin_width_) / clock_hz_;
  for (std::size_t i = 0; i < used_; ++i) {
    result.push_back(
        {(static_cast<double>(i) + 0.5) * width, std::hypot(bins_[i][0], bins_[i][1], bins_[i][2]) / width});
  }
  return result;
}

namespace {

constexpr const char* kAxisNames = "XYZ";
constexpr double kWidth = 1000;
constexpr double kMargin = 60;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  double span() const { return high > low ? high - low : 0; }
};

struct View {
  std::size_t across = 0;  // axis drawn to the right
  std::size_t up = 1;      // axis drawn upwards
};

// The plane in which the path covers the largest area; XY on a tie.
View choose_view(const std::vector<Point>& points) {
  std::array<Range, 3> range;
  for (const Point& p : points) {
    for (std::size_t i = 0; i < 3; ++i) range[i].take(p[i]);
  }
  View best;
  double best_area = range[0].span() * range[1].span();
  for (const View view : {View{0, 2}, View{1, 2}}) {
    const double area = range[view.across].span() * range[view.up].span();
    if (area > best_area) {
      best = view;
      best_area = area;
    }
  }
  return best;
}

// 1, 2 or 5 times a power of ten, so that 4 to 10 of them make `whole`.
double round_step(double whole) {
  const double power = std::pow(10.0, std::floor(std::log10(whole / 4)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= whole / 4) return factor * power;
  }
  return power;
}

// Maps millimetres into a panel with equal scales on both axes.
class Panel {
 public:
  Panel(const std::vector<Point>& points, View view, double left, double top, double width, double height)
      : view_(view), left_(left), top_(top), width_(width), height_(height) {
    for (const Point& p : points) {
      x_.take(p[view.across]);
      y_.take(p[view.up]);
    }
    const double x_span = std::max(x_.span(), 1e-3);
    const double y_span = std::max(y_.span(), 1e-3);
    scale_ = 0.94 * std::min(width / x_span, height / y_span);
    if (points.empty()) x_ = y_ = Range{0, 0};
  }
  std::string point(const Point& p) const {
    const double x = left_ + width_ / 2 + scale_ * (p[view_.across] - (x_.low + x_.high) / 2);
    const double y = top_ + height_ / 2 - scale_ * (p[view_.up] - (y_.low + y_.high) / 2);
    return fmt::format("{:.1f},{:.1f}", x, y);
  }
  std::string line(const std::vector<Point>& points, const char* style) const {
    std::string text = "<polyline points=\"";
    for (const Point& p : points) {
      text += point(p);
      text += ' ';
    }
    return text + fmt::format("\" {}/>\n", style);
  }
  std::string dots(const std::vector<Point>& points, double radius, const char* style) const {
    std::string text;
    for (const Point& p : points) {
      const std::string at = point(p);
      const auto comma = at.find(',');
      text += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", at.substr(0, comma), at.substr(comma + 1),
                          radius, style);
    }
    return text;
  }
  std::string frame(const std::string& title) const {
    return fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n<text x=\"{}\" y=\"{}\">{}</text>\n"
        "<text x=\"{}\" y=\"{}\" class=\"small\">{} {:.2f} .. {:.2f} mm, {} {:.2f} .. {:.2f} mm</text>\n",
        left_, top_, width_, height_, left_, top_ - 8, title, left_ + 6, top_ + height_ - 8, kAxisNames[view_.across],
        x_.low, x_.high, kAxisNames[view_.up], y_.low, y_.high);
  }

 private:
  View view_;
  double left_, top_, width_, height_;
  Range x_, y_;
  double scale_ = 1;
};

std::string speed_panel(const std::vector<SpeedOverTime::Sample>& speed, double top, double height) {
  const double width = kWidth - 2 * kMargin;
  double fastest = 1e-9;
  double longest = 1e-9;
  for (const auto& s : speed) {
    fastest = std::max(fastest, s.speed);
    longest = std::max(longest, s.seconds);
  }
  std::string text = fmt::format(
      "<text x=\"{0}\" y=\"{1}\">speed along the path, mm/s</text>\n<rect x=\"{0}\" y=\"{2}\" width=\"{3}\" "
      "height=\"{4}\" class=\"frame\"/>\n",
      kMargin, top - 8, top, width, height);
  for (double v = 0; v <= fastest; v += round_step(fastest)) {
    const double y = top + height * (1 - 0.94 * v / fastest);
    text += fmt::format(
        "<line x1=\"{}\" y1=\"{:.1f}\" x2=\"{}\" y2=\"{:.1f}\" class=\"grid\"/><text x=\"{}\" y=\"{:.1f}\" "
        "class=\"small\" text-anchor=\"end\">{:g}</text>\n",
        kMargin, y, kMargin + width, y, kMargin - 6, y + 4, v);
  }
  for (double t = 0; t <= longest; t += round_step(longest)) {
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"small\" text-anchor=\"middle\">{:g} s</text>\n",
                        kMargin + width * t / longest, top + height + 16, t);
  }
  text += "<polyline points=\"";
  for (const auto& s : speed) {
    text += fmt::format("{:.1f},{:.1f} ", kMargin + width * s.seconds / longest,
                        top + height * (1 - 0.94 * s.speed / fastest));
  }
  return text + "\" class=\"speed\"/>\n";
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += c;
    }
  }
  return result;
}

constexpr const char* kStyle = R"(<style>
text{font:14px sans-serif;fill:#222} .small{font-size:11px;fill:#555} .title{font-size:18px;font-weight:bold}
.frame{fill:#fcfcfc;stroke:#999} .grid{stroke:#ddd} polyline{fill:none}
.commanded{stroke:#d62728;stroke-width:1.4} .executed{stroke:#1f77b4;stroke-width:0.8}
.pulse{fill:#1f77b4} .speed{stroke:#2ca02c;stroke-width:1.2}
</style>
)";

}  // namespace

std::string svg(const Plot& plot) {
  constexpr double kPanelTop = 70;
  constexpr double kPanelHeight = 520;
  constexpr double kPathWidth = 540;
  constexpr double kDetailLeft = kMargin + kPathWidth + 30;
  constexpr double kSpeedTop = kPanelTop + kPanelHeight + 60;
  constexpr double kSpeedHeight = 180;
  std::vector<Point> all = plot.commanded;
  all.insert(all.end(), plot.executed.begin(), plot.executed.end());
  const Panel path(all, choose_view(all), kMargin, kPanelTop, kPathWidth, kPanelHeight);
  std::vector<Point> detail = plot.detail_commanded;
  detail.insert(detail.end(), plot.detail_executed.begin(), plot.detail_executed.end());
  const Panel zoom(detail, choose_view(detail), kDetailLeft, kPanelTop, kWidth - kDetailLeft - kMargin, kPanelHeight);

  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n{2}"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"{3}\" y=\"30\" class=\"title\">{4}</text>\n",
      kWidth, kSpeedTop + kSpeedHeight + 40, kStyle, kMargin, escaped(plot.title));
  text += path.frame(plot.executed_thinned ? "path: commanded (red), pulses (blue, thinned)"
                                           : "path: commanded (red), pulses (blue)");
  text += path.line(plot.commanded, "class=\"commanded\"");
  text += path.line(plot.executed, "class=\"executed\"");
  text += zoom.frame("magnified: every pulse of one stretch");
  text += zoom.line(plot.detail_commanded, "class=\"commanded\"");
  text += zoom.line(plot.detail_executed, "class=\"executed\"");
  text += zoom.dots(plot.detail_executed, 2.2, "class=\"pulse\"");
  text += speed_panel(plot.speed, kSpeedTop, kSpeedHeight);
  return text + "</svg>\n";
}

}  // namespace trammel::run
