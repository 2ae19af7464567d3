// What a card says of its state: STATUS, REFUSAL, a snapshot, and the counters in them. Plain data and pure functions,
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
  bool busy = false;          // something runs or is queued
  bool direct = false;        // a one-shot line runs
  bool path_active = false;   // a path is under way
  bool feed_active = false;   // a feed piece is under way
  bool held = false;          // the time base's ratio is 0
  bool ended = false;         // END was reached
  bool faulted = false;       // FAULT is not 0
  bool refused = false;       // REFUSAL is not 0
  bool snapshot = false;      // a snapshot is under way
  bool incomplete = false;    // the stream stands inside a command
  bool stopping = false;      // on its way to a stop: on a ramp, or the last pulses are made
  bool geometry_low = false;  // fewer halfwords queued than the queue's watermark
  bool feed_low = false;
  bool probed = false;        // a probe has tripped, until clear_probe()
  bool probe_missed = false;  // probing paths ended without an edge
  bool waiting = false;       // for an input
  bool underrun = false;      // the time base is held because the queues run dry
  bool stale = false;         // position streaming goes on without a new period
  bool button_hold = false;   // the feed hold button holds, until cycle start
  bool enabled = false;       // the drives are (EnableSequence)
  bool enable_waits = false;  // motion waits for them
  bool settled = false;       // at a ratio of 0 or stopped by a fault, for 31 clocks: each tick taken has made its
                              // steps, each step its pulse
};

// REFUSAL.
struct Refusal {
  std::uint8_t reason = 0;          // value of card_map::Reason, not 0
  std::uint8_t command_number = 0;  // of a stream command
  std::uint32_t address = 0;        // byte address of the access
};

// State of one clock.
struct Snapshot {
  std::uint64_t time = 0;                                   // clocks since reset
  Status status;                                            //
  std::uint32_t faults = 0;                                 // FAULT
  std::uint32_t rate = 0;                                   // 2^-32 feed ticks an enabled clock
  std::uint32_t ratio = 0;                                  // 2^-16, of the time base
  std::uint32_t geometry_begun = 0;                         // commands begun from the geometry queue since the last cut
  std::uint32_t feed_begun = 0;                             // and from the feed queue
  std::array<std::int32_t, card_map::kMaxAxes> position{};  // pulses, wrapping; 0 for axes that the card lacks
};

// Where the last stop has left the card, latched before it dropped anything: a fault's when every pulse has come out,
// an abort's in its own clock.
struct Rest {
  std::uint64_t time = 0;            // clocks since reset; 0: no stop since then
  Status status;                     //
  std::uint32_t faults = 0;          // FAULT
  std::uint32_t geometry_begun = 0;  // commands begun from the geometry queue since the cut before
  std::uint32_t feed_begun = 0;      // and from the feed queue
  // Ticks that the command begun last has not taken of its N (a direct move: enabled clocks of its length), 40 bits; 0
  // where no path is under way, at a barrier too, and where it is not exact.
  std::uint64_t ticks_left = 0;
  std::array<std::int32_t, card_map::kMaxAxes> position{};  // pulses, wrapping; 0 for axes that the card lacks

  // `position` is that of all ticks taken, and no pulse has come since. Of an abort in motion it is not.
  bool exact() const { return status.settled; }
};

// Pulses from one position of an axis to another. The counters wrap: for distances below 2^31.
constexpr std::int32_t pulses_between(std::int32_t from, std::int32_t to) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}

// What the card knows of where its axes stand; bit n: axis n.
struct Place {
  std::uint8_t valid = 0;  // POSITION less MACHINE_ZERO says where the axis stands
  std::uint8_t homed = 0;  // the host has found the axis's place at its switch
};

// A count of the card, which has 32 bits, carried on from `before`: for less than 2^32 more.
constexpr std::uint64_t count_after(std::uint64_t before, std::uint32_t counter) {
  return before + (counter - static_cast<std::uint32_t>(before));
}

// Names of the fault bits, for messages: "step fault of axis 2, LIMIT (axis 0 minus)". `limit_state`: the register
// LIMIT_STATE, 0 where it is not known. `axes`: names of the card's axes, by number; others are "axis N".
std::string describe_faults(std::uint32_t faults, std::optional<std::uint32_t> limit_state = std::nullopt,
                            const std::vector<std::string>& axes = {});
// Name of a refusal reason and what it means.
std::string describe_reason(std::uint8_t reason);

}  // namespace trammel::driver
