// The record of steps: which command and tick a path step belongs to, and which pin moved when. No part of the card.
//
// Commands are counted as the checker accepts them, and taken up as they begin; ticks as they are taken. A path step
// shows 7 clocks after its tick. Not thread-safe.
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
  // A step at the pins of `axis`; `cycle` counts rising edges since reset, that of the leading edge included.
  virtual void pin_step(std::uint64_t cycle, unsigned axis, int direction) = 0;
  // A step of the path, at its shaper after edge `cycle`. `command`: number in the stream, from 0 at reset or a cut,
  // not wrapped, barriers and feed pieces counted; 0 in direct mode. `tick`: of its path, from 1; feed ticks of a line
  // (enabled clocks in direct mode), path ticks of an arc.
  virtual void path_step(std::uint64_t cycle, std::uint64_t command, std::uint64_t tick, unsigned axis,
                         int direction) = 0;
  // Outputs after edge `cycle`, where they are not what they were.
  virtual void outputs(std::uint64_t /*cycle*/, std::uint16_t /*before*/, std::uint16_t /*levels*/) {}
};

class StepRecord {
 public:
  static constexpr std::uint64_t kTickToStep = 7;  // clocks from a tick that shows to its step on the path
  static constexpr std::uint64_t kToAxes = 3;      // of these, to where it leaves for the axes

  void set_steps(CardSteps* steps) { steps_ = steps; }

  // All but the receiver as after reset; `output_idle`: levels of the outputs then.
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
  // A path tick of an arc in chords shows after edge `cycle`, on its way to the axes, where a line's comes kToAxes
  // clocks after it was taken.
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

  // For jumps: ticks of the present path taken so far; `ticks` more at once; the tick that shows after edge `cycle`.
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
  std::uint64_t accepted_ = 0;                                // commands that the checker let in
  std::deque<std::uint64_t> geometry_;                        // numbers of those in the geometry queue
  std::uint64_t command_ = 0;                                 // begun last
  std::uint64_t taken_ = 0;                                   // ticks of the path
  std::uint64_t arc_taken_ = 0;                               // path ticks of the arc
  std::array<Take, 16> takes_{};                              // by the cycle in which the tick shows
  std::array<std::uint32_t, card_map::kMaxAxes> position_{};  // as shown
  std::uint16_t outputs_ = 0;                                 // as shown
};

}  // namespace trammel::model
