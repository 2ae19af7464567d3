// Golden model of the queue: halfwords become readable when their whole command is committed. Cycle-exact. Not
// thread-safe; only the constructor allocates.
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
    bool commit = false;  // makes the halfwords of earlier clocks readable
    bool drop = false;    // discards the halfwords that are not committed; wins over write and commit
    bool read = false;    // ignored while empty
  };
  struct Outputs {
    std::uint16_t word = 0;  // two clocks after its read; undefined before the first read
    bool empty = true;       // includes a read one clock later, a commit two clocks later
    std::uint16_t room = 0;  // free halfwords; two clocks after each change, one clock after a reset or clear
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::vector<std::uint16_t> memory;
    std::size_t read = 0;       // index of the oldest committed halfword
    std::size_t committed = 0;  // halfwords that may be read
    std::size_t pending = 0;    // halfwords of the command under way
    std::uint16_t fetched = 0;  // the RAM's own output register
    Outputs outputs;
  };

  // depth: 2 .. 32,768 halfwords; throws std::invalid_argument otherwise.
  explicit HalfwordQueue(std::size_t depth);

  // One rising edge.
  void clock(const Inputs& in) {
    state_.outputs.word = state_.fetched;
    if (in.reset || in.clear) {
      // The read of the same clock still reaches the RAM's register.
      if (in.read && !state_.outputs.empty) state_.fetched = state_.memory[state_.read];
      forget_all();
      return;
    }
    state_.outputs.room = free();
    const bool take = in.read && !state_.outputs.empty;
    if (take) {
      state_.fetched = state_.memory[state_.read];
      state_.read = (state_.read + 1) % state_.memory.size();
      --state_.committed;
    }
    state_.outputs.empty = state_.committed == 0;
    if (in.drop) {
      state_.pending = 0;
    } else {
      if (in.commit) {
        state_.committed += state_.pending;
        state_.pending = 0;
      }
      if (in.write) state_.memory[(state_.read + state_.committed + state_.pending++) % state_.memory.size()] = in.word;
    }
  }

  const Outputs& outputs() const { return state_.outputs; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // Halfwords free now; `room` shows it a clock later.
  std::uint16_t free() const {
    return static_cast<std::uint16_t>(state_.memory.size() - state_.committed - state_.pending);
  }

 private:
  void forget_all() {
    state_.read = 0;
    state_.committed = 0;
    state_.pending = 0;
    state_.outputs.empty = true;
    state_.outputs.room = free();
  }

  State state_;
};

}  // namespace trammel::model
