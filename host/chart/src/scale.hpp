// The range of an axis, and the conversion of its values to pixels.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "trammel/chart/chart.hpp"

namespace trammel::chart {

struct Tick {
  double value;
  std::string text;
};

class Scale {
 public:
  // The range that `axis` gives, or else that of coordinate `index` of all points.
  Scale(const Axis& axis, const std::vector<Series>& series, std::size_t index);

  // Maps the range to the pixels from `from` to `to`.
  void place(double from, double to) {
    from_ = from;
    to_ = to;
  }
  double pixel(double value) const;
  bool shows(double value) const;

  double span() const { return high_ - low_; }
  // Sets the length of the range and keeps its middle.
  void widen(double span);

  // At most `most` ticks, whose numbers have the same number of decimals.
  std::vector<Tick> ticks(std::size_t most) const;

 private:
  bool logarithmic_;
  double low_ = 0;  // of the logarithm to base 10 if logarithmic
  double high_ = 1;
  double from_ = 0;
  double to_ = 1;
};

}  // namespace trammel::chart
