// Compares the pulses of a simulated card with the trajectory that it followed.
#include <algorithm>
#include <cstdio>

#include "trajectory.hpp"

namespace trajectory {
namespace {

int failed_checks = 0;

template <typename... Values>
void check(bool holds, const char* text, Values... values) {
  if (holds) return;
  ++failed_checks;
  std::fputs("check failed: ", stderr);
  std::fprintf(stderr, text, values...);
  std::fputc('\n', stderr);
}

// Position of a joint at a clock, from the steps of the path.
double position(const Record& record, unsigned joint, double cycle) {
  std::int64_t sum = 0;
  for (const PathStep& step : record.path) {
    if (step.axis == joint && static_cast<double>(step.cycle) <= cycle) sum += step.direction;
  }
  return static_cast<double>(sum);
}

// The clock at which the trajectory began, from the first step's command number and tick. A tick takes two clocks. The
// FEED that follows the first kAhead lines has a command number too.
double begin_of(const Record& record, double period_clocks) {
  const PathStep& first = record.path.front();
  const std::uint64_t period = first.command < kAhead ? first.command : first.command - 1;
  return static_cast<double>(first.cycle) - static_cast<double>(PositionStream::kClocksPerTick * first.tick) -
         static_cast<double>(period) * period_clocks;
}

// At a point's time a joint may be half a pulse off if a period ends there, otherwise one pulse plus the deviation of
// the cubic from a line within a period (`bend`, for accelerations below 20 radians/s^2). In both cases the joint's
// travel in one tick is added. Points within the time in which the card was behind are not checked.
void check_points(const Record& record, const Followed& followed, const std::vector<Point>& points, double clock_hz) {
  const double begin = begin_of(record, seconds(kPeriod) * clock_hz);
  double farthest = 0;
  for (const Point& point : points) {
    if (point.time_from_start > followed.late && point.time_from_start < followed.back) continue;
    const bool at_end = point.time_from_start % kPeriod == 0ns;
    for (unsigned j = 0; j < kJoints; ++j) {
      const double is = position(record, j, begin + seconds(point.time_from_start) * clock_hz);
      const double away = std::abs(is - in_pulses(point.positions, j));
      const double tick = std::abs(point.velocities[j]) * kPulsesPerRadian[j] * 2 / clock_hz;
      const double bend = 20 * kPulsesPerRadian[j] * seconds(kPeriod) * seconds(kPeriod) / 8;
      check(away <= (at_end ? 0.5 : 1 + bend) + tick, "joint %u is %.3f pulses from the point at %.4f s", j, away,
            seconds(point.time_from_start));
      farthest = std::max(farthest, away);
    }
  }
  std::printf("at the points' times at most %.3f pulses away\n", farthest);
}

// Checks that the card continued along the line of its last period for as many ticks as it reported.
void check_line(const Record& record, const Followed& followed, double clock_hz) {
  const double period = seconds(kPeriod) * clock_hz;
  const double stale = static_cast<double>(PositionStream::kClocksPerTick * followed.stale_ticks);
  const double end = begin_of(record, period) + seconds(followed.late) * clock_hz;
  for (unsigned j = 0; j < kJoints; ++j) {
    const double to = std::round(pulses_of(followed.line_end[j]));  // a period's line ends at whole pulses
    const double speed = (to - std::round(pulses_of(followed.line_begin[j]))) / period;
    const double expected = to + speed * stale;
    const double by = followed.stopped ? static_cast<double>(followed.stopped_by) : end + stale;
    const double is = position(record, j, by);
    check(std::abs(is - expected) <= 1, "joint %u went on to %.0f, the line to %.3f", j, is, expected);
    check(!followed.stopped || pulses_of(followed.stopped->positions[j]) == is, "joint %u stands elsewhere", j);
  }
  if (!followed.stopped) {
    check(stale > 0 && stale < kStalePeriods * period, "it went on for %.0f clocks", stale);
    return;
  }
  // All stale periods at full speed, then a ramp: it covers the distance of half its time at full speed.
  const double expected = kStalePeriods * period + seconds(kSlewTime) * clock_hz / 2;
  check(std::abs(stale - expected) < 0.01 * expected, "it went on for %.0f clocks, not %.0f", stale, expected);
}

}  // namespace

int check_pulses(const Record& record, const Followed& followed, const std::vector<Point>& points, nanoseconds late,
                 double clock_hz) {
  for (unsigned j = 0; j < kJoints; ++j) {
    const long long wanted = std::llround(in_pulses(points.back().positions, j));
    check(record.pins[j] == wanted, "joint %u: %lld pulses at the pin", j, static_cast<long long>(record.pins[j]));
  }
  check((late > kPeriod * (kAhead + kStalePeriods)) == followed.stopped.has_value(), "a ramp, or none");
  check((late == 0ns) == (followed.stale_ticks == 0), "it went on, or not");
  check(!record.path.empty(), "no steps");
  if (record.path.empty()) return failed_checks;
  check_points(record, followed, points, clock_hz);
  if (late != 0ns) check_line(record, followed, clock_hz);
  return failed_checks;
}

}  // namespace trajectory
