// Follows a trajectory by position streaming: every millisecond the card gets the joints' targets for the end of the
// next period. The trajectory has points with times, positions and velocities, like trajectory_msgs/JointTrajectory of
// ROS 2.
//
//     trajectory [URL]         URL: of the card (docs/reference/card-url.md); default: a simulated card
//
// Between two points a joint follows the cubic given by their positions and velocities. Points arrive one by one, and
// one may be late. The card then continues along its line for kStalePeriods and ramps down; the remaining trajectory
// begins where the card stopped. The trajectory is followed three times: without delay, with a point late by 6 ms, and
// with a point late by 200 ms. If the card is simulated in this process, its pulses are checked: the positions at the
// points' times, and the lines along which it continued.
#include "trajectory.hpp"

#include <cstdio>
#include <exception>
#include <tuple>

#include "trammel/driver/card_place.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/connection.hpp"

namespace trajectory {
namespace {

// The third point's time is not a multiple of the period.
const std::vector<Point> kPoints = {{0ms, {0, 0, 0}, {0, 0, 0}},
                                    {400ms, {0.3, -0.2, 0.1}, {1.2, -0.6, 0.2}},
                                    {750'400us, {0.7, -0.35, 0.1}, {1.0, -0.2, -0.3}},
                                    {1200ms, {1.0, -0.3, -0.1}, {0.2, 0.4, -0.4}},
                                    {1600ms, {0.9, 0.0, -0.2}, {-0.5, 0.6, 0}},
                                    {2000ms, {0.8, 0.2, -0.2}, {0, 0, 0}}};

// The points that have arrived. Only the last two are needed.
class Trajectory {
 public:
  explicit Trajectory(const Point& begin) : from_(begin), to_(begin) {}

  void add(Point point) {
    point.time_from_start += shift_;
    from_ = to_;
    to_ = point;
  }
  // Restarts the last segment at `time` and `place`, after the card stopped there. The segment keeps its full duration,
  // so its end and all later points are delayed by the same time.
  void begin_anew(nanoseconds time, const Joints& place) {
    const nanoseconds segment = to_.time_from_start - from_.time_from_start;
    shift_ += time + segment - to_.time_from_start;
    from_ = {time, place, {}};
    to_.time_from_start = time + segment;
  }
  nanoseconds end() const { return to_.time_from_start; }
  // Position on the last segment.
  Joints at(nanoseconds time) const {
    const double duration = seconds(to_.time_from_start - from_.time_from_start);
    const double s = duration == 0 ? 1 : seconds(time - from_.time_from_start) / duration;
    Joints place{};
    for (unsigned j = 0; j < kJoints; ++j) {
      const double way = to_.positions[j] - from_.positions[j];
      const double begin = from_.velocities[j] * duration;
      const double end = to_.velocities[j] * duration;
      place[j] = from_.positions[j] + s * (begin + s * (3 * way - 2 * begin - end + s * (begin + end - 2 * way)));
    }
    return place;
  }

 private:
  Point from_, to_;
  nanoseconds shift_{0};
};

PositionStream::Positions targets_of(const Joints& place) {
  PositionStream::Positions targets{};
  for (unsigned j = 0; j < kJoints; ++j) {
    targets[j] = std::llround(in_pulses(place, j) * static_cast<double>(PositionStream::kPulse));
  }
  return targets;
}

Joints joints_of(const PositionStream::Positions& positions) {
  Joints place{};
  for (unsigned j = 0; j < kJoints; ++j) place[j] = pulses_of(positions[j]) / kPulsesPerRadian[j];
  return place;
}

// Follows the points. The point with the number `late_point` arrives `late` after its time. Positions count from the
// joints' positions at the start.
Followed follow(Card& card, const std::vector<Point>& points, std::size_t late_point, nanoseconds late) {
  PositionStreamOptions options;
  options.ahead = kAhead;
  options.stale_periods = kStalePeriods;
  PositionStream stream(card, options);
  Trajectory trajectory(points.front());
  Followed followed;
  PositionStream::Positions line_begin{}, line_end{};
  std::size_t next = 1;
  nanoseconds time{0};  // end of the last period sent
  while (time < trajectory.end() || next < points.size()) {
    while (time + kPeriod > trajectory.end() && next < points.size()) {
      if (next == late_point) card.bus().sleep(late);  // a subscriber would wait for its message here
      trajectory.add(points[next++]);
    }
    const PositionStream::Positions target = targets_of(trajectory.at(std::min(time + kPeriod, trajectory.end())));
    try {
      const PositionStream::Sent sent = stream.send(target, kPeriod);
      if (sent.stale_ticks != 0 && followed.stale_ticks == 0) {
        followed.stale_ticks = sent.stale_ticks;
        followed.late = time;
        std::tie(followed.line_begin, followed.line_end) = std::tie(line_begin, line_end);
      }
      time += kPeriod;
      if (stream.ticks_behind() != 0) followed.back = time + kPeriod;
      std::tie(line_begin, line_end) = std::tie(line_end, target);
      // The queue is full enough: one period later a queued period has ended. While the stream catches up, its periods
      // are shorter, so wait for half a period.
      if (sent.ahead >= kAhead) card.bus().sleep(stream.ticks_behind() != 0 ? kPeriod / 2 : kPeriod);
    } catch (const FaultError& error) {
      if ((error.faults() & trammel::card_map::field::kFaultMissingPeriod) == 0) throw;
      followed.stopped = stream.recover();  // waits until the card is at rest
      followed.stopped_by = card.read_snapshot().time;
      followed.stale_ticks = followed.stopped->stale_ticks;
      followed.late = time;
      followed.back = nanoseconds::max();  // the later points are delayed
      std::tie(followed.line_begin, followed.line_end) = std::tie(line_begin, line_end);
      trajectory.begin_anew(time, joints_of(followed.stopped->positions));
    }
  }
  stream.finish();
  return followed;
}

// Follows the points. Returns true if the joints ended on the last point and all pulses were right.
bool run(trammel::transport::Connection& connection, Card& card, const std::vector<Point>& points,
         std::size_t late_point, nanoseconds late) {
  Record record;
  if (connection.engine() != nullptr) connection.engine()->set_sink(&record);
  const std::array<std::int32_t, trammel::card_map::kMaxAxes> from = card.read_snapshot().position;
  const Followed followed = follow(card, points, late_point, late);
  const std::array<std::int32_t, trammel::card_map::kMaxAxes> to = card.read_snapshot().position;
  if (connection.engine() != nullptr) connection.engine()->set_sink(nullptr);
  std::printf("late by %.0f ms: the card went on for %llu ticks%s\n", seconds(late) * 1e3,
              static_cast<unsigned long long>(followed.stale_ticks),
              followed.stopped ? ", ramped down, and began anew" : "");
  bool right = true;
  for (unsigned j = 0; j < kJoints; ++j) {
    const long long wanted = std::llround(in_pulses(points.back().positions, j));
    std::printf("joint %u: %d pulses, wanted %lld\n", j, to[j] - from[j], wanted);
    right = right && to[j] - from[j] == wanted;
  }
  if (connection.engine() == nullptr) return right;
  return check_pulses(record, followed, points, late, card.timing().clock_hz) == 0 && right;
}

}  // namespace
}  // namespace trajectory

int main(int argc, char** argv) try {
  using namespace trajectory;
  trammel::transport::Connection connection(trammel::transport::parse_card_url(argc > 1 ? argv[1] : "sim:"));
  Card card = Card::open(connection.bus());
  card.take_over();  // a served card holds after its client has disconnected
  for (unsigned j = 0; j < kJoints; ++j) card.configure_axis(j, {2us, 2us, 2us, 2us});  // from the drives' data sheet
  begin_at_place(card, (1U << kJoints) - 1);
  card.set_slew_time(kSlewTime);
  std::vector<Point> back = kPoints;
  for (Point& point : back) {
    for (unsigned j = 0; j < kJoints; ++j) point.positions[j] = -point.positions[j];
    for (unsigned j = 0; j < kJoints; ++j) point.velocities[j] = -point.velocities[j];
  }
  bool right = run(connection, card, kPoints, 0, 0ms);
  right = run(connection, card, back, 3, 6ms) && right;
  right = run(connection, card, kPoints, 3, 200ms) && right;
  return right ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
