// What the operator, the machine's inputs and the bus do while a program runs on a simulated card.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace trammel::simulation {

// At a time of the card's: a new override, a hold, its end, a new level at an input, or the emergency stop pressed or
// released.
struct OperatorEvent {
  enum class Kind { kOverride, kHold, kResume, kInput, kEmergencyStop };
  Kind kind = Kind::kOverride;
  double seconds = 0;  // of card time from reset, 0 or more; asked for
  double percent = 0;  // kOverride: of the planned speed, 0 to RunOptions::max_percent
  unsigned input = 0;  // kInput: 0 to sim::kInputs - 1
  bool level = false;  // kInput; kEmergencyStop: pressed
};

struct Operation {
  double percent = 100;                                               // override from the start on
  double rapid_percent = 100;                                         // of rapids, 0 to 100
  std::vector<OperatorEvent> events;                                  // in order of time
  double bytes_per_second = std::numeric_limits<double>::infinity();  // of the bus, in card time; greater than 0
};

struct MadeEvent {
  OperatorEvent event;
  // Clock of the card in which the write was answered, and had taken effect; of an input, in which it changed.
  std::uint64_t cycle = 0;
};

}  // namespace trammel::simulation
