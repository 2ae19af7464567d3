#include "speed_plan_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trammel::test {
namespace {

constexpr double kPart = 1e-9;    // relative tolerance of a limit
constexpr double kSpeed = 1e-5;   // mm/s; the speed at 1e-12 mm from a stop
constexpr double kLength = 1e-8;  // mm
constexpr double kTouch = 1e-9;   // mm; a smaller part of a phase in a span is rounding
constexpr int kLooks = 16;        // samples per phase in a span

double length_at(const Phase& phase, double time) {
  return ((phase.jerk / 6 * time + phase.acceleration / 2) * time + phase.speed) * time;
}
double speed_at(const Phase& phase, double time) {
  return (phase.jerk / 2 * time + phase.acceleration) * time + phase.speed;
}
double acceleration_at(const Phase& phase, double time) { return phase.jerk * time + phase.acceleration; }

// Time at which `length` of the phase is done, by bisection.
double time_at(const Phase& phase, double length) {
  double low = 0;
  double high = phase.duration;
  for (int i = 0; i < 100 && low < high; ++i) {
    const double middle = (low + high) / 2;
    (length_at(phase, middle) < length ? low : high) = middle;
  }
  return high;
}

class Judge {
 public:
  Judge(const std::vector<Span>& spans, bool jumps) : spans_(spans), jumps_(jumps) {}

  std::string fault(const std::vector<Phase>& phases) {
    left_ = spans_.front().length;
    for (const Phase& phase : phases) {
      if (!take(phase)) return fault_;
    }
    if (span_ + 1 != spans_.size() || std::abs(left_) > kLength)
      return fmt::format("ends in span {}, {} early", span_, left_);
    if (speed_ > kSpeed) return fmt::format("ends at {} mm/s", speed_);
    return {};
  }

 private:
  bool expect(bool good, const char* what, double is, double most) {
    if (!good && fault_.empty())
      fault_ = fmt::format("{} {} where {} is wanted, {} before the end of span {}", what, is, most, left_, span_);
    return good;
  }

  bool take(const Phase& phase) {
    const double end = length_at(phase, phase.duration);
    if (!expect(phase.length > 0 && phase.duration > 0, "empty phase", phase.length, 0)) return false;
    if (!expect(std::abs(phase.speed - speed_) <= kPart * speed_ + kSpeed, "speed jumps to", phase.speed, speed_))
      return false;
    const double acceleration = phase.acceleration;
    if (!expect(jumps_ || std::abs(acceleration - acceleration_) <= 1e-6 * std::abs(acceleration_) + 1e-6,
                "acceleration jumps to", acceleration, acceleration_)) {
      return false;
    }
    if (!expect(std::abs(end - phase.length) <= kLength, "length", end, phase.length)) return false;
    double done = 0;
    double time = 0;
    while (true) {
      const double left = left_;
      const bool ends = phase.length - done <= left + kTouch || span_ + 1 == spans_.size();
      const double part = ends ? phase.length - done : left;
      const double until = ends ? phase.duration : time_at(phase, done + part);
      if (part > kTouch && !within(phase, time, until)) return false;
      done += part;
      left_ -= part;
      time = until;
      if (ends) break;
      if (!leave(speed_at(phase, time))) return false;
    }
    speed_ = speed_at(phase, phase.duration);
    acceleration_ = acceleration_at(phase, phase.duration);
    if (span_ + 1 < spans_.size() && left_ <= kTouch) return leave(speed_);
    return true;
  }

  bool leave(double speed) {
    const double most = spans_[span_].exit_speed;
    if (!expect(speed <= most * (1 + kPart) + kSpeed, "speed at the end", speed, most)) return false;
    left_ += spans_[++span_].length;
    return true;
  }

  bool within(const Phase& phase, double begin, double end) {
    const Span& span = spans_[span_];
    double top = std::max(speed_at(phase, begin), speed_at(phase, end));
    double least = std::min(speed_at(phase, begin), speed_at(phase, end));
    const double still = phase.jerk == 0 ? -1 : -phase.acceleration / phase.jerk;
    if (still > begin && still < end) {
      top = std::max(top, speed_at(phase, still));
      least = std::min(least, speed_at(phase, still));
    }
    return within_acceleration(phase, begin, end) &&
           expect(top <= span.speed * (1 + kPart) + kSpeed, "speed", top, span.speed) &&
           expect(least >= -kSpeed, "speed", least, 0) && within_jerk(phase, begin, end);
  }

  // On an arc the limit applies to the jerk along the path and across it, by the speed and the acceleration at each
  // sample.
  bool within_jerk(const Phase& phase, double begin, double end) {
    const Span& span = spans_[span_];
    const planner::Curve& curve = span.curve;
    const double jerk = std::abs(phase.jerk);
    const double most = std::max(span.jerk, curve.jerk_at_rest);
    if (!expect(jerk <= most * (1 + kPart), "jerk", jerk, most)) return false;
    if (curve.whole == 0 || std::isinf(curve.jerk)) return true;
    for (int i = 0; i <= kLooks; ++i) {
      const double time = begin + (end - begin) * i / kLooks;
      const double turn = curve.turning * speed_at(phase, time);
      const double across = 3 * turn * acceleration_at(phase, time);
      const double both = std::hypot(jerk + turn * turn * speed_at(phase, time), across);
      if (!expect(both <= curve.jerk * (1 + kPart), "jerk in all", both, curve.jerk)) return false;
    }
    return true;
  }

  // On an arc the limit depends on the speed at each sample.
  bool within_acceleration(const Phase& phase, double begin, double end) {
    const Span& span = spans_[span_];
    for (int i = 0; i <= kLooks; ++i) {
      const double time = begin + (end - begin) * i / kLooks;
      double most = span.acceleration;
      if (span.curve.whole > 0) {
        const double speed = speed_at(phase, time);
        const double across = span.curve.turning * speed * speed;
        const double left = std::sqrt(std::max(0.0, span.curve.whole * span.curve.whole - across * across));
        most = std::max(most, std::min(left, span.curve.at_rest));
      }
      const double acceleration = std::abs(acceleration_at(phase, time));
      if (!expect(acceleration <= most * (1 + kPart), "acceleration", acceleration, most)) return false;
    }
    return true;
  }

  const std::vector<Span>& spans_;
  bool jumps_;
  std::size_t span_ = 0;
  double left_ = 0;  // remaining length of the span, mm
  double speed_ = 0;
  double acceleration_ = 0;
  std::string fault_;
};

}  // namespace

std::vector<Phase> plan_all(SpeedPlan& plan, const std::vector<Span>& spans) {
  std::vector<Phase> phases;
  Phase phase;
  const auto take = [&] {
    while (plan.next(phase)) phases.push_back(phase);
  };
  for (const Span& span : spans) {
    if (plan.full()) take();
    plan.push(span);
  }
  plan.finish();
  take();
  return phases;
}

double duration_of(const std::vector<Phase>& phases) {
  double sum = 0;
  for (const Phase& phase : phases) sum += phase.duration;
  return sum;
}

std::string fault_of(const std::vector<Phase>& phases, const std::vector<Span>& spans, bool jumps) {
  return Judge(spans, jumps).fault(phases);
}

Trapezoid trapezoid_of(const std::vector<Span>& spans) {
  std::vector<double> squared(spans.size() + 1, 0.0);  // square of the speed at each border
  for (std::size_t i = spans.size() - 1; i > 0; --i) {
    const double corner = std::min({spans[i - 1].exit_speed, spans[i - 1].speed, spans[i].speed});
    squared[i] = std::min(corner * corner, squared[i + 1] + 2 * spans[i].acceleration * spans[i].length);
  }
  for (std::size_t i = 0; i + 1 < spans.size(); ++i) {
    squared[i + 1] = std::min(squared[i + 1], squared[i] + 2 * spans[i].acceleration * spans[i].length);
  }
  Trapezoid plan;
  int direction = 0;
  double most = 0;
  double least = 0;
  const auto add = [&](const Span& span, int sign, double from, double to) {
    const double change = std::abs(to - from);
    const double length = (to - from) * (to + from) / (2 * sign * span.acceleration);
    if (!(length > 1e-12) || !(change > 0)) return;
    plan.phases.push_back({length, change / span.acceleration, from, sign * span.acceleration, 0});
    if (sign != direction) plan.bends += least > 0 ? most / least : 0;
    if (sign != direction) most = 0, least = span.jerk, direction = sign;
    most = std::max(most, span.acceleration);
    least = std::min(least, span.jerk);
  };
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const Span& span = spans[i];
    const double peak = span.acceleration * span.length + (squared[i] + squared[i + 1]) / 2;
    const double from = std::sqrt(squared[i]);
    const double to = std::sqrt(squared[i + 1]);
    const double top = std::max({std::min(std::sqrt(peak), span.speed), from, to});
    add(span, 1, from, top);
    const double twice = 2 * span.acceleration;
    const double steady = span.length - (top * top - squared[i]) / twice - (top * top - squared[i + 1]) / twice;
    if (steady > 1e-9 * span.length) {
      plan.phases.push_back({steady, steady / top, top, 0, 0});
      if (direction != 0 && least > 0) plan.bends += most / least;
      direction = 0, least = 0;
    }
    add(span, -1, top, to);
  }
  plan.bends += least > 0 ? most / least : 0;
  plan.duration = duration_of(plan.phases);
  return plan;
}

}  // namespace trammel::test
