// Hashes of all steps of a run, by which a card is compared with the one that the recorded hashes were made with.
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

// Depends on each word and on their order.
class Hash {
 public:
  void add(std::uint64_t word);
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325U;
};

// What is taken off the cycle of a pin's step before it is hashed: clocks by which the judged card is later than the
// recorded one.
struct Shift {
  std::int64_t start = 0;    // from the end of the first write of commands to the first step
  std::int64_t barrier = 0;  // more at each barrier (DWELL, END) before the step
};

struct StepHashes {
  std::uint64_t path = 0;
  std::uint64_t path_steps = 0;
  // Without them for programs with arcs: when they were recorded, rate and length of an arc's feed came from angles of
  // the C library, whose last bit may move a tick by a clock.
  std::optional<std::uint64_t> pins;
  std::uint64_t pin_steps = 0;
  std::uint64_t barriers = 0;
  // Clocks from the end of the first write of commands (configuration, whose accesses may come to take another time,
  // lies before) to the first step at a pin, shift taken off.
  std::int64_t start = 0;
  // Least time in clocks by which a path's commands were written before the last step of the path ahead: above 0 no
  // path had to wait for the host, so that the times at the pins are the card's own. None for a single path.
  std::optional<std::int64_t> lead;
};

// The path hash is taken over (command, tick, axis, direction) of each step. Of arcs that go out as chords only the
// pulses of each command and axis count: their ticks come from the arc's angle. An arc on the accumulator is integers
// from its centre (in 1/256 pulses) and ends on: its path ticks stay in. Steps of one tick, and those of one cycle, are
// taken in the order of the axes.
//
// The pin hash is taken over (cycle since the first step, axis, direction); the n-th step at an axis's pins is the n-th
// of that axis's path steps, whose command says how many barriers lie before it.
class StepHasher final : public driver::StepSink {
 public:
  explicit StepHasher(Shift shift) : shift_(shift) {}

  enum class Path { kNoArc, kArc, kChords };  // what the commands of a block are
  // A block whose commands follow, those commands, and when they were written.
  void block(Path path);
  void command(const driver::Command& command);
  void sent(std::uint64_t cycle);
  void path_step(const driver::PathStep& step) override;
  void pin_step(const driver::PinStep& step) override;

  // After the last step. Throws std::logic_error when the pins have made other steps than the paths.
  StepHashes finish();

 private:
  struct Sent {  // a command
    std::size_t block;
    std::uint64_t barriers;  // before it
    bool chord;
  };
  struct Waiting {  // a path step that the pin has yet to make
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
  std::vector<std::uint64_t> sent_at_;  // by block
  bool arcs_ = false;
  bool chords_ = false;  // of the block whose commands come
  StepHashes result_;

  Hash path_;
  std::vector<driver::PathStep> tick_;  // its steps
  Pulses chord_{};                      // of the command under way

  Hash pins_;
  std::array<std::deque<Waiting>, card_map::kMaxAxes> waiting_;
  std::vector<driver::PinStep> cycle_;     // its steps
  std::int64_t corrected_ = 0;             // time of that cycle, shift taken off, since the first write
  std::optional<std::size_t> last_block_;  // of the pins' steps
  std::uint64_t last_cycle_ = 0;
};

}  // namespace trammel::test
