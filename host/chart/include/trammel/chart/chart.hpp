// Charts as SVG: panels whose axes have round ticks, labels and units, with a legend above the data. All pictures of
// the `trammel` command are drawn here. The same input gives the same bytes. Thread-safe: no shared state; a Figure
// must be used by one thread at a time. No errors: points that are not finite are left out, and a panel without data is
// an empty frame.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trammel::chart {

using Point = std::array<double, 2>;

enum class Mark {
  kLine,
  kStairs,   // each value is held until the next point
  kDots,     // a dot at each point, `width` its radius
  kCircles,  // the same, hollow
  kCrosses,  // a cross at each point, `width` half its size
};

struct Series {
  std::string label;  // in the legend; empty: no entry
  std::string colour;
  std::vector<Point> points;
  Mark mark = Mark::kLine;
  double width = 1.5;  // pixels
  bool dashed = false;
};

struct Axis {
  std::string label;  // quantity and unit, such as "speed, mm/s"
  bool logarithmic = false;
  bool numbers = true;  // false: neither ticks nor grid
  // The range; without a value, that of the data.
  std::optional<double> low = std::nullopt;
  std::optional<double> high = std::nullopt;
};

struct Panel {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
  bool equal_scale = false;  // one unit is as long in x as in y; for linear axes
  bool legend = true;
};

// Pixels from the upper left corner.
struct Box {
  double left;
  double top;
  double width;
  double height;
};

class Figure {
 public:
  Figure(double width, double height, std::string_view title = {});

  // Draws the panel, its labels and legend included, into the box.
  void add(const Panel& panel, const Box& box);

  std::string svg() const;

 private:
  double width_;
  double height_;
  std::string body_;
};

// Panels of one size in rows.
std::string grid_of(const std::vector<Panel>& panels, std::size_t columns, double panel_width, double panel_height);

// Ten colours that differ clearly on white, the first eight also for the colour-blind. They repeat after the tenth.
const char* colour(std::size_t index);

// 1, 2 or 5 times a power of ten, from the first at or above `low` to the last at or below `high`, at most `most` of
// them (most >= 2). Precondition: low < high, both finite.
std::vector<double> round_ticks(double low, double high, std::size_t most);

// Escaped for the text of an XML document.
std::string escaped(std::string_view text);

}  // namespace trammel::chart
