// The machine's place, which the card keeps from one program to the next (trammel/driver/card_place.hpp), in the
// coordinates of a machine.
//
// Functions that take a card throw as driver::Card does, and may be called only from the thread that uses the card; the
// others are pure.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/driver/card_place.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::run {

// A program may not begin at the machine's present place. what() gives the reason and the remedy.
class PlaceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using driver::CardPlace;
using driver::keep_place;
using driver::kNoScales;
using driver::kScalesInPulses;
using driver::read_card_place;

// Hash of the data that turn pulses into coordinates: axes, scales, directions, kinematics. It never equals kNoScales
// or kScalesInPulses.
std::uint32_t scales_of(const machine::Machine& machine);
// Whether the place can be converted to coordinates of this machine. A place in pulses fits every machine.
bool scales_fit(const CardPlace& place, const machine::Machine& machine);

// The machine's coordinates at this place; zeros if no place was set. The card has an axis for each of the machine's
// motors.
gcode::Coordinates standing_at(const machine::Machine& machine, const CardPlace& place);
// Letters, separated by blanks, of the axes with a motor that is missing in `motors` (bit n: axis n of the card); "" if
// there are none.
std::string axes_without(const machine::Machine& machine, std::uint8_t motors);

// The starting conditions of a program.
struct Start {
  gcode::Coordinates at{};
  machine::Machine machine;  // with soft limits for homed axes only
  std::string limits_off;    // letters of the axes whose soft limits are not enforced, in the format of axes_without()
};
// `trust`: accept a lost place as the machine's place. Throws PlaceError if the place is lost and `trust` is false, if
// the place is in other scales, or if the machine requires homed axes and an axis is not homed.
Start start_at(const machine::Machine& machine, const CardPlace& place, bool trust);
// The same check, without that of the scales, for a line in pulses that moves the card's axes in `moved`.
void check_line(const machine::Machine& machine, const CardPlace& place, std::uint8_t moved, bool trust);

// Checks the soft limits at the end of a line by `pulses`, which is indexed by axis of the card. Throws PlaceError if
// the line would end beyond a limit and further out than it begins. Returns the letters of the axes whose limits are
// not enforced: axes that are not homed, or all axes if the place is in other scales.
std::string check_line_end(const machine::Machine& machine, const CardPlace& place,
                           const std::vector<std::int64_t>& pulses);

// One bit for each motor of the machine (bit n: axis n of the card).
std::uint8_t motors_of(const machine::Machine& machine);
// Names of the card's axes, by number, for fault messages: first the letters of the machine's axes, then entries such
// as "second motor of Y". With coupled motors (CoreXY), a motor has the name of the axis whose table in the machine
// file assigns its switches and drive.
std::vector<std::string> names_of_card_axes(const machine::Machine& machine);

// Writes the machine's soft limits to the card, as the last guard: for each axis that has min or max, a valid place,
// and a motor of its own. With CoreXY, X and Y have no motor of their own, so only the host enforces their limits. If
// the machine gives only one end, the other end is as far away as the card can represent. If the place is in other
// scales, no limit is written. The limits of all other axes are switched off. Also sets the card's reaction to a soft
// limit as in the machine file. Does nothing on a card without soft limits.
void guard_soft_limits(driver::Card& card, const machine::Machine& machine, const CardPlace& place);
// The same for homed axes only, for a machine that does not come from start_at().
void guard_homed_axes(driver::Card& card, const machine::Machine& machine, const CardPlace& place);

// Sets machine zero so that the axes in `named` (bit n: axis n of the machine) are at the coordinates `at`, in mm; the
// other coordinates do not change. Motors in `homed` (bit n: axis n of the card) become homed; the other motors that
// move with a named axis become not homed. Throws PlaceError if the place is in other scales and not all axes are
// named, or if a named axis shares a motor whose place was lost with an axis that is not named.
void place_axes(driver::Card& card, const machine::Machine& machine, unsigned named, const gcode::Coordinates& at,
                std::uint8_t homed);

// Sets machine zero of the axes named by `letters` to the card's present position, and sets whether they are homed.
// Throws PlaceError for a letter that the machine lacks, and as place_axes() does.
void set_zero(driver::Card& card, const machine::Machine& machine, const std::string& letters, bool homed);

}  // namespace trammel::run
