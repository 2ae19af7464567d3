// Homing: axes find their switches, and with them machine zero. An axis searches its switch, ramps to a stop behind it,
// backs off and comes again slowly; what counts is the captured edge (driver/captures.hpp), so that no ramp and no
// filter costs accuracy. Axes with the same number in `sequence` home together.
//
// Meanwhile soft limits are off, and so is what `ignore_limits` names; the machine's settings hold again at the end,
// also where homing fails. An axis that is being homed counts as not homed, until all of its number in `sequence` have
// come to their edges; where a later number fails these stay homed.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/machine_position.hpp"

namespace trammel::run {

// An axis cannot be homed. what() names axis, input and distance. The card stands.
class HomingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct HomedAxis {
  std::size_t axis = 0;  // of the machine
  // Where the edge came, mm (degrees) in machine coordinates as they were counted before: in the search, and the one
  // that counts.
  double search_edge = 0;
  double edge = 0;
  double squared_by = 0;  // mm that the second motor was moved by
};

struct HomingOptions {
  std::function<void(const std::string&)> say;  // what is done now, a line each; none: nothing is said
};

// Homes `axes` (of the machine), by rising sequence. The card is configured for the machine and stands, `position` is
// where it stands. Sets machine zero and HOMED of their motors, and goes to their final positions. With axes that share
// motors (CoreXY) a motor is homed when all of its axes are.
//
// Throws HomingError; driver::ArgumentError where an axis has no [homing] or the card lacks machine inputs or captures;
// driver::StoppedError where somebody stops it, driver::FaultError and what run::Jog throws. Not thread-safe.
std::vector<HomedAxis> home(driver::Card& card, const machine::Machine& machine, MachinePosition& position,
                            const std::vector<std::size_t>& axes, const HomingOptions& options = {});

}  // namespace trammel::run
