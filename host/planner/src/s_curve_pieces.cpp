#include "s_curve_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "feed_piece.hpp"
#include "roots.hpp"

namespace trammel::planner {
namespace {

constexpr double kSteady = 1e-5;  // a smaller relative change of a rate counts as none
constexpr double kRest = 1e-6;    // mm/s

// The first tick from rest under a jerk j: s = j t^3 / 6 = 1 and v = j t^2 / 2 give v^3 = 9/2 j, and t = 3 / v.
constexpr double kCubeOfFloor = 4.5;
constexpr double kTimeOfLastTick = 3;

double end_acceleration(const Phase& phase) { return phase.acceleration + phase.duration * phase.jerk; }

// Far outside its phase a jerk gives wrong rates, which would end the feed before the ticks end.
bool rate_off_by_half(double rate, double right) { return std::abs(rate - right) > right / 2; }

// A part that begins or ends outside its phase by a fraction of a tick has more acceleration there than the phase has.
// Limited to `most`, it makes the same ticks between the same rates, with a little less acceleration at its other end.
void keep_within(double most, double ticks, FeedMotion& motion) {
  const double begin = motion.acceleration;
  const double end = begin + motion.clocks * motion.jerk;
  if (std::abs(begin) <= most && std::abs(end) <= most) return;
  const bool first = std::abs(begin) > std::abs(end);
  const double kept = first ? std::copysign(most, begin) : std::copysign(most, end);
  // ticks = (rate + gain / 3) t + begin t^2 / 6, and the same seen from the end.
  const double linear = first ? (2 * motion.rate + motion.end_rate) / 3 : (motion.rate + 2 * motion.end_rate) / 3;
  const double square = linear * linear + (first ? kept : -kept) * ticks * 2 / 3;
  if (!(square > 0)) return;
  const double clocks = 2 * ticks / (linear + std::sqrt(square));
  const double other = 2 * (motion.end_rate - motion.rate) / clocks - kept;
  const double jerk = (first ? other - kept : kept - other) / clocks;
  if (std::abs(other) > most || std::abs(jerk) > std::abs(motion.jerk)) return;
  motion.acceleration = first ? kept : other;
  motion.jerk = jerk;
  motion.clocks = clocks;
}

// Begins at the rate at which the stop before ended, and keeps the end rate, with the jerk that gives the ticks. A
// little less acceleration at the end keeps the jerk below the planned one. Unchanged if there are too few ticks.
void begin_at(double rate, double ticks, FeedMotion& motion) {
  constexpr double kLess = 0.001;
  const double gain = motion.end_rate - rate;
  double acceleration = motion.acceleration + motion.clocks * motion.jerk;
  // ticks = (rate + gain / 2) t - (acceleration t - gain) t / 6
  const double linear = rate + gain * 2 / 3;
  for (int i = 0; i < 9; ++i, acceleration *= 1 - kLess) {
    const double square = linear * linear - acceleration * ticks * 2 / 3;
    if (!(gain > 0) || !(square > 0)) return;
    const double clocks = 2 * ticks / (linear + std::sqrt(square));
    const double jerk = 2 * (acceleration - gain / clocks) / clocks;
    if (jerk > motion.jerk) continue;
    motion = {rate, acceleration - jerk * clocks, jerk, clocks, motion.end_rate};
    return;
  }
}

// At the planned rates, the tick next to rest would take three times as long as at the floor. It is made at the floor.
void keep_off_rest(bool rests, bool rested, double ticks, FeedMotion& motion) {
  const double floor = cube_root(kCubeOfFloor * std::abs(motion.jerk));
  motion.rests = rests;
  if (rests) {
    motion.end_rate = std::max(motion.end_rate, floor);
    motion.clocks = std::max(motion.clocks - (kTimeOfLastTick - 1) / floor, ticks / std::max(motion.rate, floor));
  } else if (rested && motion.rate < floor) {
    begin_at(floor, ticks, motion);
  }
}

}  // namespace

// In the tick in which a ramp reaches its full acceleration from rest, or leaves it for a stop, the ramp has less than
// the full acceleration.
double SCurvePieces::end_tick(const Phase& phase, double exact) const {
  constexpr double kAlmost = 1e-9;
  if (phase.acceleration >= 0 && phase.jerk > 0) return exact + kAlmost;
  if (phase.jerk <= 0 && end_acceleration(phase) < 0) return std::ceil(exact - kAlmost);
  return exact + 0.5;
}

// Pending phases of less than two updates on a ramp get no piece of their own: the next piece begins earlier.
bool SCurvePieces::drops(const Pending& pending) const {
  const double change = std::abs(pending.motion.end_rate - pending.motion.rate);
  return pending.motion.clocks < 2 * kUpdate && change > kSteady * pending.motion.rate;
}

FeedMotion SCurvePieces::motion(const Phase& phase, const PhasePart& part, double lead, double /*ahead*/) const {
  const double from = part.from + lead / (scale_.ticks_per_clock_at_1_mm_s * scale_.clock_hz);
  const double ticks = static_cast<double>(part.ticks) - lead;
  return phase.jerk == 0 ? even(phase, from, part.to, ticks) : bent(phase, part, from, ticks);
}

// The motion of a phase without jerk.
FeedMotion SCurvePieces::even(const Phase& phase, double from, double to, double ticks) const {
  const double per_speed = scale_.ticks_per_clock_at_1_mm_s;
  const auto rate_at = [&](double place) {
    return per_speed * std::sqrt(std::max(0.0, phase.speed * phase.speed + 2 * phase.acceleration * place));
  };
  const double acceleration = std::abs(phase.acceleration) * per_speed / scale_.clock_hz;
  const Rates rates = off_rest(rate_at(std::min(from, to)), rate_at(to), acceleration);
  return steady(rates.begin, rates.end, ticks);
}

// The motion of a phase with jerk, from `from` on.
FeedMotion SCurvePieces::bent(const Phase& phase, const PhasePart& part, double from, double ticks) const {
  const double per_speed = scale_.ticks_per_clock_at_1_mm_s;
  const double clock_hz = scale_.clock_hz;
  // A stop in mid path, which a window that is too short causes, is also at a whole tick: the fraction of a tick next
  // to it would take as long as thousands of updates.
  const double tick = 1 / (per_speed * clock_hz);
  const bool rests = part.stop || (part.to > phase.length - tick && end_speed(phase) < kRest);
  const bool rested = phase.speed == 0 && part.turns && from < tick;
  const auto when = [&](double place) {
    return time_at(place, phase.speed, phase.acceleration, phase.jerk, phase.duration, phase.length);
  };
  const auto rate_at = [&](double time) {
    return std::max(0.0, phase.speed + time * (phase.acceleration + time * phase.jerk / 2)) * per_speed;
  };
  double begin = rested ? 0 : when(from);
  const double end = rests ? phase.duration : when(part.to);
  FeedMotion motion;
  motion.rate = rate_at(begin);
  motion.end_rate = rate_at(end);
  const double right_end = end_speed(phase) * per_speed;
  if (!rests && end > phase.duration && rate_off_by_half(motion.end_rate, right_end)) {
    return steady(phase.speed * per_speed, right_end, ticks);
  }
  if (begin < 0 && rate_off_by_half(motion.rate, phase.speed * per_speed)) {
    begin = 0;
    motion.rate = rate_at(begin);
  }
  motion.acceleration = (phase.acceleration + begin * phase.jerk) * per_speed / clock_hz;
  motion.jerk = phase.jerk * per_speed / clock_hz / clock_hz;
  motion.clocks = (end - begin) * clock_hz;
  const double most = std::max(std::abs(phase.acceleration), std::abs(end_acceleration(phase)));
  if (!rests && !rested) keep_within(most * per_speed / clock_hz, ticks, motion);
  keep_off_rest(rests, rested, ticks, motion);
  return motion;
}

FeedMotion SCurvePieces::joined(const Pending& pending, double ticks, const Lead& lead) const {
  return steady(pending.motion.rate, pending.motion.end_rate, ticks - lead.within(ticks));
}

}  // namespace trammel::planner
