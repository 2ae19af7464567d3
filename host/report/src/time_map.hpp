// Maps the card's clock to the motion clock by a few points. Straight lines between them are within kTolerance clocks
// of every given point. Overrides, holds and late hosts show as changes of slope. Not thread-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace trammel::report {

class TimeMap {
 public:
  struct Point {
    std::uint64_t motion = 0;  // clocks
    std::uint64_t cycle = 0;   // clock of the card
    bool first = false;        // first point of a stretch: the motion clock was stopped before it
    std::uint64_t begin = 0;   // for `first`: the value at which the motion clock was stopped
  };
  static constexpr double kTolerance = 3;

  // Points must ascend. Calls keep(point) for each point that is kept.
  template <typename Keep>
  void add(const Point& point, const Keep& keep) {
    if (point.first || !last_) {
      flush(keep);
      keep(point);
      kept_ = point;
      last_ = point;
      open();
      return;
    }
    if (point.cycle <= last_->cycle || point.motion < last_->motion) return;
    if (!fits(point)) {
      keep(*last_);
      kept_ = *last_;
      open();
    }
    narrow(point);
    last_ = point;
  }
  template <typename Keep>
  void flush(const Keep& keep) {
    if (last_ && last_->cycle > kept_.cycle) keep(*last_);
    last_.reset();
  }

 private:
  double cycles(const Point& point) const { return static_cast<double>(point.cycle - kept_.cycle); }
  double motion(const Point& point) const { return static_cast<double>(point.motion - kept_.motion); }
  void open() {
    least_ = -INFINITY;
    most_ = INFINITY;
  }
  // Whether the line from the last kept point to this one is within the tolerance of all points between.
  bool fits(const Point& point) const {
    const double slope = motion(point) / cycles(point);
    return slope >= least_ && slope <= most_;
  }
  void narrow(const Point& point) {
    least_ = std::max(least_, (motion(point) - kTolerance) / cycles(point));
    most_ = std::min(most_, (motion(point) + kTolerance) / cycles(point));
  }

  Point kept_;
  std::optional<Point> last_;
  double least_ = 0;
  double most_ = 0;
};

}  // namespace trammel::report
