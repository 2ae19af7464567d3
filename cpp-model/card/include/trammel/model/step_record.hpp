// The record of steps: finds the command and tick of each path step, and the time of each step at the pins. Not a
// part of the card.
//
// Commands get their numbers when the checker accepts them and become current when they begin; ticks count as they
// are taken. A path step shows 7 clocks after its tick. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "trammel/card_map.hpp"

namespace trammel::model {

// Receives steps in order of time.
class CardSteps {
 public:
  virtual ~CardSteps() = default;
  // A step at the pins of `axis`; `cycle` counts rising edges since reset, including that of the leading edge.
  virtual void pin_step(std::uint64_t cycle, unsigned axis, int direction) = 0;
  // A step of the path; it is at its shaper after edge `cycle`. `command`: number in the stream, from 0 at reset or a
  // cut, not wrapped; barriers and feed pieces count; 0 in direct mode. `tick`: number in its path, from 1, of feed
  // ticks for a line (enabled clocks in direct mode) and of path ticks for an arc.
  virtual void path_step(std::uint64_t cycle, std::uint64_t command, std::uint64_t tick, unsigned axis,
                         int direction) = 0;
  // The outputs after edge `cycle`, if they have changed.
  virtual void outputs(std::uint64_t /*cycle*/, std::uint16_t /*before*/, std::uint16_t /*levels*/) {}
};

class StepRecord {
 public:
  static constexpr std::uint64_t kTickToStep = 7;  // clocks from a tick that shows to its step on the path
  static constexpr std::uint64_t kToAxes = 3;      // the part of them until the tick leaves for the axes

  void set_steps(CardSteps* steps) { steps_ = steps; }

  // Resets everything except the receiver; `output_idle`: levels of the outputs in reset.
  void reset(std::uint16_t output_idle) {
    accepted_ = command_ = taken_ = arc_taken_ = 0;
    geometry_.clear();
    takes_ = {};
    position_ = {};
    outputs_ = output_idle;
  }

  void cut() {
    accepted_ = 0;
    geometry_.clear();
  }
  void accepted(bool to_geometry) {
    if (to_geometry) geometry_.push_back(accepted_);
    ++accepted_;
  }
  void command_begins() {
    if (geometry_.empty()) return;
    command_ = geometry_.front();
    geometry_.pop_front();
    taken_ = arc_taken_ = 0;
  }
  void direct_begins() { command_ = taken_ = 0; }
  // A tick shows after edge `cycle`.
  void tick(std::uint64_t cycle) { place(cycle, ++taken_); }
  void arc_tick() { ++arc_taken_; }
  // A path tick of an arc in chords shows after edge `cycle`, on its way to the axes. A line's tick reaches the same
  // place kToAxes clocks after it was taken.
  void chord_tick(std::uint64_t cycle) { place(cycle - kToAxes, ++arc_taken_); }

  void pin(std::uint64_t cycle, unsigned axis, std::uint32_t position) {
    if (position == position_[axis]) return;
    if (steps_ != nullptr) steps_->pin_step(cycle, axis, static_cast<std::int32_t>(position - position_[axis]));
    position_[axis] = position;
  }
  void outputs(std::uint64_t cycle, std::uint16_t levels) {
    if (levels == outputs_) return;
    if (steps_ != nullptr) steps_->outputs(cycle, outputs_, levels);
    outputs_ = levels;
  }
  void line_step(std::uint64_t cycle, unsigned axis, bool backwards) {
    const Take& take = shown_after(cycle - kTickToStep);
    if (steps_ != nullptr) steps_->path_step(cycle, take.command, take.tick, axis, backwards ? -1 : 1);
  }
  void arc_step(std::uint64_t cycle, unsigned axis, bool backwards) {
    if (steps_ != nullptr) steps_->path_step(cycle, command_, arc_taken_, axis, backwards ? -1 : 1);
  }

  // For jumps. taken(): ticks of the present path so far; take(): adds more at once; place(): sets the tick that
  // shows after edge `cycle`.
  std::uint64_t taken() const { return taken_; }
  void take(std::uint64_t ticks) { taken_ += ticks; }
  std::uint64_t path_ticks() const { return arc_taken_; }
  void take_path_ticks(std::uint64_t ticks) { arc_taken_ += ticks; }
  void place(std::uint64_t cycle, std::uint64_t tick) { shown_after(cycle) = {command_, tick}; }

 private:
  struct Take {
    std::uint64_t command = 0;
    std::uint64_t tick = 0;
  };
  Take& shown_after(std::uint64_t cycle) { return takes_[static_cast<std::size_t>(cycle % takes_.size())]; }

  CardSteps* steps_ = nullptr;                                // not owned
  std::uint64_t accepted_ = 0;                                // commands that the checker has accepted
  std::deque<std::uint64_t> geometry_;                        // numbers of the commands in the geometry queue
  std::uint64_t command_ = 0;                                 // number of the command that began last
  std::uint64_t taken_ = 0;                                   // ticks of the path taken so far
  std::uint64_t arc_taken_ = 0;                               // path ticks of the arc taken so far
  std::array<Take, 16> takes_{};                              // by the cycle in which the tick shows
  std::array<std::uint32_t, card_map::kMaxAxes> position_{};  // positions as reported
  std::uint16_t outputs_ = 0;                                 // levels as reported
};

}  // namespace trammel::model
