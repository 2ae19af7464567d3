// Golden model of the command fetch: reads one command ahead from a queue, and puts its halfwords on the load bus.
// Where each halfword goes follows from the layouts of the card map. Not thread-safe; no errors are reported: the
// stream's door lets only good commands into the queue.
//
// Timing: a halfword is asked for in clock r, lies on the queue's output in r+2 and on the load bus in r+3. The command
// is valid from r+3 of its last halfword.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::model {

// The load bus: a halfword and the chains that shift it in.
struct LoadBus {
  std::uint16_t word = 0;
  bool count = false;           // the next command's count and number
  bool prescale = false;        // the prescaler's increment
  std::uint8_t increment = 0;   // by axis
  std::uint8_t steps = 0;       // by axis: the count of a direct move
  std::uint8_t feed = 0;        // {floor, jerk, acceleration, rate}
  std::uint16_t deviation = 0;  // {plane, quadrants, end_y, end_x, half_y, half_x, gradient_y, gradient_x, deviation}

  bool any() const { return count || prescale || (increment | steps | feed | deviation) != 0; }
};

class CommandFetch {
 public:
  struct Inputs {
    bool clear = false;
    bool pop = false;        // the decoded command is taken
    bool arc_busy = false;   // the accumulator's registers are in use: an arc's payload has to wait
    bool empty = true;       // of the queue
    std::uint16_t word = 0;  // what was asked for two clocks ago
  };

  void clock(const Inputs& in);

  bool read() const { return asked_ >= 0; }  // asks the queue for a halfword
  bool valid() const { return phase_ == Phase::Valid; }
  bool idle() const { return phase_ == Phase::Idle; }
  bool is_path() const { return path_; }
  bool is_arc() const { return opcode_ == card_map::Opcode::Arc; }
  bool is_line() const { return opcode_ == card_map::Opcode::Line; }
  bool is_feed() const { return opcode_ == card_map::Opcode::Feed; }
  bool is_end() const { return opcode_ == card_map::Opcode::End; }
  std::uint8_t mask() const { return mask_; }
  const LoadBus& load() const { return load_; }

  bool waiting() const { return phase_ == Phase::Waiting; }  // for the accumulator to be free

  // Nothing moves while the queue stays as it is and nothing is taken.
  bool quiet() const {
    return asked_ < 0 && arriving_[0] < 0 && arriving_[1] < 0 && !load_.any() && phase_ != Phase::Tail;
  }

 private:
  enum class Phase { Idle, Reading, Waiting, Tail, Valid };
  static constexpr int kHeader = 4;  // halfwords in front of the payload

  void plan(std::uint16_t header);
  void direct(int payload_index);

  Phase phase_ = Phase::Idle;
  int asked_ = -1;  // index of the halfword asked for, -1: none
  std::array<int, 2> arriving_{-1, -1};
  int length_ = 0;  // halfwords of the command
  int tail_ = 0;
  bool path_ = false;
  card_map::Opcode opcode_ = card_map::Opcode::End;
  std::uint8_t mask_ = 0;
  std::array<std::uint8_t, 8> axes_{};  // of a line, lowest first
  LoadBus load_;
};

}  // namespace trammel::model
