// Captures: time and positions at an edge of an input, latched at the edge itself and not when its filter confirms it.
// Plain data, thread-safe.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/driver/card_state.hpp"

namespace trammel::driver {

inline constexpr unsigned kCaptureUnits = 4;  // largest number of capture units on a card

// The edges that a unit captures, and what it does with them.
struct CaptureSelect {
  unsigned input = 0;
  bool to_active = true;  // edges to the active level, after polarity
  bool to_inactive = false;
  bool continuous = false;  // the unit continues after each capture; else it takes one only
  bool queue = false;       // captures go straight into the card's queue; the unit keeps none
};

// The bits of CAPTURE_STATE that belong to one unit.
struct CaptureState {
  bool pending = false;  // an edge was seen and is not confirmed, rejected or written yet
  bool valid = false;    // a capture is latched
  // A confirmed edge was lost because the previous capture was still latched; in a unit with `queue`, because the queue
  // was full or the edges came too fast.
  bool overrun = false;
  bool active = false;  // level after the captured edge
};
struct CaptureStates {
  std::array<CaptureState, kCaptureUnits> units{};
  std::uint16_t snapshots = 0;  // taken for captures, including rejected ones; modulo 2^16
};

struct Capture {
  Snapshot at;           // state at the edge
  bool active = false;   // level after the edge
  bool overrun = false;  // later edges were lost
};

// CAPTURE_QUEUE.
struct CaptureQueue {
  unsigned captures = 0;   // captures in the queue, 0 to 16
  std::uint16_t lost = 0;  // captures lost since reset because the queue was full; modulo 2^16
};

struct QueuedCapture {
  Snapshot at;  // state at the edge
  unsigned unit = 0;
  bool active = false;  // level after the edge
};

}  // namespace trammel::driver
