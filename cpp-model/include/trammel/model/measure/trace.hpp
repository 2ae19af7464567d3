// What a method did on one curve, as the measures need it: every step with the time at which it came.
//
// Times are in the method's own unit (iterations, clocks, steps) and run to total_time(), when the method has finished
// the curve. The measures divide by total_time(), so that all methods are compared over the same duration, that is at
// equal mean speed. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::model::measure {

inline constexpr std::size_t kTraceAxes = 4;

using Directions = std::array<std::int8_t, kTraceAxes>;  // -1, 0, +1 by axis
using TracePosition = std::array<std::int64_t, kTraceAxes>;

// All steps of one time.
struct Event {
  std::uint64_t time = 0;
  Directions direction{};
};

class Trace {
 public:
  // Starts anew, keeping the memory. `axes` is 1 .. kTraceAxes.
  void clear(std::size_t axes, const TracePosition& start) {
    axes_ = axes;
    start_ = start;
    total_time_ = 0;
    events_.clear();
  }

  // Steps at `time`, which never decreases and is at least 1; steps of equal time become one event.
  void add(std::uint64_t time, const Directions& direction) {
    if (!events_.empty() && events_.back().time == time) {
      for (std::size_t a = 0; a < kTraceAxes; ++a) {
        events_.back().direction[a] = static_cast<std::int8_t>(events_.back().direction[a] + direction[a]);
      }
      return;
    }
    events_.push_back({time, direction});
  }

  // `total_time` is at least the last step's time.
  void finish(std::uint64_t total_time) { total_time_ = total_time; }

  std::size_t axes() const { return axes_; }
  const TracePosition& start() const { return start_; }
  const std::vector<Event>& events() const { return events_; }
  std::uint64_t total_time() const { return total_time_; }

 private:
  std::size_t axes_ = 2;
  TracePosition start_{};
  std::uint64_t total_time_ = 0;
  std::vector<Event> events_;
};

// Pulses of one axis, whatever their direction.
inline std::uint64_t pulses_of(const Trace& trace, std::size_t axis) {
  std::uint64_t count = 0;
  for (const Event& event : trace.events()) count += event.direction[axis] != 0 ? 1U : 0U;
  return count;
}

// Pulses of all axes: a diagonal step counts twice.
inline std::uint64_t pulses_of(const Trace& trace) {
  std::uint64_t count = 0;
  for (std::size_t a = 0; a < trace.axes(); ++a) count += pulses_of(trace, a);
  return count;
}

}  // namespace trammel::model::measure
