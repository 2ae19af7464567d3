// The actions of the operator, the machine's inputs and the bus during a program on a simulated card.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace trammel::simulation {

// An event at a time of the card: a new override, a hold, the end of a hold, a new level at an input, or the emergency
// stop pressed or released.
struct OperatorEvent {
  enum class Kind { kOverride, kHold, kResume, kInput, kEmergencyStop };
  Kind kind = Kind::kOverride;
  double seconds = 0;  // requested card time, from reset; 0 or more
  double percent = 0;  // kOverride: of the planned speed, 0 to RunOptions::max_percent
  unsigned input = 0;  // kInput: 0 to sim::kInputs - 1
  bool level = false;  // kInput; kEmergencyStop: pressed
};

struct Operation {
  double percent = 100;                                               // override from the start
  double rapid_percent = 100;                                         // override of rapids, 0 to 100
  std::vector<OperatorEvent> events;                                  // by time, ascending
  double bytes_per_second = std::numeric_limits<double>::infinity();  // speed of the bus, in card time; greater than 0
};

struct MadeEvent {
  OperatorEvent event;
  // Clock of the card: of a write, when it was answered and had taken effect; of an input, when it changed.
  std::uint64_t cycle = 0;
};

}  // namespace trammel::simulation
