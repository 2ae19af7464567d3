// The blocks in look-ahead and quantiser, in the order of the program. Internal to the planner.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/planner/block.hpp"

namespace trammel::planner {

// Length and feed ticks count from the start of the program. A block that does not move has no ticks.
struct PathEntry {
  Block block;
  double begin = 0;  // mm
  double end = 0;
  double density = 0;  // feed ticks per mm
  // mm/s: at this speed a hold by SLEW takes as much of an axis's acceleration as holds may take.
  double hold_speed = 0;
  std::uint64_t begin_ticks = 0;
  std::uint64_t end_ticks = 0;
  std::uint64_t queued = 0;     // halfwords of the geometry queue before its commands, from the start
  std::uint64_t halfwords = 0;  // > 0, halfwords of its commands
  bool cut = false;             // a piece must end with it: another class, another density or a stop follows
  bool stop = false;            // ends at rest
  double jump = 0;              // jump of an axis's velocity at its end, mm/s at a speed of 1 mm/s
  double bend = 0;              // jump of the acceleration at its end, mm/s^2 at a speed of 1 mm/s
  // Set by the quantiser.
  bool timed = false;  // the fields below are known
  bool short_sight = false;
  double seconds = 0;
  double speed = 0;      // mm/s, the highest
  double end_speed = 0;  // mm/s
};

class PathRing {
 public:
  explicit PathRing(std::size_t capacity) : entries_(capacity) {}

  // Indices count from the first block of the program.
  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return end_; }
  bool full() const { return end_ - begin_ == entries_.size(); }
  PathEntry& operator[](std::uint64_t i) { return entries_[static_cast<std::size_t>(i % entries_.size())]; }
  const PathEntry& operator[](std::uint64_t i) const { return entries_[static_cast<std::size_t>(i % entries_.size())]; }
  // Appends an entry, which still has the content of an old one.
  PathEntry& push() { return (*this)[end_++]; }
  void pop() { ++begin_; }
  void unpush() { --end_; }

 private:
  std::vector<PathEntry> entries_;
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace trammel::planner
