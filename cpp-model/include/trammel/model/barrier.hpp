// Golden model of the meeting of both queues at a DWELL or END. A dwell of n clocks counts for max(1, n), and both
// queues stand for 4 clocks more in front of it. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

namespace trammel::model {

class Barrier {
 public:
  struct Inputs {
    bool clear = false;
    bool go = true;        // no fault
    bool both_at = false;  // both queues stand at the barrier
    bool over = false;     // the dwell's last clock, or nothing to count
    bool end = false;      // the barrier is an END
  };

  void clock(const Inputs& in) {
    const bool over = counting() && in.go && in.over;
    done_ = over && !in.clear;
    ended_ = done_ && in.end;
    if (in.clear) {
      at_ = kIdle;
    } else if (at_ == kIdle) {
      if (in.both_at && in.go) at_ = kMet;
    } else if (at_ == kCount) {
      if (over) at_ = kLeave;
    } else if (at_ == kLast) {
      at_ = kIdle;
    } else {
      ++at_;
    }
  }

  bool load() const { return at_ == kLoad; }       // the tick counter takes the dwell's clocks
  bool counting() const { return at_ == kCount; }  // one each clock
  bool done() const { return done_; }              // both queues go on
  bool ended() const { return ended_; }            // with done: it was an END
  bool idle() const { return at_ == kIdle; }

 private:
  // Two clocks let the count's flags settle, three let the queues leave.
  enum : int { kIdle, kMet, kMet2, kLoad, kCount, kLeave, kLeave2, kLast };
  int at_ = kIdle;
  bool done_ = false;
  bool ended_ = false;
};

}  // namespace trammel::model
