// A straight line from the machine's present position to the start of a run. Nothing else moves the card.
#pragma once

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::app {

// Prints the line, and asks for permission on a terminal (`yes`: without asking). Then moves there at the speed of a
// jog. Does nothing if the machine is already there. `from`, `to`: pulses by axis of the card. Throws UsageError before
// any motion if the answer is no, or if nobody can be asked; run::ProgramError for a target beyond the machine's
// limits; and as run_until_signal() does.
void go_there(driver::Card& card, const machine::Machine& machine, const planner::Pulses& from,
              const planner::Pulses& to, bool yes);

}  // namespace trammel::app
