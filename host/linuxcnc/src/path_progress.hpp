// Tracks the card's progress in one run of the planner: the current line, and the duration of the commands still in the
// card. Internal to the path server. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "trammel/driver/card.hpp"
#include "trammel/run/observer.hpp"

namespace trammel::linuxcnc {

// The time that is left in one of the card's queues, as a lower bound in seconds.
class QueuedTime {
 public:
  // Adds an entry that begins when the card's count of begun commands reaches `first`.
  void put(std::uint32_t first, std::size_t line, double seconds);
  // `now`: s, card time.
  void look(std::uint32_t begun, double now);
  double seconds_left() const { return under_way_ + waiting_; }
  std::size_t line() const { return line_; }  // line of the entry that has begun last

 private:
  struct Entry {
    std::uint32_t first = 0;
    std::size_t line = 0;
    double seconds = 0;
  };
  std::deque<Entry> entries_;  // entries that have not begun
  std::size_t line_ = 0;
  double seconds_ = 0;    // duration of the current entry
  double begun_ = 0;      // time at which the current entry was first seen
  double under_way_ = 0;  // s left of the current entry
  double waiting_ = 0;    // total s of `entries_`
};

class PathProgress final : public run::Observer {
 public:
  // `clock_hz`: clock of the card. `most_override`: the largest ratio of planned to real time.
  PathProgress(std::uint32_t clock_hz, double most_override) : clock_hz_(clock_hz), most_override_(most_override) {}

  void sending(const planner::PlannedBlock& block) override;
  void command(std::uint64_t number, const driver::Command& command) override;
  void look(const driver::Snapshot& now);

  bool any_sent() const { return any_sent_; }
  // Among the lines that the run has read, the one that has begun last; 0: none.
  std::size_t line() const { return geometry_.line(); }
  // Lower bound of the motion left in the card, s. A path needs its feed piece, which may arrive with a later block, so
  // this is the minimum of both queues.
  double seconds_left() const;

 private:
  double clock_hz_;
  double most_override_;
  QueuedTime geometry_;  // one entry per block
  QueuedTime feed_;      // one entry per feed piece
  std::uint32_t geometry_commands_ = 0;
  std::uint32_t feed_commands_ = 0;
  bool any_sent_ = false;
};

}  // namespace trammel::linuxcnc
