// What the planner needs to know of the card. Plain data and pure functions, thread-safe.
#pragma once

#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::planner {

struct CardLimits {
  std::uint32_t clock_hz = 0;           // > 0
  unsigned axes = 4;                    // of the card, 1 .. 8
  bool accumulator = true;              // the deviation accumulator is there
  bool classes = false;                 // pieces of rapids say so, for an override of their own
  bool arc_generator = true;            // the arc generator is there
  std::uint32_t geometry_depth = 4096;  // halfwords of the queues
  std::uint32_t feed_depth = 2560;
  bool eight_directions = false;  // arcs on the accumulator may go in 8 directions, and shall
  unsigned outputs = 0;           // that commands on the path can switch, up to 16; 0: it has no such commands
  bool pwm = false;               // outputs may carry pulses
  bool slew_shifts = false;       // a piece may say that the time base slews faster (FeedCommand::slew_shift)
};

// Where arcs go: to what is there, the first of these that can; helices to the generator or out as lines.
// kEightDirections is the accumulator, in 8 directions where the card has them.
enum class ArcsBy { kGenerator, kEightDirections, kAccumulator, kChords };

// As if the card had nothing for arcs that comes before `arcs`.
CardLimits with_arcs_by(CardLimits card, ArcsBy arcs);

// Of outputs it knows whether there are any, not how many: run::configure() asks the card for that.
CardLimits limits_of(const driver::Identification& card);

// The card's slew follows from them.
using machine::hold_seconds;
using machine::hold_share;

// The same in clocks, as the card's SLEW has it: a whole number, so the hold may take longer by up to a part in SLEW.
// At most driver::kSlowestSlew. `clock_hz` > 0.
double hold_clocks(const machine::Machine& machine, double clock_hz);

// An axis's settings on the card: step times rounded up to whole nanoseconds.
driver::AxisSettings settings_of(const machine::MachineAxis& axis);

}  // namespace trammel::planner
