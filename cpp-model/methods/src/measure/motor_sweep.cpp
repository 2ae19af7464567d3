#include <cmath>

#include "for_each_index.hpp"
#include "trammel/measure/motor.hpp"

namespace trammel::measure {

std::vector<double> sweep_speeds() {
  std::vector<double> speeds;
  constexpr std::size_t kOctaves = 6;
  for (std::size_t i = 0; i <= kOctaves * kSpeedsAnOctave; ++i) {
    speeds.push_back(std::round(100 * std::exp2(static_cast<double>(i) / static_cast<double>(kSpeedsAnOctave))));
  }
  return speeds;
}

std::vector<std::vector<Vibration>> sweep_motors(const std::vector<Trace>& traces, const IdealCurve& curve,
                                                 const MotorRun& run, const std::vector<double>& speeds,
                                                 unsigned threads, const std::function<void(double)>& progress) {
  std::vector<std::vector<Vibration>> result(traces.size(), std::vector<Vibration>(speeds.size()));
  for_each_index(
      traces.size() * speeds.size(), threads,
      [&](std::uint64_t index) {
        // Slow speeds first, because they take the longest.
        const std::size_t speed = index / traces.size();
        const std::size_t trace = index % traces.size();
        MotorRun at_speed = run;
        at_speed.speed = speeds[speed];
        result[trace][speed] = simulate_motors(traces[trace], curve, at_speed);
      },
      progress);
  return result;
}

std::vector<SpeedRange> lost_at(const std::vector<double>& speeds, const std::vector<Vibration>& sweep) {
  std::vector<SpeedRange> ranges;
  bool before = false;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    if (sweep[i].lost_steps && !before) ranges.push_back({speeds[i], speeds[i]});
    if (sweep[i].lost_steps) ranges.back().last = speeds[i];
    before = sweep[i].lost_steps;
  }
  return ranges;
}

}  // namespace trammel::measure
