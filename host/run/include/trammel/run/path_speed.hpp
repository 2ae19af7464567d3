// The speed along the path over time, from the intervals between the steps of each axis. The distance of a step is
// spread over the time from half of the interval before it to half of the interval after it, so a constant speed gives
// a constant result. If one interval is more than four times the other (the axis was at rest), the shorter one replaces
// it.
// Time is divided into bins of equal width, which doubles when the run outgrows them. The axes are combined within each
// bin and a sample is the mean of kFine bins, so a sample is correct even if the direction turns within it. Not
// thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::run {

class PathSpeed {
 public:
  explicit PathSpeed(double clock_hz) : clock_hz_(clock_hz) {}
  // A step of `way` >= 0 (in the unit of the picture) on one of the first three axes. `cycle` ascends on each axis.
  void add(std::uint64_t cycle, std::size_t axis, double way);

  struct Sample {
    double seconds;
    double speed;  // mean, units/s
  };
  std::vector<Sample> samples() const;

 private:
  static constexpr std::size_t kFine = 64;
  static constexpr std::size_t kBins = 1024 * kFine;
  static constexpr std::size_t kAxes = 3;

  // A step that waits for the length of the interval after it.
  struct Waiting {
    bool any = false;
    double cycle = 0;
    double way = 0;
    double interval = 0;  // interval before the step, clocks; 0: first step of the axis
  };
  using Bins = std::vector<std::array<double, kAxes>>;

  static void spread(Bins& bins, double bin_width, const Waiting& step, std::size_t axis, double after);
  void widen(double end);

  double clock_hz_;
  double bin_width_ = 1;  // clocks
  Bins bins_ = Bins(kBins);
  std::array<Waiting, kAxes> waiting_;
};

}  // namespace trammel::run
