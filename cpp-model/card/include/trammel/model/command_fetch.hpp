// Golden model of the command fetch and its decoder: reads one command ahead from a queue and puts its halfwords on a
// load bus. Where each halfword goes follows from the layouts of the card map.
//
// A halfword asked for in clock r lies on the queue's output in r+2 and on the bus in r+3. A command is decoded in the
// clock in which its last halfword is on the bus. An engine's halfwords after the prescaler wait until it is
// free, a line's increments until the axes' shadows are; a feed piece's acceleration and jerk until it has begun, where
// a piece runs as they would be asked for: it is decoded without them. Not thread-safe; no errors are reported: the
// checker lets only good commands into the queue.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class CommandFetch {
 public:
  enum class Queue { Geometry, Feed };
  struct Inputs {
    bool clear = false;
    bool pop = false;            // the decoded command has begun (a barrier: is over)
    bool payload_ready = true;   // the engine may be loaded; no piece is under way
    bool shadows_free = true;    // the axes' increments may be loaded
    bool empty = true;           // of the queue
    std::uint16_t halfword = 0;  // what was asked for two clocks ago
  };

  // `clock_all`: it never rests.
  explicit CommandFetch(Queue queue, bool clock_all = false) : queue_(queue), clock_all_(clock_all) {}

  // One rising edge.
  void clock(const Inputs& in) {
    if (!clock_all_ && idle() && asked_ < 0 && in.empty && arriving_[0] < 0 && arriving_[1] < 0 && !bus_.valid) return;
    work(in);
  }

  bool read() const { return asked_ >= 0; }  // asks the queue for a halfword
  bool idle() const { return state_ == State::Idle; }
  bool decoded() const { return state_ == State::Decoded; }
  const LoadWord& bus() const { return bus_; }

  // Of the command decoded.
  card_map::Opcode opcode() const { return opcode_; }
  bool is_line() const { return opcode_ == card_map::Opcode::Line; }
  bool is_path() const { return is_line() || opcode_ == card_map::Opcode::Arc || is_chord(); }
  bool is_chord() const { return opcode_ == card_map::Opcode::ArcChord; }
  bool is_feed() const { return opcode_ == card_map::Opcode::Feed; }
  bool is_end() const { return opcode_ == card_map::Opcode::End; }
  bool is_output() const { return opcode_ == card_map::Opcode::Output; }
  bool is_mark() const { return opcode_ == card_map::Opcode::Mark; }
  bool is_probe() const { return opcode_ == card_map::Opcode::Probe; }
  bool is_wait() const { return opcode_ == card_map::Opcode::WaitInput; }
  bool is_probe_end() const { return opcode_ == card_map::Opcode::ProbeEnd; }
  bool is_instant() const { return is_output() || is_mark() || is_probe(); }  // neither path nor barrier
  bool is_barrier() const { return !is_path() && !is_feed() && !is_instant(); }
  std::uint8_t engine() const { return engine_; }  // what a path runs on, by its card_map::engine
  std::uint8_t mask() const { return mask_; }
  std::uint8_t flags() const { return mask_; }  // in place of the mask: a piece's class

  // Without inputs that change nothing moves; a path that waits looks at payload_ready.
  bool quiet() const {
    return asked_ < 0 && arriving_[0] < 0 && arriving_[1] < 0 && !bus_.valid &&
           (state_ == State::Idle || state_ == State::Decoded || state_ == State::Waiting);
  }
  bool waiting() const { return state_ == State::Waiting; }

 private:
  enum class State { Idle, Reading, Waiting, Decoded, Finishing };

  void work(const Inputs& in);
  void arrive(int index, std::uint16_t halfword);
  void ask(const Inputs& in);
  bool may_go_on(const Inputs& in) const { return is_line() ? in.shadows_free : in.payload_ready; }
  void order_axes(std::uint16_t plane);
  unsigned target_of(int index) const;

  Queue queue_;
  bool clock_all_;
  State state_ = State::Idle;
  int asked_ = -1;  // index of the halfword asked for, -1: none
  int arriving_[2] = {-1, -1};
  int length_ = 0;            // halfwords of the command
  int pause_at_ = 0;          // the halfword before which it may have to wait
  bool split_ = false;        // the piece is decoded without acceleration and jerk
  bool header_here_ = false;  // what arrives is of this command, not the rest of the one before
  card_map::Opcode opcode_ = card_map::Opcode::End;
  std::uint8_t engine_ = card_map::engine::kLines;
  std::uint8_t mask_ = 0;
  std::uint8_t axes_[8] = {};  // of the mask, lowest first; an arc's in chords: x, y, the further ones
  LoadWord bus_;
};

}  // namespace trammel::model
