// Golden model of the queue: halfwords that become readable once their whole command is committed.
// Cycle exact. Not thread-safe; the only allocation is the constructor's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::model {

class HalfwordQueue {
 public:
  struct Inputs {
    bool reset = false;
    bool clear = false;
    bool write = false;  // only while there is room
    std::uint16_t word = 0;
    bool commit = false;  // makes what was written in earlier clocks readable
    bool drop = false;    // forgets what is not committed; wins over write and commit
    bool read = false;    // ignored while empty
  };
  struct Outputs {
    std::uint16_t word = 0;  // two clocks after its read; without meaning before the first read
    bool empty = true;       // counts a read one clock later, a commit two clocks later
    std::uint16_t room = 0;  // free halfwords; two clocks after what changed it, one after a reset or clear
  };

  // depth: 2 .. 32,768 halfwords; throws std::invalid_argument otherwise.
  explicit HalfwordQueue(std::size_t depth);

  // One rising edge.
  void clock(const Inputs& in) {
    outputs_.word = fetched_;
    if (in.reset || in.clear) {
      // The read of the same clock still reaches the RAM's register.
      if (in.read && !outputs_.empty) fetched_ = memory_[read_];
      forget_all();
      return;
    }
    outputs_.room = free();
    const bool take = in.read && !outputs_.empty;
    if (take) {
      fetched_ = memory_[read_];
      read_ = (read_ + 1) % memory_.size();
      --committed_;
    }
    outputs_.empty = committed_ == 0;
    if (in.drop) {
      pending_ = 0;
    } else {
      if (in.commit) {
        committed_ += pending_;
        pending_ = 0;
      }
      if (in.write) memory_[(read_ + committed_ + pending_++) % memory_.size()] = in.word;
    }
  }

  const Outputs& outputs() const { return outputs_; }

  // Halfwords free now; `room` shows it a clock later.
  std::uint16_t free() const { return static_cast<std::uint16_t>(memory_.size() - committed_ - pending_); }

  // True when a clock without inputs changes nothing.
  bool quiet() const {
    return outputs_.word == fetched_ && outputs_.empty == (committed_ == 0) && outputs_.room == free();
  }

 private:
  void forget_all() {
    read_ = 0;
    committed_ = 0;
    pending_ = 0;
    outputs_.empty = true;
    outputs_.room = free();
  }

  std::vector<std::uint16_t> memory_;
  std::size_t read_ = 0;       // index of the oldest committed halfword
  std::size_t committed_ = 0;  // halfwords that may be read
  std::size_t pending_ = 0;    // halfwords of the command under way
  std::uint16_t fetched_ = 0;  // the RAM's own output register
  Outputs outputs_;
};

}  // namespace trammel::model
