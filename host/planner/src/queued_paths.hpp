// How far along the path the card's queue of paths reaches. Internal to the planner.
#pragma once

#include <cstdint>
#include <limits>

#include "path_ring.hpp"

namespace trammel::planner {

// What the card's queues hold.
struct QueueLimits {
  std::uint64_t halfwords = 0;  // of geometry
  std::uint64_t pieces = 0;
};

class QueuedPaths {
 public:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  // `path` must outlive it.
  QueuedPaths(const PathRing& path, std::uint64_t halfwords) : path_(path), halfwords_(halfwords) {}

  // Nothing follows the last block in the ring.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }
  // Whether so many halfwords lie between the end of block `from` and the begin of block `to`.
  bool covers(std::uint64_t from, std::uint64_t to) const {
    return path_[to].queued >= path_[from].queued + path_[from].halfwords + halfwords_;
  }
  // The tick up to which paths are queued when `tick`, in block `index`, is the first one in the queue; that of the
  // last block in the ring at most, and kUnlimited where the program ends before. From call to call `tick` does not
  // fall.
  double held(std::uint64_t index, std::uint64_t tick);

 private:
  const PathRing& path_;
  std::uint64_t halfwords_;
  std::uint64_t last_ = 0;  // block, with whose commands the queue ends
  bool ended_ = false;
};

}  // namespace trammel::planner
