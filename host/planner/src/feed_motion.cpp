#include "feed_motion.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::planner {

FeedMotion steady(double rate, double end_rate, double ticks) {
  FeedMotion motion;
  motion.rate = rate;
  motion.end_rate = end_rate;
  motion.acceleration = (end_rate - rate) * (end_rate + rate) / (2 * ticks);
  motion.clocks = 2 * ticks / (rate + end_rate);
  return motion;
}

Rates off_rest(double rate, double end_rate, double acceleration) {
  const double rest = std::sqrt(std::abs(acceleration));
  const double most = std::max(rate, end_rate);
  const double least = most > 0 ? std::min(rest, most) : rest;
  return {std::max(rate, least), std::max(end_rate, least)};
}

double turning_rate(const FeedMotion& motion) {
  if (motion.jerk == 0) return motion.rate;
  const double time = -motion.acceleration / motion.jerk;
  if (!(time > 0 && time < motion.clocks)) return motion.rate;
  return motion.rate + motion.acceleration * time / 2;
}

FeedInstant instant(const FeedMotion& motion, double distance, double ticks) {
  const double time = time_at(distance, motion.rate, motion.acceleration, motion.jerk, motion.clocks, ticks);
  return {time, motion.rate + time * (motion.acceleration + time * motion.jerk / 2)};
}

double time_at(double distance, double speed, double acceleration, double jerk, double duration, double length) {
  if (jerk == 0) {
    const double end = std::sqrt(std::max(0.0, speed * speed + 2 * acceleration * distance));
    const double sum = speed + end;
    return sum > 0 ? 2 * distance / sum : 0;
  }
  const auto speed_at = [&](double time) { return speed + time * (acceleration + time * jerk / 2); };
  if (distance <= 0) return speed > 0 ? distance / speed : 0;
  if (distance >= length) {
    const double end = speed_at(duration);
    return duration + (end > 0 ? (distance - length) / end : 0);
  }
  double low = 0;
  double high = duration;
  double time = duration * (distance / length);
  for (int i = 0; i < 100; ++i) {
    const double rest = distance - time * (speed + time * (acceleration / 2 + time * jerk / 6));
    (rest < 0 ? high : low) = time;
    double next = time + rest / speed_at(time);
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::abs(next - time) <= 1e-15 * duration) break;
    time = next;
  }
  return time;
}

}  // namespace trammel::planner
