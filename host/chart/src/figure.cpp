#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scale.hpp"
#include "trammel/chart/chart.hpp"

namespace trammel::chart {
namespace {

// Pixels.
constexpr double kLeft = 62;  // for the numbers and the label of y
constexpr double kRight = 16;
constexpr double kBottom = 40;  // for the numbers and the label of x
constexpr double kTitle = 24;
constexpr double kLegendRow = 17;
constexpr double kLetter = 6.8;  // average width at a font size of 11 pixels
constexpr double kSample = 22;   // width of the legend's sample of a series
constexpr double kTickX = 74;    // least distance between numbers
constexpr double kTickY = 34;    // least distance between numbers

constexpr const char* kStyle =
    "<style>\n"
    "text{font:11px sans-serif;fill:#333} .title{font-size:13px;fill:#111} .head{font-size:17px;fill:#111}\n"
    ".frame{fill:none;stroke:#888} .grid{stroke:#e4e4e4} .data{fill:none;stroke-linejoin:round}\n"
    "</style>\n";

std::string text_at(double x, double y, const char* anchor, std::string_view text, const char* rest = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, rest,
                     escaped(text));
}

double width_of(const Series& series) { return kSample + 6 + kLetter * static_cast<double>(series.label.size()) + 14; }

// One mark at a point.
std::string mark_at(const Series& series, double x, double y) {
  if (series.mark == Mark::kCrosses) {
    const double s = series.width;
    return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>\n", x - s,
                       y - s, x + s, y + s, x - s, y + s, x + s, y - s, series.colour);
  }
  if (series.mark == Mark::kCircles) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"{}\"/>\n", x, y,
                       series.width, series.colour);
  }
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n", x, y, series.width,
                     series.colour);
}

bool joined(const Series& series) { return series.mark == Mark::kLine || series.mark == Mark::kStairs; }

std::string stroke_of(const Series& series) {
  return fmt::format("class=\"data\" stroke=\"{}\" stroke-width=\"{:g}\"{}", series.colour, series.width,
                     series.dashed ? " stroke-dasharray=\"5 3\"" : "");
}

class Drawing {
 public:
  Drawing(const Panel& panel, const Box& box)
      : panel_(panel), box_(box), x_(panel.x, panel.series, 0), y_(panel.y, panel.series, 1) {
    lay_out_legend();
    left_ = box.left + kLeft;
    right_ = box.left + box.width - kRight;
    top_ = box.top + kTitle + kLegendRow * static_cast<double>(rows_.size()) + 4;
    bottom_ = box.top + box.height - kBottom;
    if (panel.equal_scale) {
      const double scale = std::min((right_ - left_) / x_.span(), (bottom_ - top_) / y_.span()) * 0.96;
      x_.widen((right_ - left_) / scale);
      y_.widen((bottom_ - top_) / scale);
    }
    x_.place(left_, right_);
    y_.place(bottom_, top_);
  }

  std::string draw() const {
    std::string out = grid();
    for (const Series& series : panel_.series) out += data(series);
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"frame\"/>\n", left_,
                       top_, right_ - left_, bottom_ - top_);
    out += text_at(left_, box_.top + 16, "start", panel_.title, " class=\"title\"");
    return out + legend();
  }

 private:
  // Lays out the legend in rows up to the width of the panel.
  void lay_out_legend() {
    double used = 0;
    for (const Series& series : panel_.series) {
      if (series.label.empty() || !panel_.legend) continue;
      const double width = width_of(series);
      if (rows_.empty() || used + width > box_.width - kLeft) {
        rows_.emplace_back();
        used = 0;
      }
      rows_.back().push_back(&series);
      used += width;
    }
  }

  std::string legend() const {
    std::string out;
    double y = box_.top + kTitle + 8;
    for (const auto& row : rows_) {
      double x = left_;
      for (const Series* series : row) {
        if (joined(*series)) {
          out += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x, y - 4,
                             x + kSample, y - 4, stroke_of(*series));
        } else {
          out += mark_at(*series, x + kSample / 2, y - 4);
        }
        out += text_at(x + kSample + 6, y, "start", series->label);
        x += width_of(*series);
      }
      y += kLegendRow;
    }
    return out;
  }

  std::string grid() const {
    std::string out;
    if (panel_.x.numbers) {
      for (const Tick& tick : x_.ticks(count(right_ - left_, kTickX))) {
        const double x = x_.pixel(tick.value);
        out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" class=\"grid\"/>\n", x, top_, bottom_);
        out += text_at(x, bottom_ + 15, "middle", tick.text);
      }
    }
    if (panel_.y.numbers) {
      for (const Tick& tick : y_.ticks(count(bottom_ - top_, kTickY))) {
        const double y = y_.pixel(tick.value);
        out += fmt::format("<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" class=\"grid\"/>\n", left_, y, right_);
        out += text_at(left_ - 6, y + 4, "end", tick.text);
      }
    }
    out += text_at((left_ + right_) / 2, bottom_ + 32, "middle", panel_.x.label);
    if (panel_.y.label.empty()) return out;
    const double x = box_.left + 13;
    const double y = (top_ + bottom_) / 2;
    return out + text_at(x, y, "middle", panel_.y.label,
                         fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, y).c_str());
  }

  static std::size_t count(double pixels, double apart) {
    return std::max<std::size_t>(2, static_cast<std::size_t>(pixels / apart));
  }

  bool shown(const Point& point) const { return x_.shows(point[0]) && y_.shows(point[1]); }

  std::string data(const Series& series) const {
    if (joined(series)) return polylines(series);
    std::string out;
    for (const Point& point : series.points) {
      if (shown(point)) out += mark_at(series, x_.pixel(point[0]), y_.pixel(point[1]));
    }
    return out;
  }

  // A point that is not shown (not finite, or outside the panel) interrupts the line.
  std::string polylines(const Series& series) const {
    std::string out;
    std::string points;
    const Point* before = nullptr;
    const auto finish = [&] {
      if (!points.empty()) out += fmt::format("<polyline points=\"{}\" {}/>\n", points, stroke_of(series));
      points.clear();
      before = nullptr;
    };
    for (const Point& point : series.points) {
      if (!shown(point)) {
        finish();
        continue;
      }
      const double x = x_.pixel(point[0]);
      if (series.mark == Mark::kStairs && before != nullptr) {
        points += fmt::format(" {:.1f},{:.1f}", x, y_.pixel((*before)[1]));
      }
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x, y_.pixel(point[1]));
      before = &point;
    }
    finish();
    return out;
  }

  const Panel& panel_;
  const Box& box_;
  Scale x_;
  Scale y_;
  std::vector<std::vector<const Series*>> rows_;
  double left_;
  double right_;
  double top_;
  double bottom_;
};

}  // namespace

Figure::Figure(double width, double height, std::string_view title) : width_(width), height_(height) {
  if (!title.empty()) body_ = text_at(16, 27, "start", title, " class=\"head\"");
}

void Figure::add(const Panel& panel, const Box& box) { body_ += Drawing(panel, box).draw(); }

std::string Figure::svg() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\">\n"
      "{2}<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{3}</svg>\n",
      width_, height_, kStyle, body_);
}

std::string grid_of(const std::vector<Panel>& panels, std::size_t columns, double panel_width, double panel_height) {
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  Figure figure(panel_width * static_cast<double>(columns), panel_height * static_cast<double>(rows));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    figure.add(panels[i], {panel_width * static_cast<double>(i % columns),
                           panel_height * static_cast<double>(i / columns), panel_width, panel_height});
  }
  return figure.svg();
}

const char* colour(std::size_t index) {
  // The first eight are from Okabe and Ito, "Color Universal Design"; yellow, too pale for a line on white, is
  // darkened.
  static constexpr std::array<const char*, 10> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                                        "#56b4e9", "#000000", "#b8a800", "#8c564b", "#7f7f7f"};
  return kColours[index % kColours.size()];
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        // XML allows no control characters except these three.
        if (static_cast<unsigned char>(c) >= ' ' || c == '\t' || c == '\n' || c == '\r') result += c;
    }
  }
  return result;
}

}  // namespace trammel::chart
