// Small pictures of curves and waveforms: panels in rows, an SVG of a few kilobytes. Thread-safe: pure functions.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace trammel::app::reproduce {

using PicturePoint = std::array<double, 2>;

struct Series {
  std::string label;  // empty: not in the legend
  std::string colour;
  std::vector<PicturePoint> points;
  double width = 1.5;
  bool dashed = false;
  bool dots = false;  // a dot at each point instead of a line
};

struct Panel {
  std::string title;
  std::vector<Series> series;
  bool equal_scale = true;  // one pulse in x is as long as one in y
};

struct Layout {
  unsigned columns = 1;
  double width = 480;  // of a panel
  double height = 360;
};

std::string draw(const std::vector<Panel>& panels, const Layout& layout);

// A waveform: high for half of the way to the next pulse, on a base line at `base`. Times ascend.
std::vector<PicturePoint> waveform(const std::vector<double>& times, double end, double base);

}  // namespace trammel::app::reproduce
