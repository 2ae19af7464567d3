// The state that a card reports: STATUS, REFUSAL, snapshots, and the counters in them. Plain data and pure functions,
// thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/card_map.hpp"

namespace trammel::driver {

// STATUS.
struct Status {
  bool busy = false;          // something is under way or queued
  bool direct = false;        // a one-shot line (direct move) is under way
  bool path_active = false;   // a path or a direct move is under way
  bool feed_active = false;   // a feed piece is under way
  bool held = false;          // the time base's ratio is 0
  bool ended = false;         // END was executed, and nothing has begun since
  bool faulted = false;       // FAULT is not 0
  bool refused = false;       // REFUSAL is not 0
  bool snapshot = false;      // a snapshot is under way
  bool incomplete = false;    // the stream has written part of a command
  bool stopping = false;      // the card is stopping: it is on a ramp, or completes the last pulses
  bool geometry_low = false;  // fewer halfwords queued than the queue's watermark
  bool feed_low = false;      // the same for the feed queue
  bool probed = false;        // a probe has tripped; cleared by clear_probe()
  bool probe_missed = false;  // probing paths ended without an edge
  bool waiting = false;       // the card waits for an input
  bool underrun = false;      // the under-run hold is active, or a piece that begins from rest waits for commands
  bool stale = false;         // position streaming continues without a new period
  bool button_hold = false;   // the feed hold input holds the card until cycle start
  bool enabled = false;       // the drives are enabled (EnableSequence)
  bool enable_waits = false;  // motion waits for the enable of the drives
  // For 31 clocks, at a ratio of 0 or stopped by a fault: every tick taken has made its steps, every step its pulse.
  bool settled = false;
};

// REFUSAL.
struct Refusal {
  std::uint8_t reason = 0;          // value of card_map::Reason, not 0
  std::uint8_t command_number = 0;  // number of the refused stream command
  std::uint32_t address = 0;        // byte address of the refused access
};

// The state in one clock.
struct Snapshot {
  std::uint64_t time = 0;                                   // clocks since reset
  Status status;                                            //
  std::uint32_t faults = 0;                                 // FAULT
  std::uint32_t rate = 0;                                   // 2^-32 feed ticks per enabled clock
  std::uint32_t ratio = 0;                                  // ratio of the time base, 2^-16
  std::uint32_t geometry_begun = 0;                         // commands begun from the geometry queue since the last cut
  std::uint32_t feed_begun = 0;                             // the same from the feed queue
  std::array<std::int32_t, card_map::kMaxAxes> position{};  // pulses, wrapping; 0 for axes that the card lacks
};

// The state in which the last stop left the card (area REST), latched before the stop dropped anything: for a fault,
// after the last pulse; for an abort, in the clock of the abort.
struct Rest {
  std::uint64_t time = 0;            // clocks since reset; 0: no stop since the reset
  Status status;                     //
  std::uint32_t faults = 0;          // FAULT
  std::uint32_t geometry_begun = 0;  // commands begun from the geometry queue since the previous cut
  std::uint32_t feed_begun = 0;      // the same from the feed queue
  // Ticks of N that the last begun command has not taken yet, 40 bits (direct move: enabled clocks of its length). 0 if
  // no path is under way, also at a barrier, and if exact() is false.
  std::uint64_t ticks_left = 0;
  std::array<std::int32_t, card_map::kMaxAxes> position{};  // pulses, wrapping; 0 for axes that the card lacks

  // Whether `position` includes the steps of all ticks taken, with no pulse after it. False for an abort in motion.
  bool exact() const { return status.settled; }
};

// Pulses from one position of an axis to another. The counters wrap; the result is correct for distances below 2^31.
constexpr std::int32_t pulses_between(std::int32_t from, std::int32_t to) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}

// What the card knows of the positions of its axes; bit n: axis n.
struct Place {
  std::uint8_t valid = 0;  // POSITION - MACHINE_ZERO is the axis's position
  std::uint8_t homed = 0;  // the host has referenced the axis at its switch
};

// Extends a 32-bit counter of the card to 64 bits: the value at or after `before`. Correct if the counter advanced by
// less than 2^32.
constexpr std::uint64_t count_after(std::uint64_t before, std::uint32_t counter) {
  return before + (counter - static_cast<std::uint32_t>(before));
}

// Names of the fault bits, for messages: "step fault of axis 2, LIMIT (axis 0 minus)". `limit_state`: value of
// LIMIT_STATE, 0 if unknown. `axes`: names of the card's axes, by number; an axis without a name is "axis N".
std::string describe_faults(std::uint32_t faults, std::optional<std::uint32_t> limit_state = std::nullopt,
                            const std::vector<std::string>& axes = {});
// Name and explanation of a refusal reason.
std::string describe_reason(std::uint8_t reason);

}  // namespace trammel::driver
