// The part of the path that is in the card's queue of paths. Internal to the planner.
#pragma once

#include <cstdint>
#include <limits>

#include "path_ring.hpp"

namespace trammel::planner {

// Capacities of the card's queues.
struct QueueLimits {
  std::uint64_t halfwords = 0;  // geometry queue
  std::uint64_t pieces = 0;     // feed queue
};

class QueuedPaths {
 public:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  // `path` must outlive it.
  QueuedPaths(const PathRing& path, std::uint64_t halfwords) : path_(path), halfwords_(halfwords) {}

  // Nothing follows the last block in the ring.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }
  // Whether a full queue of halfwords lies between the end of block `from` and the beginning of block `to`.
  bool covers(std::uint64_t from, std::uint64_t to) const {
    return path_[to].queued >= path_[from].queued + path_[from].halfwords + halfwords_;
  }
  // The tick up to which paths are queued if the first tick in the full queue is `tick`, in block `index`. At most the
  // end of the last block in the ring; kUnlimited if the program ends before. `tick` must not fall from call to call.
  double held(std::uint64_t index, std::uint64_t tick);

 private:
  const PathRing& path_;
  std::uint64_t halfwords_;
  std::uint64_t last_ = 0;  // the block in whose commands the queue ends
  bool ended_ = false;
};

}  // namespace trammel::planner
