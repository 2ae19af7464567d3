// A straight line from where the machine stands to where a run begins. Nobody else moves the card.
#pragma once

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::app {

// Prints the line, and asks on a terminal; `yes` answers. Then goes there at the speed of a jog. Nothing where the
// machine stands there already. `from`, `to`: pulses by axis of the card. Throws UsageError where the answer is no, or
// nobody can be asked, before anything moves; run::ProgramError for a target beyond the machine's limits; and as
// run_until_signal().
void go_there(driver::Card& card, const machine::Machine& machine, const planner::Pulses& from,
              const planner::Pulses& to, bool yes);

}  // namespace trammel::app
