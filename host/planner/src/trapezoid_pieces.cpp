#include "trapezoid_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "feed_piece.hpp"

namespace trammel::planner {
namespace {

bool same_acceleration(double a, double b) { return std::abs(a - b) <= 0.01 * std::abs(b); }

// A motion of constant acceleration that begins after `lead` ticks. By then the rate has changed as in the lead ticks
// that are not `ahead`.
FeedMotion steady_behind(double lead, double ahead, const Rates& rates, double ticks) {
  ahead = std::min(ahead, lead);
  const double begin = std::sqrt(rates.begin * rates.begin + (rates.end - rates.begin) * (rates.end + rates.begin) *
                                                                 ((lead - ahead) / (ticks - ahead)));
  return steady(begin, rates.end, ticks - lead);
}

}  // namespace

void TrapezoidPieces::start(const TickScale& scale) {
  scale_ = scale;
  fit_.start(scale.ticks_per_clock_at_1_mm_s);
}

void TrapezoidPieces::change_density(const TickScale& scale, double ahead) {
  scale_ = scale;
  fit_.change_density(scale.ticks_per_clock_at_1_mm_s, ahead);
}

void TrapezoidPieces::advance(const Phase& phase, const PhasePart& part, double late) {
  fit_.advance(phase, part.end, static_cast<double>(part.ticks), late, part.through);
}

FeedMotion TrapezoidPieces::motion(const Phase& phase, const PhasePart& part, double lead, double ahead) const {
  const double acceleration = std::abs(phase.acceleration) * scale_.ticks_per_clock_at_1_mm_s / scale_.clock_hz;
  const Rates rates = off_rest(fit_.rate(), fit_.end_rate(), acceleration);
  return steady_behind(lead, ahead, rates, static_cast<double>(part.ticks));
}

double TrapezoidPieces::pending_rate(const Phase& phase, const PhasePart& part, const FeedMotion& /*motion*/) const {
  return motion(phase, part, 0, 0).rate;
}

bool TrapezoidPieces::keeps_apart(const Pending& pending, const Phase& phase) const {
  return pending.acceleration * phase.acceleration > 0 &&
         !same_acceleration(pending.acceleration, phase.acceleration) && pending.motion.clocks >= kUpdate;
}

FeedMotion TrapezoidPieces::joined(const Pending& pending, double ticks, const Lead& lead) const {
  return steady_behind(lead.within(ticks), lead.ahead, {pending.motion.rate, pending.motion.end_rate}, ticks);
}

}  // namespace trammel::planner
