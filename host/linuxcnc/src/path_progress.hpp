// How far the card is in one run of the planner: which line it is at, and for how long what it was sent still lasts.
// Internal to the path server. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "trammel/driver/card.hpp"
#include "trammel/run/observer.hpp"

namespace trammel::linuxcnc {

// What one of the card's queues was sent and has not done: at least so many seconds of it are left.
class QueuedTime {
 public:
  // Begins when the card's count of begun commands has come to `first`.
  void put(std::uint32_t first, std::size_t line, double seconds);
  // `now`: s, by the card's clock.
  void look(std::uint32_t begun, double now);
  double seconds_left() const { return under_way_ + waiting_; }
  std::size_t line() const { return line_; }  // of the one that has begun last

 private:
  struct Entry {
    std::uint32_t first = 0;
    std::size_t line = 0;
    double seconds = 0;
  };
  std::deque<Entry> entries_;  // that have not begun
  std::size_t line_ = 0;
  double seconds_ = 0;    // of the one under way
  double begun_ = 0;      // when that was first seen
  double under_way_ = 0;  // s left of it
  double waiting_ = 0;    // s of `entries_`
};

class PathProgress final : public run::Observer {
 public:
  // `clock_hz`: the card's. `most_override`: the largest ratio of planned to real time.
  PathProgress(std::uint32_t clock_hz, double most_override) : clock_hz_(clock_hz), most_override_(most_override) {}

  void sending(const planner::PlannedBlock& block) override;
  void command(std::uint64_t number, const driver::Command& command) override;
  void look(const driver::Snapshot& now);

  bool any_sent() const { return any_sent_; }
  // Of the lines that the run has read, the one that has begun last; 0: none.
  std::size_t line() const { return geometry_.line(); }
  // At least so much motion has the card still, s: a path needs its piece of feed, which may come with a later block.
  double seconds_left() const;

 private:
  double clock_hz_;
  double most_override_;
  QueuedTime geometry_;  // a block each
  QueuedTime feed_;      // a piece each
  std::uint32_t geometry_commands_ = 0;
  std::uint32_t feed_commands_ = 0;
  bool any_sent_ = false;
};

}  // namespace trammel::linuxcnc
