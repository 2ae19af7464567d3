// How far the card is in one run of the planner: which line it is at, and for how long what it was sent still lasts.
// Internal to the path server. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "trammel/driver/card.hpp"
#include "trammel/run/observer.hpp"

namespace trammel::linuxcnc {

class PathProgress final : public run::Observer {
 public:
  // `clock_hz`: the card's. `most_override`: the largest ratio of planned to real time.
  PathProgress(std::uint32_t clock_hz, double most_override) : clock_hz_(clock_hz), most_override_(most_override) {}

  void sending(const planner::PlannedBlock& block) override;
  void command(std::uint64_t number, const driver::Command& command) override;
  void look(const driver::Snapshot& now);

  bool any_sent() const { return any_sent_; }
  // Of the lines that the run has read, the one that has begun last; 0: none.
  std::size_t line() const { return line_; }
  // At least so much motion has the card still, s as planned.
  double seconds_left() const { return under_way_ + waiting_; }

 private:
  struct Sent {
    std::size_t line = 0;
    double seconds = 0;
    std::uint32_t first = 0;  // count of geometry commands when it has begun
  };

  double clock_hz_;
  double most_override_;
  std::deque<Sent> sent_;  // blocks that have not begun
  std::uint32_t commands_ = 0;
  bool any_sent_ = false;
  std::size_t line_ = 0;
  double block_ = 0;         // s of the block under way
  std::uint64_t begun_ = 0;  // card clock when that was first seen
  double under_way_ = 0;     // s left of it
  double waiting_ = 0;       // s of blocks that have not begun
};

}  // namespace trammel::linuxcnc
