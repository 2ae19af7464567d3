#include "trammel/model/measure/evenness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trammel::model::measure {
namespace {

constexpr double kTurn = 6.283185307179586476925;

// Line: the deviations are linear in the intervals, so integers do, and one division at the end.
Evenness line_evenness(const Trace& trace, double pulses, std::size_t axis) {
  std::uint64_t shortest = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t longest = 0;
  std::uint64_t last = 0;
  std::size_t count = 0;
  double sum = 0;
  double squares = 0;
  for (const Event& event : trace.events()) {
    if (event.direction[axis] == 0) continue;
    if (count++ > 0) {
      const std::uint64_t interval = event.time - last;
      shortest = std::min(shortest, interval);
      longest = std::max(longest, interval);
      const auto value = static_cast<double>(interval);
      sum += value;
      squares += value * value;
    }
    last = event.time;
  }
  if (count < 2) return {};
  const auto intervals = static_cast<double>(count - 1);
  const double scale = pulses / static_cast<double>(trace.total_time());
  const double mean_square = (squares * scale * scale - 2 * sum * scale) / intervals + 1;
  Evenness result;
  result.intervals = count - 1;
  result.largest = std::max(static_cast<double>(longest) * scale - 1, 1 - static_cast<double>(shortest) * scale);
  result.rms = std::sqrt(std::max(0.0, mean_square));
  return result;
}

// The speed of each axis in the interval that ends at each event, pulses a time unit; not a number where none ends.
class AxisSpeeds {
 public:
  explicit AxisSpeeds(const Trace& trace) : axes_(trace.axes()), from_(0), to_(trace.total_time()) {
    const std::vector<Event>& events = trace.events();
    speeds_.resize(events.size() * kTraceAxes);
    for (std::size_t a = 0; a < axes_; ++a) {
      int direction = 0;
      std::uint64_t last = 0;
      std::uint64_t first = 0;
      std::size_t count = 0;
      for (std::size_t i = 0; i < events.size(); ++i) {
        const int now = events[i].direction[a];
        if (now == 0) continue;
        if (count++ > 0) {
          speeds_[i * kTraceAxes + a] = 0.5 * (direction + now) / static_cast<double>(events[i].time - last);
        } else {
          first = events[i].time;
        }
        direction = now;
        last = events[i].time;
      }
      moves_[a] = count >= 2;
      if (!moves_[a]) continue;
      from_ = std::max(from_, first);
      to_ = std::min(to_, last);
    }
  }
  bool moves(std::size_t axis) const { return moves_[axis]; }
  double ending_at(std::size_t event, std::size_t axis) const { return speeds_[event * kTraceAxes + axis]; }
  std::uint64_t from() const { return from_; }
  std::uint64_t to() const { return to_; }

 private:
  std::size_t axes_;
  std::uint64_t from_;
  std::uint64_t to_;
  std::array<bool, kTraceAxes> moves_{};
  std::vector<double> speeds_;
};

}  // namespace

std::vector<double> interval_deviations(const Trace& trace, const IdealCurve& curve, std::size_t axis) {
  std::vector<double> result;
  const auto total = static_cast<double>(trace.total_time());
  int direction = 0;
  double last = 0;
  for (const Event& event : trace.events()) {
    if (event.direction[axis] == 0) continue;
    const double now = curve.at(static_cast<double>(event.time) / total)[axis];
    if (direction == event.direction[axis]) result.push_back((now - last) * direction - 1);
    direction = event.direction[axis];
    last = now;
  }
  return result;
}

Evenness measure_evenness(const Trace& trace, const IdealCurve& curve, std::size_t axis) {
  if (curve.is_line()) return line_evenness(trace, std::abs(curve.displacement()[axis]), axis);
  const std::vector<double> deviations = interval_deviations(trace, curve, axis);
  if (deviations.empty()) return {};
  Evenness result;
  double squares = 0;
  for (const double deviation : deviations) {
    result.largest = std::max(result.largest, std::abs(deviation));
    squares += deviation * deviation;
  }
  result.intervals = deviations.size();
  result.rms = std::sqrt(squares / static_cast<double>(deviations.size()));
  return result;
}

std::vector<SpectrumLine> interval_spectrum(const std::vector<double>& deviations, std::size_t limit) {
  const std::size_t n = std::min(deviations.size(), limit);
  std::vector<SpectrumLine> spectrum;
  for (std::size_t k = 1; k <= n / 2; ++k) {
    const double angle = kTurn * static_cast<double>(k) / static_cast<double>(n);
    const double twice_cosine = 2 * std::cos(angle);
    double one_back = 0;
    double two_back = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double value = deviations[i] + twice_cosine * one_back - two_back;
      two_back = one_back;
      one_back = value;
    }
    const double power = one_back * one_back + two_back * two_back - twice_cosine * one_back * two_back;
    const double weight = 2 * k == n ? 1 : 2;
    spectrum.push_back({static_cast<double>(k) / static_cast<double>(n),
                        weight / static_cast<double>(n) * std::sqrt(std::max(0.0, power))});
  }
  return spectrum;
}

SpectrumLine highest_line(const std::vector<SpectrumLine>& spectrum) {
  SpectrumLine highest;
  for (const SpectrumLine& line : spectrum) {
    if (line.amplitude > highest.amplitude) highest = line;
  }
  return highest;
}

Ripple measure_speed_ripple(const Trace& trace, const IdealCurve& curve) {
  const std::vector<Event>& events = trace.events();
  const AxisSpeeds speeds(trace);
  if (events.empty() || speeds.to() <= speeds.from()) return {};
  const auto total = static_cast<double>(trace.total_time());
  const double mean_speed = curve.length() / total;
  Vector tangent = curve.tangent(0);
  Vector speed{};
  double along = 0;
  double squares = 0;
  double duration = 0;
  double largest = 0;
  // Backwards, because an interval's speed is known at the event that ends it.
  for (std::size_t i = events.size(); i-- > 1;) {
    const std::uint64_t time = events[i].time;
    for (std::size_t a = 0; a < trace.axes(); ++a) {
      if (events[i].direction[a] != 0) speed[a] = speeds.ending_at(i, a);
    }
    const std::uint64_t before = events[i - 1].time;
    if (time > speeds.to() || before < speeds.from()) continue;
    if (!curve.is_line()) tangent = curve.tangent(0.5 * static_cast<double>(time + before) / total);
    along = 0;
    for (std::size_t a = 0; a < trace.axes(); ++a) {
      along += speeds.moves(a) ? speed[a] * tangent[a] : tangent[a] * tangent[a] * mean_speed;
    }
    const double ripple = along / mean_speed - 1;
    const auto width = static_cast<double>(time - before);
    squares += width * ripple * ripple;
    duration += width;
    largest = std::max(largest, std::abs(ripple));
  }
  return {std::sqrt(squares / duration), largest};
}

}  // namespace trammel::model::measure
