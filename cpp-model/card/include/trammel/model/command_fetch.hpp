// Golden model of the command fetch and its decoder: reads one command ahead from a queue and puts its halfwords on a
// load bus. The layouts of the card map define the target of each halfword.
//
// A halfword requested in clock r is at the queue's output in r+2 and on the bus in r+3. A command is decoded in the
// clock in which its last halfword is on the bus.
//
// The halfwords of an engine's path after the prescaler wait until the engine is free. The increments of a line wait
// until the axes' shadow registers are free. The acceleration and jerk of a feed piece wait until the piece has
// begun, if another piece is under way when they would be requested; the piece is then decoded without them. Not
// thread-safe; no errors are reported, because the checker admits only valid commands to the queue.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/opcodes.hpp"

namespace trammel::model {

class CommandFetch {
 public:
  enum class Queue { Geometry, Feed };
  struct Inputs {
    bool clear = false;
    bool pop = false;            // the decoded command has begun (a barrier: has ended)
    bool payload_ready = true;   // geometry: the engine may be loaded; feed: no piece is under way
    bool shadows_free = true;    // the axes' increments may be loaded
    bool empty = true;           // the queue is empty
    std::uint16_t halfword = 0;  // the halfword requested two clocks ago
  };
  enum class Mode { Idle, Reading, Waiting, Decoded, Finishing };
  // All that the next clock() depends on besides its inputs.
  struct State {
    Mode mode = Mode::Idle;
    int asked = -1;  // index of the halfword requested now, -1: none
    std::array<int, 2> arriving = {-1, -1};
    int length = 0;            // halfwords of the command
    int pause_at = 0;          // index of the halfword before which the fetch may have to wait
    bool split = false;        // the piece is decoded without acceleration and jerk
    bool header_here = false;  // the header of this command has arrived, not only the rest of the previous one
    card_map::Opcode opcode = card_map::Opcode::End;
    std::uint8_t engine = card_map::engine::kLines;
    std::uint8_t mask = 0;
    std::array<std::uint8_t, 8> axes = {};  // axes of the mask, lowest first; arc in chords: x, y, then the others
    LoadWord bus;
  };

  explicit CommandFetch(Queue queue) : queue_(queue) {}

  // One rising edge.
  void clock(const Inputs& in);

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool read() const { return state_.asked >= 0; }  // requests a halfword from the queue
  bool idle() const { return state_.mode == Mode::Idle; }
  bool decoded() const { return state_.mode == Mode::Decoded; }
  const LoadWord& bus() const { return state_.bus; }

  // Of the decoded command.
  card_map::Opcode opcode() const { return state_.opcode; }
  bool is_line() const { return state_.opcode == card_map::Opcode::Line; }
  bool is_path() const { return is_line() || state_.opcode == card_map::Opcode::Arc || is_chord(); }
  bool is_chord() const { return state_.opcode == card_map::Opcode::ArcChord; }
  bool is_feed() const { return state_.opcode == card_map::Opcode::Feed; }
  bool is_end() const { return state_.opcode == card_map::Opcode::End; }
  bool is_output() const { return state_.opcode == card_map::Opcode::Output; }
  bool is_mark() const { return state_.opcode == card_map::Opcode::Mark; }
  bool is_pwm() const { return state_.opcode == card_map::Opcode::Pwm; }
  bool is_probe() const { return state_.opcode == card_map::Opcode::Probe; }
  bool is_wait() const { return state_.opcode == card_map::Opcode::WaitInput; }
  bool is_probe_end() const { return state_.opcode == card_map::Opcode::ProbeEnd; }
  bool is_instant() const { return model::is_instant(state_.opcode); }
  bool is_barrier() const { return !is_path() && !is_feed() && !is_instant(); }
  std::uint8_t engine() const { return state_.engine; }  // the engine of a path, as card_map::engine
  std::uint8_t mask() const { return state_.mask; }
  std::uint8_t flags() const { return state_.mask; }  // class and silence of a piece, which has them in place of a mask

  bool waiting() const { return state_.mode == Mode::Waiting; }

 private:
  void arrive(int index, std::uint16_t halfword);
  void ask(const Inputs& in);
  bool may_go_on(const Inputs& in) const { return is_line() ? in.shadows_free : in.payload_ready; }
  void order_axes(std::uint16_t plane);
  unsigned target_of(int index) const;

  Queue queue_;

  State state_;
};

}  // namespace trammel::model
