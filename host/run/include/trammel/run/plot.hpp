// The picture of a run: the commanded path with the pulses on it, a magnified stretch where single pulses show, and the
// speed along the path over time. An SVG under 5 MB however long the program: points are thinned as they come in.
// Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace trammel::run {

using Point = std::array<double, 3>;  // mm, the first three axes

// Keeps at most 2 * `limit` of the points it is given, evenly thinned by doubling its stride.
class ThinnedPath {
 public:
  explicit ThinnedPath(std::size_t limit) : limit_(limit) {}
  void add(const Point& point);
  // The kept points, and the very last one.
  std::vector<Point> points() const;
  std::uint64_t given() const { return given_; }
  bool thinned() const { return stride_ > 1; }

 private:
  std::size_t limit_;
  std::uint64_t stride_ = 1;
  std::uint64_t given_ = 0;
  std::vector<Point> kept_;
  Point last_{};
};

// Speed over time in bins of equal width, which doubles when the run outgrows them. A bin's speed is the root of the
// sum of squares of what each axis travelled in it: exact while the direction does not change within the bin.
class SpeedOverTime {
 public:
  explicit SpeedOverTime(double clock_hz) : clock_hz_(clock_hz) {}
  // `axis` is one of the first three; `millimetres` >= 0.
  void add(std::uint64_t cycle, std::size_t axis, double millimetres);
  struct Sample {
    double seconds;
    double speed;  // mm/s, the bin's mean
  };
  std::vector<Sample> samples() const;

 private:
  static constexpr std::size_t kBins = 1024;
  double clock_hz_;
  std::uint64_t bin_width_ = 1;  // clocks
  std::vector<Point> bins_ = std::vector<Point>(kBins, Point{});
  std::size_t used_ = 0;
};

struct Plot {
  std::string title;
  std::vector<Point> commanded;
  std::vector<Point> executed;
  bool executed_thinned = false;
  std::vector<Point> detail_commanded;  // the magnified stretch
  std::vector<Point> detail_executed;
  std::vector<SpeedOverTime::Sample> speed;
};

// The picture as SVG.
std::string svg(const Plot& plot);

}  // namespace trammel::run
