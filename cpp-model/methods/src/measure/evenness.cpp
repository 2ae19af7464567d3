#include "trammel/measure/evenness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numbers.hpp"

namespace trammel::measure {
namespace {

// Lines: the deviations are linear in the intervals, so integers and one final division are enough.
Evenness line_evenness(const Trace& trace, double pulses, std::size_t axis) {
  const std::vector<std::uint64_t>& times = trace.times(axis);
  if (times.size() < 2) return {};
  std::uint64_t shortest = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t longest = 0;
  double squares = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const std::uint64_t interval = times[i] - times[i - 1];
    shortest = std::min(shortest, interval);
    longest = std::max(longest, interval);
    squares += as_double(interval) * as_double(interval);
  }
  const double sum = as_double(times.back() - times.front());
  const auto intervals = static_cast<double>(times.size() - 1);
  const double scale = pulses / as_double(trace.total_time());
  const double mean_square = (squares * scale * scale - 2 * sum * scale) / intervals + 1;
  Evenness result;
  result.intervals = times.size() - 1;
  result.largest = std::max(as_double(longest) * scale - 1, 1 - as_double(shortest) * scale);
  result.rms = std::sqrt(std::max(0.0, mean_square));
  return result;
}

// The speed of each axis between its pulses, in pulses per time unit, and the period in which all moving axes have
// one.
class AxisSpeeds {
 public:
  explicit AxisSpeeds(const Trace& trace) : to_(trace.total_time()) {
    for (std::size_t a = 0; a < trace.axes(); ++a) {
      const std::vector<std::uint64_t>& times = trace.times(a);
      // speeds_[a][k]: from the k-th pulse to the next one. The two ends are never used.
      speeds_[a].assign(times.size() + 1, 0);
      for (std::size_t k = 1; k < times.size(); ++k) speeds_[a][k] = 1 / as_double(times[k] - times[k - 1]);
      if (times.size() < 2) continue;
      from_ = std::max(from_, times.front());
      to_ = std::min(to_, times.back());
    }
  }
  // Gives the axis's pulses their directions. Lines do not need this, because their axes never reverse.
  void turn(const Trace& trace, std::size_t axis) {
    int last = 0;
    std::size_t k = 0;
    for (const Event& event : trace.events()) {
      const int now = event.direction[axis];
      if (now == 0) continue;
      speeds_[axis][k++] *= 0.5 * (last + now);
      last = now;
    }
  }
  const std::vector<double>& of(std::size_t axis) const { return speeds_[axis]; }
  bool moves(std::size_t axis) const { return speeds_[axis].size() > 2; }
  std::uint64_t from() const { return from_; }
  std::uint64_t to() const { return to_; }

 private:
  std::uint64_t from_ = 0;
  std::uint64_t to_;
  std::array<std::vector<double>, kTraceAxes> speeds_;
};

// The events from the one at `from` to the one before `to`. Each begins a period of constant speed.
struct Stretches {
  std::size_t begin = 0;
  std::size_t end = 0;
};

Stretches stretches_of(const std::vector<Event>& events, const AxisSpeeds& speeds) {
  const auto earlier = [](const Event& event, std::uint64_t time) { return event.time < time; };
  const auto from = std::lower_bound(events.begin(), events.end(), speeds.from(), earlier);
  const auto to = std::lower_bound(from, events.end(), speeds.to(), earlier);
  return {static_cast<std::size_t>(from - events.begin()), static_cast<std::size_t>(to - events.begin())};
}

class RippleSum {
 public:
  void add(double ripple, double width) {
    const double size = std::abs(ripple);
    largest_ = largest_ < size ? size : largest_;
    squares_ += width * ripple * ripple;
    duration_ += width;
  }
  Ripple ripple() const { return duration_ > 0 ? Ripple{std::sqrt(squares_ / duration_), largest_} : Ripple{}; }

 private:
  double largest_ = 0;
  double squares_ = 0;
  double duration_ = 0;
};

// Two axes, without a branch per event: the fast path for a million random lines.
Ripple plane_line_ripple(const Trace& trace, const IdealCurve& curve, const AxisSpeeds& speeds) {
  const std::vector<Event>& events = trace.events();
  const Stretches stretches = stretches_of(events, speeds);
  const double to_relative = as_double(trace.total_time()) / curve.length();
  std::array<double, 2> weight{};
  double still = -1;
  for (std::size_t a = 0; a < 2; ++a) {
    const double cosine = std::abs(curve.tangent(0)[a]);
    if (speeds.moves(a)) {
      weight[a] = cosine * to_relative;
    } else {
      still += cosine * cosine;
    }
  }
  const double* x = speeds.of(0).data();
  const double* y = speeds.of(1).data();
  for (std::size_t i = 0; i < stretches.begin; ++i) {
    x += events[i].direction[0] != 0 ? 1 : 0;
    y += events[i].direction[1] != 0 ? 1 : 0;
  }
  RippleSum sum;
  for (std::size_t i = stretches.begin; i < stretches.end; ++i) {
    x += events[i].direction[0] != 0 ? 1 : 0;
    y += events[i].direction[1] != 0 ? 1 : 0;
    sum.add(still + *x * weight[0] + *y * weight[1], as_double(events[i + 1].time - events[i].time));
  }
  return sum.ripple();
}

Ripple general_ripple(const Trace& trace, const IdealCurve& curve, AxisSpeeds& speeds) {
  const std::vector<Event>& events = trace.events();
  const Stretches stretches = stretches_of(events, speeds);
  for (std::size_t a = 0; a < trace.axes(); ++a) speeds.turn(trace, a);
  const double total = as_double(trace.total_time());
  const double mean_speed = curve.length() / total;
  std::array<std::size_t, kTraceAxes> made{};
  RippleSum sum;
  for (std::size_t i = 0; i < stretches.end; ++i) {
    for (std::size_t a = 0; a < trace.axes(); ++a) made[a] += events[i].direction[a] != 0 ? 1U : 0U;
    if (i < stretches.begin) continue;
    const Vector tangent = curve.tangent(0.5 * as_double(events[i].time + events[i + 1].time) / total);
    double along = 0;
    for (std::size_t a = 0; a < trace.axes(); ++a) {
      along += speeds.moves(a) ? speeds.of(a)[made[a]] * tangent[a] : tangent[a] * tangent[a] * mean_speed;
    }
    sum.add(along / mean_speed - 1, as_double(events[i + 1].time - events[i].time));
  }
  return sum.ripple();
}

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
  if (trace.events().empty()) return {};
  AxisSpeeds speeds(trace);
  if (speeds.to() <= speeds.from()) return {};
  if (curve.is_line() && trace.axes() == 2) return plane_line_ripple(trace, curve, speeds);
  return general_ripple(trace, curve, speeds);
}

}  // namespace trammel::measure
