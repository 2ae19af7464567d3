// Golden model of the direct loader: what START does with the direct-mode registers.
//
// After START: 8 clocks in which the card's being busy is seen, 17 for each masked axis and 1 for each other, 8 for the
// length, 8 until the answer. A halfword taken in clock c is on the load bus from c+3 on. Not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::model {

class DirectLoader {
 public:
  struct Inputs {
    bool reset = false;
    bool busy = false;  // anything runs, is queued, or a fault stops the ticks
    bool start = false;
    std::uint8_t mask = 0;   // stands until done
    std::uint32_t data = 0;  // of the address of two clocks ago
  };
  struct Outputs {
    std::uint8_t address = 0;  // words
    bool done = false;
    bool error = false;  // means something with done
    std::uint8_t reason = 0;
    std::uint16_t word = 0;
    std::uint8_t axis = 0;
    bool increment = false;
    bool steps = false;
    bool length = false;
    bool go = false;  // with done: the chains are loaded, the move begins
    std::uint8_t mask = 0;
  };

  explicit DirectLoader(unsigned axes) : axes_(axes) {}

  // One rising edge.
  void clock(const Inputs& in) {
    if (!quiet() || in.start || in.reset) work(in);
  }
  const Outputs& outputs() const { return out_; }

  bool quiet() const { return phase_ == Phase::Idle && !out_.done && !moving_; }

 private:
  enum class Phase { Idle, Check, Axis, Length, Decide };
  // A halfword between the register file and the bus.
  struct Halfword {
    std::uint16_t word = 0;
    std::uint8_t axis = 0;
    bool increment = false;
    bool steps = false;
    bool length = false;
  };

  void work(const Inputs& in);
  void enter(Phase phase);
  void read_axis(const Inputs& in, Halfword& taken);
  void read_length(const Inputs& in, Halfword& taken);
  Halfword frequency_halfword(int index) const;
  static std::uint8_t word_address(std::uint32_t byte_address) { return static_cast<std::uint8_t>(byte_address >> 2); }

  unsigned axes_;
  Phase phase_ = Phase::Idle;
  int step_ = 0;
  unsigned axis_ = 0;
  bool busy_ = false;
  bool bad_ = false;
  bool negative_ = false;
  std::uint64_t frequency_ = 0;
  std::uint64_t length_ = 0;
  bool moving_ = false;  // halfwords are on their way
  Halfword taken_;
  Outputs out_;
};

}  // namespace trammel::model
