// The blocks on their way through look-ahead and quantiser, by the order in which they came. Internal to the planner.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/planner/block.hpp"

namespace trammel::planner {

// Length and feed ticks are counted from the start of the program. What does not move has ticks too: none.
struct PathEntry {
  Block block;
  double begin = 0;  // mm
  double end = 0;
  double density = 0;     // feed ticks a mm
  double hold_speed = 0;  // mm/s from which a hold by SLEW takes all that it may of an axis's acceleration
  std::uint64_t begin_ticks = 0;
  std::uint64_t end_ticks = 0;
  std::uint64_t queued = 0;     // halfwords of the geometry queue, counted likewise: before its commands
  std::uint64_t halfwords = 0;  // > 0, of these
  bool cut = false;             // a piece ends with it: another class or density follows, or a stop
  bool stop = false;            // ends at rest
  double jump = 0;              // at its end, at a speed of 1 mm/s: of an axis's velocity, mm/s
  double bend = 0;              // and of the acceleration, mm/s^2
  // From the quantiser.
  bool timed = false;  // the rest is known
  bool short_sight = false;
  double seconds = 0;
  double speed = 0;      // mm/s, the highest
  double end_speed = 0;  // mm/s
};

class PathRing {
 public:
  explicit PathRing(std::size_t capacity) : entries_(capacity) {}

  // Counted from the first block of all.
  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return end_; }
  bool full() const { return end_ - begin_ == entries_.size(); }
  PathEntry& operator[](std::uint64_t i) { return entries_[static_cast<std::size_t>(i % entries_.size())]; }
  const PathEntry& operator[](std::uint64_t i) const { return entries_[static_cast<std::size_t>(i % entries_.size())]; }
  // The next one, with the content of an old one.
  PathEntry& push() { return (*this)[end_++]; }
  void pop() { ++begin_; }
  void unpush() { --end_; }

 private:
  std::vector<PathEntry> entries_;
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace trammel::planner
