#include "tick_fit.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::planner {
namespace {

constexpr double kMaxRounded = 0.5;  // ticks by which a stop or a corner may come before its place

bool goes_on(const Phase& phase) { return phase.acceleration * phase.next > 0; }
bool is_peak(const Phase& phase) { return phase.acceleration > 0 && phase.next < 0; }

}  // namespace

void TickFit::start(double ticks_per_clock_at_1_mm_s) {
  ticks_per_clock_at_1_mm_s_ = ticks_per_clock_at_1_mm_s;
  begin_ = end_ = lag_ = ahead_ = 0;
}

void TickFit::change_density(double ticks_per_clock_at_1_mm_s, double ahead) {
  const double change = ticks_per_clock_at_1_mm_s / ticks_per_clock_at_1_mm_s_;
  ticks_per_clock_at_1_mm_s_ = ticks_per_clock_at_1_mm_s;
  end_ *= change;
  lag_ *= change;
  ahead_ = ahead;
  lag_ += ahead;
}

// A ramp gets at least the ticks that it takes. A phase of constant speed leaves the ramp after it the ticks by which a
// stop may come too early. A peak divides the ticks that its two ramps lack between them.
double TickFit::end_tick(const Phase& phase, double exact) const {
  constexpr double kAlmost = 1e-9;
  const auto above = [](double tick) { return std::ceil(tick - kAlmost); };
  if (phase.acceleration == 0) return phase.next > 0 ? above(exact) : std::floor(exact - kMaxRounded);
  if (is_peak(phase)) {
    const double both = phase.acceleration - phase.next;
    return std::floor(exact + (phase.acceleration * lag_ + phase.next * kMaxRounded) / both);
  }
  const double late = exact + lag_;
  // The tick that contains the border has the smaller of the two accelerations.
  const bool weaker = std::abs(phase.acceleration) <= std::abs(phase.next);
  return goes_on(phase) && !weaker ? std::floor(late + kAlmost) : above(late);
}

void TickFit::advance(const Phase& phase, double to, double ticks, double late, bool through) {
  constexpr double kSame = 1e-9;  // relative difference of rates that count as equal
  constexpr double kFar = 2;      // ticks: bounds the fit where blocks have more ticks than their length
  begin_ = end_;
  const double tick = 1 / (ticks_per_clock_at_1_mm_s_ * clock_hz_);
  const auto planned = [&](double place) {
    return ticks_per_clock_at_1_mm_s_ *
           std::sqrt(std::max(0.0, phase.speed * phase.speed + 2 * phase.acceleration * place));
  };
  const double wanted = planned(to);
  if (std::abs(begin_ - wanted) <= kSame * wanted) begin_ = wanted;
  if (ticks != 0) end_ = wanted;
  const bool own = phase.acceleration != 0 && (through || goes_on(phase) || is_peak(phase));
  if (ticks != 0 && own) {
    const double one = planned(to - kFar * tick);
    const double other = planned(to + kFar * tick);
    const double square = begin_ * begin_ + 2 * of_ticks(phase.acceleration) * std::max(0.0, ticks - ahead_);
    end_ = std::clamp(std::sqrt(std::max(0.0, square)), std::min(one, other), std::max(one, other));
  }
  if (ticks != 0) ahead_ = 0;
  // At a peak the plan continues with the acceleration of the next phase.
  const double acceleration = is_peak(phase) && !through ? phase.next : phase.acceleration;
  const double gain = acceleration == 0 ? 0 : (end_ * end_ - wanted * wanted) / (2 * of_ticks(acceleration));
  lag_ = std::clamp(late - gain, -kFar, kFar) + ahead_;
}

}  // namespace trammel::planner
