// The range of an axis, and how values become pixels along it.
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
  // The range of `axis`, else that of coordinate `index` of all points.
  Scale(const Axis& axis, const std::vector<Series>& series, std::size_t index);

  // From pixel `from`, where the range begins, to pixel `to`.
  void place(double from, double to) {
    from_ = from;
    to_ = to;
  }
  double pixel(double value) const;
  bool shows(double value) const;

  double span() const { return high_ - low_; }
  // Makes the range so wide, its middle where it was.
  void widen(double span);

  // At most `most` ticks with numbers of equal decimals.
  std::vector<Tick> ticks(std::size_t most) const;

 private:
  bool logarithmic_;
  double low_ = 0;  // of the logarithm to base 10 where logarithmic
  double high_ = 1;
  double from_ = 0;
  double to_ = 1;
};

}  // namespace trammel::chart
