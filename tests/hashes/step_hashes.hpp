// Hashes of all steps of a run. They compare a card with the one for which hashes were recorded.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/steps.hpp"

namespace trammel::test {

// The value depends on each word and on their order.
class Hash {
 public:
  void add(std::uint64_t word);
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325U;
};

// Clocks by which the judged card is later than the recorded one. They are subtracted from the cycle of a pin step
// before it is hashed.
struct Shift {
  std::int64_t start = 0;    // from the end of the first write of commands to the first step
  std::int64_t barrier = 0;  // additional clocks at each barrier (DWELL, END) before the step
};

struct StepHashes {
  std::uint64_t path = 0;
  std::uint64_t path_steps = 0;
  // None for programs with arcs: when the hashes were recorded, rate and length of the feed of an arc came from angles
  // of the C library, whose last bit may move a tick by a clock.
  std::optional<std::uint64_t> pins;
  std::uint64_t pin_steps = 0;
  std::uint64_t barriers = 0;
  // Clocks from the end of the first write of commands to the first step at a pin, minus the shift. The configuration
  // comes before this write; the time of its accesses may change.
  std::int64_t start = 0;
  // Smallest time in clocks by which the commands of a path were written before the last step of the previous path.
  // Above 0, no path had to wait for the host, so the times at the pins are those of the card. None for a single path.
  std::optional<std::int64_t> lead;
};

// The path hash covers (command, tick, axis, direction) of each step. For arcs in chords it covers only the pulses of
// each command and axis, because their ticks come from the angle of the arc. An arc on the accumulator is computed in
// integers from its centre (in 1/256 pulses) and its ends, so its path ticks are included. Steps of one tick, and steps
// of one cycle, are taken in the order of the axes.
//
// The pin hash covers (cycle since the first step, axis, direction). The n-th step at the pins of an axis is the n-th
// path step of this axis; the command of that step tells how many barriers come before it.
class StepHasher final : public driver::StepSink {
 public:
  explicit StepHasher(Shift shift) : shift_(shift) {}

  enum class Path { kNoArc, kArc, kChords };  // kind of the commands of a block
  // Starts a block of commands, adds its commands, and gives the cycle in which they were written.
  void block(Path path);
  void command(const driver::Command& command);
  void sent(std::uint64_t cycle);
  void path_step(const driver::PathStep& step) override;
  void pin_step(const driver::PinStep& step) override;

  // Call it after the last step. Throws std::logic_error when the pins have made other steps than the paths.
  StepHashes finish();

 private:
  struct Sent {  // a command
    std::size_t block;
    std::uint64_t barriers;  // barriers before it
    bool chord;
  };
  struct Waiting {  // a path step that its pin has not made yet
    const Sent* command;
    std::int8_t direction;
  };
  using Pulses = std::array<std::array<std::uint64_t, 2>, card_map::kMaxAxes>;  // by axis: up, down

  void end_tick();
  void end_chord();
  void end_cycle();
  void look_at_lead(std::size_t block, std::uint64_t cycle);

  Shift shift_;
  std::deque<Sent> commands_;
  std::vector<std::uint64_t> sent_at_;  // indexed by block
  bool arcs_ = false;
  bool chords_ = false;  // the current block is an arc in chords
  StepHashes result_;

  Hash path_;
  std::vector<driver::PathStep> tick_;  // steps of the current tick
  Pulses chord_{};                      // of the current command

  Hash pins_;
  std::array<std::deque<Waiting>, card_map::kMaxAxes> waiting_;
  std::vector<driver::PinStep> cycle_;     // steps of the current cycle
  std::int64_t corrected_ = 0;             // time of that cycle since the first write, minus the shift
  std::optional<std::size_t> last_block_;  // block of the last pin step
  std::uint64_t last_cycle_ = 0;
};

}  // namespace trammel::test
