// Programmed motions without a pulse between two blocks, and the speed at which their corners may be passed. Internal
// to the planner.
#pragma once

#include <algorithm>

#include "junction.hpp"

namespace trammel::planner {

class Detours {
 public:
  explicit Detours(const machine::Machine& machine) : junctions_(machine) {}

  // Whether such motions have come since the last block.
  bool open() const { return open_; }
  // Adds one, given as a block of its own.
  void pass(const Block& motion) {
    const Heading heading{motion.entry, motion.length, motion.speed, motion.linear};
    if (open_) {
      detour_.speed = to(heading).speed;
    } else {
      detour_ = {motion.speed, heading};
      open_ = true;
    }
    last_ = motion;
  }
  // Adds one whose corners are unknown: they count as a stop.
  void stop() {
    detour_.speed = 0;
    open_ = true;
  }
  // The corners up to a block with this heading.
  Detour to(const Heading& heading) const {
    Detour detour = detour_;
    if (detour.speed > 0) detour.speed = std::min(detour.speed, junctions_.speed(last_, heading));
    return detour;
  }
  void close() { open_ = false; }

 private:
  Junctions junctions_;
  Block last_;
  Detour detour_;
  bool open_ = false;
};

}  // namespace trammel::planner
