// Golden model of the queue of captures, rtl/io/capture_fifo.sv. It stores up to 16 captures, each with a copy of the
// area to which the unit's snapshot was written; a capture that arrives when it is full is lost. The host's view is
// one clock late. Not thread-safe; no errors are reported.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class CaptureFifo {
 public:
  static constexpr unsigned kCaptures = 16;
  static constexpr unsigned kWords = 16;  // words per area
  using Area = std::array<std::uint32_t, kWords>;

  struct Inputs {
    std::uint8_t passed = 0;  // levels, a bit per unit: the unit hands on a capture
    std::uint8_t edges = 0;   // bit per unit: its edge led to the active level
    Setting setting;
  };
  struct Capture {
    Area at{};
    unsigned unit = 0;
    bool active = false;
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::array<Capture, kCaptures> captures{};  // index: number of the capture, modulo 16
    unsigned count = 0;                         // 0 .. 16
    unsigned dropped = 0;  // captures that the host has dropped, modulo 16: the number of the oldest one
    std::uint16_t lost = 0;
    // The host's view.
    std::uint32_t word = 0;
    unsigned shown = 0;  // number of the oldest capture
  };

  // The unit whose capture is queued or lost in a clock with these inputs: the lowest bit set, 4 if there is none.
  static unsigned unit_of(std::uint8_t passed) {
    unsigned unit = 0;
    while (unit < 4 && (passed >> unit & 1) == 0) ++unit;
    return unit;
  }
  // The same unit as a mask, 0 if there is none.
  static std::uint8_t queued(std::uint8_t passed) { return static_cast<std::uint8_t>(1U << unit_of(passed) & 0xF); }
  bool full() const { return state_.count == kCaptures; }

  // One rising edge. `area`: kWords words of the area of unit_of(in.passed); not read if no unit hands on a capture.
  void clock(const Inputs& in, const std::uint32_t* area) {
    state_.word = seen();
    state_.shown = state_.dropped;
    const bool drops = in.setting.set && in.setting.address == card_map::reg::kCaptureNext && state_.count != 0 &&
                       in.setting.data % kCaptures == state_.dropped;
    const bool was_full = full();
    if (in.passed != 0 && was_full) ++state_.lost;
    if (in.passed != 0 && !was_full) {
      Capture& last = state_.captures[(state_.dropped + state_.count++) % kCaptures];
      last.unit = unit_of(in.passed);
      last.active = (in.edges >> last.unit & 1) != 0;
      for (unsigned word = 0; word < kWords; ++word) last.at[word] = area[word];
    }
    if (drops) {
      state_.dropped = (state_.dropped + 1) % kCaptures;
      --state_.count;
    }
  }

  // The value of register CAPTURE_QUEUE.
  std::uint32_t word() const { return state_.word; }
  // A word of CAPTURE_HEAD, the oldest capture; 0 if the queue is empty.
  std::uint32_t oldest(unsigned word) const {
    const bool there = (state_.word & card_map::field::kCaptureQueueCaptures) != 0;
    return there ? state_.captures[state_.shown].at[word] : 0;
  }
  // The next clock() changes nothing if no event comes.
  bool rests() const { return state_.word == seen() && state_.shown == state_.dropped; }

  const State& state() const { return state_; }

 private:
  std::uint32_t seen() const {
    namespace field = card_map::field;
    std::uint32_t word = state_.count | state_.dropped << field::kCaptureQueueOldestShift |
                         std::uint32_t{state_.lost} << field::kCaptureQueueLostShift;
    if (state_.count == 0) return word;
    const Capture& first = state_.captures[state_.dropped];
    if (first.active) word |= field::kCaptureQueueActive;
    return word | first.unit << field::kCaptureQueueUnitNumberShift;
  }

  State state_;
};

}  // namespace trammel::model
