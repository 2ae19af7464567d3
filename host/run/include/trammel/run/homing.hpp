// Homing: axes find their switches, and machine zero is set from them. An axis searches its switch, ramps to a stop
// behind it, backs off and approaches it again slowly. The captured edge determines the position (driver/captures.hpp),
// so neither ramps nor filters cost accuracy. Axes with the same number in `sequence` home together.
//
// During homing, soft limits and the limit switches named by `ignore_limits` are off. The machine's settings are
// restored at the end, even if homing fails. All axes to be homed count as not homed until all axes of their number in
// `sequence` have found their edges. If a later number fails, the earlier ones stay homed.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/machine_position.hpp"

namespace trammel::run {

// An axis cannot be homed. what() names axis, input and distance. The card is at rest.
class HomingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct HomedAxis {
  std::size_t axis = 0;  // axis of the machine
  // Positions of the switch's edge, mm (degrees) in the machine coordinates before homing: in the search, and the final
  // one.
  double search_edge = 0;
  double edge = 0;
  double squared_by = 0;  // distance by which the second motor was moved, mm
};

struct HomingOptions {
  std::function<void(const std::string&)> say;  // gets a line of text for each step of homing; none: no output
};

// Homes `axes` (of the machine), in ascending order of `sequence`. The card is configured for the machine and at rest;
// `position` is its position. Sets machine zero and HOMED of the axes' motors, and moves to their final positions. If
// axes share motors (CoreXY), a motor is homed when all of its axes are.
//
// Throws HomingError; driver::ArgumentError if an axis has no [homing] or the card lacks machine inputs or captures;
// driver::StoppedError if a stop is requested; driver::FaultError; and all that run::Jog throws. Not thread-safe.
std::vector<HomedAxis> home(driver::Card& card, const machine::Machine& machine, MachinePosition& position,
                            const std::vector<std::size_t>& axes, const HomingOptions& options = {});

}  // namespace trammel::run
