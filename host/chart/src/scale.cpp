#include "scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trammel::chart {
namespace {

// Smallest number of the form 1, 2 or 5 times a power of ten that is not below `value` > 0.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

double step_for(double span, std::size_t most) {
  double step = round_up(span / static_cast<double>(most));
  // With both ends there may be one tick more than `most` intervals have.
  while (std::floor(span / step) + 1 > static_cast<double>(most)) step = round_up(step * 1.5);
  return step;
}

std::string number(double value, double step) {
  const double size = std::max(std::fabs(value), step);
  if (size >= 1e6 || size < 1e-4) return value == 0 ? "0" : fmt::format("{:g}", value);
  const auto decimals = static_cast<int>(std::max(0.0, std::ceil(-std::log10(step) - 1e-9)));
  return fmt::format("{:.{}f}", value == 0 ? 0.0 : value, decimals);
}

}  // namespace

std::vector<double> round_ticks(double low, double high, std::size_t most) {
  const double step = step_for(high - low, most);
  // Whole multiples, so that errors do not add up. A tick that misses an end only by rounding is kept.
  const double slack = 1e-9 * (high - low) / step;
  std::vector<double> ticks;
  const double last = std::floor(high / step + slack);
  for (double k = std::ceil(low / step - slack); k <= last; ++k) ticks.push_back(k == 0 ? 0.0 : k * step);
  return ticks;
}

Scale::Scale(const Axis& axis, const std::vector<Series>& series, std::size_t index) : logarithmic_(axis.logarithmic) {
  bool first = true;
  const auto take = [&](double value) {
    if (!std::isfinite(value) || (logarithmic_ && value <= 0)) return;
    const double at = logarithmic_ ? std::log10(value) : value;
    low_ = first ? at : std::min(low_, at);
    high_ = first ? at : std::max(high_, at);
    first = false;
  };
  for (const Series& one : series) {
    for (const Point& point : one.points) take(point[index]);
  }
  if (first) high_ = low_ = logarithmic_ ? 1 : 0;
  if (axis.low) low_ = logarithmic_ ? std::log10(*axis.low) : *axis.low;
  if (axis.high) high_ = logarithmic_ ? std::log10(*axis.high) : *axis.high;
  // A single value, or no value, is in the middle of one unit.
  if (!(high_ - low_ > 1e-12 * std::max(1.0, std::fabs(high_)))) {
    low_ -= 0.5;
    high_ = low_ + 1;
  }
}

double Scale::pixel(double value) const {
  const double at = logarithmic_ ? std::log10(value) : value;
  return from_ + (to_ - from_) * (at - low_) / (high_ - low_);
}

bool Scale::shows(double value) const {
  if (!std::isfinite(value) || (logarithmic_ && value <= 0)) return false;
  const double at = logarithmic_ ? std::log10(value) : value;
  const double slack = 1e-9 * span();
  return at >= low_ - slack && at <= high_ + slack;
}

void Scale::widen(double span) {
  const double middle = (low_ + high_) / 2;
  low_ = middle - span / 2;
  high_ = middle + span / 2;
}

std::vector<Tick> Scale::ticks(std::size_t most) const {
  std::vector<Tick> ticks;
  if (!logarithmic_) {
    const std::vector<double> values = round_ticks(low_, high_, most);
    const double step = step_for(high_ - low_, most);
    for (const double value : values) ticks.push_back({value, number(value, step)});
    return ticks;
  }
  // 1, 2 and 5 of each decade while they fit, else every decade, every second one and so on.
  const double slack = 1e-9;
  const auto first = static_cast<int>(std::floor(low_ + slack));
  const auto last = static_cast<int>(std::ceil(high_ - slack));
  for (const auto& factors : {std::vector<double>{1, 2, 5}, std::vector<double>{1}}) {
    ticks.clear();
    for (int decade = first; decade <= last; ++decade) {
      for (const double factor : factors) {
        const double value = factor * std::pow(10.0, decade);
        if (shows(value)) ticks.push_back({value, fmt::format("{:g}", value)});
      }
    }
    if (ticks.size() <= most) return ticks;
  }
  const std::size_t stride = (ticks.size() + most - 1) / most;
  std::vector<Tick> fewer;
  for (std::size_t i = 0; i < ticks.size(); i += stride) fewer.push_back(ticks[i]);
  return fewer;
}

}  // namespace trammel::chart
