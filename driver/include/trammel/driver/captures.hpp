// Captures: time and positions of an input's edge, taken at the edge and not at the end of its filter. Plain data,
// thread-safe.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/driver/card_state.hpp"

namespace trammel::driver {

inline constexpr unsigned kCaptureUnits = 4;  // of a card, at most

// What a unit watches for.
struct CaptureSelect {
  unsigned input = 0;
  bool to_active = true;  // edges to the active level, after polarity
  bool to_inactive = false;
  bool continuous = false;  // the unit goes on after each capture; else it takes one
  bool queue = false;       // captures go into the queue at once, on cards that have one; none stands with the unit
};

// CAPTURE_STATE, of one unit.
struct CaptureState {
  bool pending = false;  // an edge has come, and is not confirmed, withdrawn or written yet
  bool valid = false;    // a capture stands
  bool overrun = false;  // a confirmed edge was lost, since a capture stood when it came; of a unit with `queue` since
                         // that was full, or since the edges came too fast
  bool active = false;   // the level that the captured edge led to
};
struct CaptureStates {
  std::array<CaptureState, kCaptureUnits> units{};
  std::uint16_t snapshots = 0;  // taken for captures, withdrawn ones too; counts modulo 2^16
};

struct Capture {
  Snapshot at;           // of the edge
  bool active = false;   // the level that it led to
  bool overrun = false;  // further edges were lost behind it
};

// CAPTURE_QUEUE.
struct CaptureQueue {
  unsigned captures = 0;   // in it, 0 to 16
  std::uint16_t lost = 0;  // since reset, because it was full; counts modulo 2^16
};

struct QueuedCapture {
  Snapshot at;  // of the edge
  unsigned unit = 0;
  bool active = false;  // the level that the edge led to
};

}  // namespace trammel::driver
