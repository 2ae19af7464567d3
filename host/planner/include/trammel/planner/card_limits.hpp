// The properties of the card that the planner needs. Plain data and pure functions, thread-safe.
#pragma once

#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::planner {

struct CardLimits {
  std::uint32_t clock_hz = 0;           // > 0
  unsigned axes = 4;                    // of the card, 1 .. 8
  bool accumulator = true;              // has the deviation accumulator
  bool classes = false;                 // feed pieces tell rapids from feeds, so that each has its own override
  bool arc_generator = true;            // has the arc generator
  std::uint32_t geometry_depth = 4096;  // halfwords in the queue
  std::uint32_t feed_depth = 2560;      // halfwords in the queue
  bool eight_directions = false;        // the accumulator can make arcs in 8 directions, and does
  unsigned outputs = 0;                 // that path commands can switch, up to 16; 0: no such commands
  bool pwm = false;                     // outputs may carry pulses
  bool slew_shifts = false;             // feed pieces can speed up the slew of the time base (FeedCommand::slew_shift)
};

// How arcs are made: by the first of these that the card has and that can make the arc. Only the arc generator and
// chords make helices. kEightDirections is the accumulator, in 8 directions if the card has them.
enum class ArcsBy { kGenerator, kEightDirections, kAccumulator, kChords };

// The card without the methods for arcs that precede `arcs`, and without 8 directions unless `arcs` asks for them.
CardLimits with_arcs_by(CardLimits card, ArcsBy arcs);

// The identification says only whether the card has outputs: `outputs` is then 16. run::configure() asks the card for
// their number.
CardLimits limits_of(const driver::Identification& card);

// The settings that determine the card's slew.
using machine::hold_seconds;
using machine::hold_share;

// hold_seconds() in clocks, with the card's resolution: SLEW is a whole number, so a hold may be longer by up to
// 1/SLEW. At most driver::kSlowestSlew. `clock_hz` > 0.
double hold_clocks(const machine::Machine& machine, double clock_hz);

// An axis's settings on the card: step times rounded up to whole nanoseconds.
driver::AxisSettings settings_of(const machine::MachineAxis& axis);

}  // namespace trammel::planner
