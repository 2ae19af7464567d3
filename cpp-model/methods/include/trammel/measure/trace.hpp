// The record of a method on one curve, as the measures need it: every step with its time.
//
// Times are in the method's own unit (iterations, clocks, steps) and run to total_time(), when the method has
// finished the curve. The measures divide by total_time(), so that all methods are compared over the same duration,
// and so at equal mean speed. Not thread-safe.
// equal mean speed. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::measure {

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
  // Starts a new trace and keeps the memory. `axes` is 1 .. kTraceAxes.
  void clear(std::size_t axes, const TracePosition& start) {
    axes_ = axes;
    start_ = start;
    total_time_ = 0;
    events_.clear();
  }

  // Adds all steps of one time, which increases from call to call and is at least 1.
  void add(std::uint64_t time, const Directions& direction) { events_.push_back({time, direction}); }

  // Adds in bulk, for callers that know a bound: write up to `most` events in sequence, then keep those before `end`.
  // This halves the time to record a million lines.
  Event* room(std::size_t most) {
    if (room_.size() < most) room_.resize(most);
    return room_.data();
  }
  void take(const Event* end) { events_.assign(static_cast<const Event*>(room_.data()), end); }

  // To be called once after the last step. `total_time` is at least the time of that step, and below 2^63.
  void finish(std::uint64_t total_time) {
    total_time_ = total_time;
    for (std::size_t a = 0; a < axes_; ++a) {
      // No branch, because a branch predictor cannot predict which axis steps next.
      times_[a].resize(events_.size() + 1);
      std::size_t count = 0;
      for (const Event& event : events_) {
        times_[a][count] = event.time;
        count += event.direction[a] != 0 ? 1U : 0U;
      }
      times_[a].resize(count);
    }
  }

  std::size_t axes() const { return axes_; }
  const TracePosition& start() const { return start_; }
  const std::vector<Event>& events() const { return events_; }
  // The times of an axis's steps. Valid after finish().
  const std::vector<std::uint64_t>& times(std::size_t axis) const { return times_[axis]; }
  std::uint64_t total_time() const { return total_time_; }

 private:
  std::size_t axes_ = 2;
  TracePosition start_{};
  std::uint64_t total_time_ = 0;
  std::vector<Event> events_;
  std::vector<Event> room_;
  std::array<std::vector<std::uint64_t>, kTraceAxes> times_;
};

// Pulses of all axes: a diagonal step counts twice.
inline std::uint64_t pulses_of(const Trace& trace) {
  std::uint64_t count = 0;
  for (std::size_t a = 0; a < trace.axes(); ++a) count += trace.times(a).size();
  return count;
}

}  // namespace trammel::measure
