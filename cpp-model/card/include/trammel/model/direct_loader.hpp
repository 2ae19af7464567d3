// Golden model of the direct loader: checks the direct-mode registers at START and loads them.
//
// START in clock c: the loader checks the mask, and the state of the card as of c+7. If one of them forbids the move,
// the answer (done) comes at c+17. Otherwise the loader takes 17 clocks for each axis in the mask, 1 for each other
// one of the 8 axes, 8 for the length and 8 until the answer, which comes at c+33+16m for m axes. It checks for a
// fault again in the clock before the answer, so that no move is left that would begin when the fault is cleared. A
// halfword taken in clock c is on `load` in c+2. Not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class DirectLoader {
 public:
  struct Inputs {
    bool reset = false;
    bool busy = false;    // something runs, is decoded or queued
    bool closed = false;  // a fault is set
    bool start = false;
    std::uint8_t mask = 0;   // stable until done
    std::uint32_t data = 0;  // value at the address of two clocks ago
  };
  struct Outputs {
    std::uint16_t address = 0;  // words, 10 bits
    bool done = false;
    bool error = false;  // valid with done
    std::uint8_t reason = 0;
    LoadWord load;
    bool go = false;  // with done: the chains are loaded and the move begins
    std::uint8_t mask = 0;
  };
  enum class Phase { Idle, Check, Axis, Length, Decide };
  // All that the next clock() depends on besides its inputs.
  struct State {
    Phase phase = Phase::Idle;
    int step = 0;
    unsigned axis = 0;
    bool busy = false;
    bool closed = false;
    bool bad_mask = false;
    bool bad_value = false;
    bool negative = false;
    std::uint64_t frequency = 0;
    std::uint64_t length = 0;
    bool moving = false;  // halfwords are on their way
    LoadWord taken;
    Outputs out;
  };

  explicit DirectLoader(unsigned axes) : axes_(axes) {}

  // One rising edge.
  void clock(const Inputs& in) { go_on(in); }
  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  void go_on(const Inputs& in);
  void enter(Phase phase);
  LoadWord read_axis(const Inputs& in);
  LoadWord read_length(const Inputs& in);
  LoadWord frequency_halfword(int index) const;
  void decide(const Inputs& in);
  static std::uint16_t word_address(std::uint32_t byte_address) {
    return static_cast<std::uint16_t>(byte_address >> 2);
  }

  unsigned axes_;

  State state_;
};

}  // namespace trammel::model
