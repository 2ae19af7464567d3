// Golden model of the command checker: checks stream words against the layouts of trammel/card_map.hpp and passes
// valid commands on in their stored form. Cycle-exact. Not thread-safe; does not allocate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/opcodes.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

class CommandChecker {
 public:
  struct Inputs {
    bool reset = false;
    bool write = false;  // a word; ignored unless ready
    std::uint32_t word = 0;
    bool flush = false;   // refuses an incomplete command; acts after a word under way, before one of its own clock
    bool clear = false;   // opens the stream; the next number is 0; wins over all other inputs
    bool closed = false;  // a fault is set: a word written now is refused as FAULTED and changes nothing
    std::uint16_t geometry_room = 0;  // halfwords, as the queue shows it
    std::uint16_t feed_room = 0;
  };
  struct Outputs {
    bool ready = true;
    std::uint16_t halfword = 0;  // holds between writes
    bool geometry_write = false;
    bool feed_write = false;
    bool geometry_commit = false;
    bool feed_commit = false;
    bool drop = false;
    bool refuse = false;
    std::uint8_t reason = 0;  // card_map::Reason; holds between refusals
    std::uint8_t number = 0;  // number in the last header
    bool partial = false;     // a command is incomplete
  };
  static constexpr std::size_t kMaxHalfwords = 64;

  // All that the next clock() depends on besides its inputs.
  struct State {
    bool open = true;
    card_map::Reason unread = card_map::Reason::None;  // why the word under way is refused unread
    bool flush_waits = false;
    int age = 0;                // clocks since the write of the word under way
    std::uint8_t expected = 0;  // number that the next header must have
    const card_map::Command* command = nullptr;
    card_map::Reason header_verdict = card_map::Reason::None;
    std::size_t received = 0;  // halfwords of the command so far, including the word under way
    std::array<std::uint16_t, kMaxHalfwords> halfwords{};
    Outputs outputs;
  };

  // Clocks from the write of a word until `ready` is set again. The second value is for words that are refused unread
  // (FAULTED, STREAM_CLOSED).
  static constexpr int kAnswerClocks = 6;
  static constexpr int kClosedAnswerClocks = 2;

  // axes: 1 .. 8, otherwise std::invalid_argument is thrown. engines: the mask of the card's engines.
  CommandChecker(unsigned axes, std::uint32_t engines);

  // One rising edge.
  void clock(const Inputs& in);
  const Outputs& outputs() const { return state_.outputs; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // True if a command is committed that the sequencer counts: a path or a barrier.
  bool counts_in_geometry() const { return state_.outputs.geometry_commit && !is_instant(state_.command->opcode); }

 private:
  void restart();
  void idle(const Inputs& in);
  void go_on(const Inputs& in);
  void answer();
  void answer_unread();
  void refuse(card_map::Reason reason);
  void store(std::size_t index);
  std::uint8_t mask() const { return static_cast<std::uint8_t>(state_.halfwords[0] >> 8); }
  bool mask_fits() const;
  std::size_t copies(const card_map::Field& field) const;
  card_map::Reason judge_header(const Inputs& in) const;
  card_map::Reason judge_payload() const;
  card_map::Reason judge_field(const card_map::Field& field, std::size_t begin) const;
  uint128 value(std::size_t begin, std::size_t count) const;  // fields have up to 80 bits

  std::uint8_t card_mask_;
  std::uint32_t engines_;

  State state_;
};

}  // namespace trammel::model
