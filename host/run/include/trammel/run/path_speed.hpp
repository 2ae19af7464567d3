// The speed along the path over time, from the intervals between the steps of each axis. A step's way is spread from
// half of the interval before it to half of the one after it, so that a constant speed comes out constant; where one of
// the two is more than four times the other (the axis stood still), as far as the shorter one. The time is divided into
// bins of equal width, which doubles when the run outgrows them; the axes are put together in each, so a sample, which
// is the mean of kFine bins, is right where the direction turns within it. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::run {

class PathSpeed {
 public:
  explicit PathSpeed(double clock_hz) : clock_hz_(clock_hz) {}
  // A step of `way` >= 0, in the picture's unit, of one of the first three axes. Cycles ascend on each axis.
  void add(std::uint64_t cycle, std::size_t axis, double way);

  struct Sample {
    double seconds;
    double speed;  // units/s, the mean
  };
  std::vector<Sample> samples() const;

 private:
  static constexpr std::size_t kFine = 64;
  static constexpr std::size_t kBins = 1024 * kFine;
  static constexpr std::size_t kAxes = 3;

  // A step that waits for the interval after it.
  struct Waiting {
    bool any = false;
    double cycle = 0;
    double way = 0;
    double interval = 0;  // before it; 0: it is the axis's first
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
