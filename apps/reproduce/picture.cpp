#include "picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace trammel::app::reproduce {
namespace {

constexpr double kMargin = 44;  // room for the title, the ticks and the legend

// Maps a panel's values into its rectangle.
class Frame {
 public:
  Frame(const Panel& panel, double left, double top, const Layout& layout)
      : left_(left + kMargin), bottom_(top + layout.height - kMargin) {
    bool first = true;
    for (const Series& series : panel.series) {
      for (const PicturePoint& p : series.points) {
        for (std::size_t i = 0; i < 2; ++i) {
          low_[i] = first ? p[i] : std::min(low_[i], p[i]);
          high_[i] = first ? p[i] : std::max(high_[i], p[i]);
        }
        first = false;
      }
    }
    // A flat panel at equal scale still has room for its labels.
    const double least = panel.equal_scale ? 0.25 * std::max(high_[0] - low_[0], high_[1] - low_[1]) : 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double missing = std::max(0.0, least - (high_[i] - low_[i]));
      low_[i] -= missing / 2;
      high_[i] += missing / 2;
    }
    const double room[2] = {layout.width - 1.5 * kMargin, layout.height - 2 * kMargin};
    for (std::size_t i = 0; i < 2; ++i) scale_[i] = room[i] / std::max(high_[i] - low_[i], 1e-9);
    if (panel.equal_scale) scale_[0] = scale_[1] = std::min(scale_[0], scale_[1]);
  }
  double x(double value) const { return left_ + (value - low_[0]) * scale_[0]; }
  double y(double value) const { return bottom_ - (value - low_[1]) * scale_[1]; }
  double low(std::size_t i) const { return low_[i]; }
  double high(std::size_t i) const { return high_[i]; }

 private:
  double left_;
  double bottom_;
  double low_[2] = {0, 0};
  double high_[2] = {1, 1};
  double scale_[2] = {1, 1};
};

std::string label(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
}

std::string axes(const Frame& frame) {
  const double left = frame.x(frame.low(0));
  const double right = frame.x(frame.high(0));
  const double bottom = frame.y(frame.low(1));
  const double top = frame.y(frame.high(1));
  std::string out = fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#bbb\"/>\n", left, top,
      right - left, bottom - top);
  out += label(left, bottom + 14, "start", fmt::format("{:g}", std::round(10 * frame.low(0)) / 10));
  out += label(right, bottom + 14, "end", fmt::format("{:g}", std::round(10 * frame.high(0)) / 10));
  out += label(left - 4, bottom, "end", fmt::format("{:g}", std::round(10 * frame.low(1)) / 10));
  out += label(left - 4, top + 10, "end", fmt::format("{:g}", std::round(10 * frame.high(1)) / 10));
  return out;
}

std::string draw_series(const Frame& frame, const Series& series) {
  std::string out;
  if (series.dots) {
    for (const PicturePoint& p : series.points) {
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n", frame.x(p[0]),
                         frame.y(p[1]), series.width, series.colour);
    }
    return out;
  }
  out = "<polyline points=\"";
  for (const PicturePoint& p : series.points) out += fmt::format("{:.1f},{:.1f} ", frame.x(p[0]), frame.y(p[1]));
  return out + fmt::format("\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"{}/>\n", series.colour, series.width,
                           series.dashed ? " stroke-dasharray=\"4 3\"" : "");
}

std::string draw_panel(const Panel& panel, double left, double top, const Layout& layout) {
  const Frame frame(panel, left, top, layout);
  std::string out = axes(frame);
  out += label(left + kMargin, top + 20, "start", panel.title);
  double at = left + kMargin;
  for (const Series& series : panel.series) {
    out += draw_series(frame, series);
    if (series.label.empty()) continue;
    const double y = top + layout.height - 8;
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"10\" height=\"4\" fill=\"{}\"/>\n", at, y - 6,
                       series.colour);
    out += label(at + 14, y, "start", series.label);
    at += 26 + 6.2 * static_cast<double>(series.label.size());
  }
  return out;
}

}  // namespace

std::string draw(const std::vector<Panel>& panels, const Layout& layout) {
  const std::size_t rows = (panels.size() + layout.columns - 1) / layout.columns;
  const double width = layout.width * layout.columns;
  const double height = layout.height * static_cast<double>(rows);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\" width=\"{:g}\" height=\"{:g}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height, width, height);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double left = layout.width * static_cast<double>(i % layout.columns);
    const double top = layout.height * static_cast<double>(i / layout.columns);
    out += draw_panel(panels[i], left, top, layout);
  }
  return out + "</svg>\n";
}

std::vector<PicturePoint> waveform(const std::vector<double>& times, double end, double base) {
  std::vector<PicturePoint> out{{0, base}};
  double interval = times.empty() ? 0 : times.front();
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i + 1 < times.size()) interval = times[i + 1] - times[i];
    const double down = times[i] + interval / 2;
    out.push_back({times[i], base});
    out.push_back({times[i], base + 0.8});
    out.push_back({down, base + 0.8});
    out.push_back({down, base});
  }
  out.push_back({std::max(end, out.back()[0]), base});
  return out;
}

}  // namespace trammel::app::reproduce
