// The machine's place that a card keeps from one program to the next (trammel/driver/card_place.hpp), in the
// coordinates of a machine.
//
// Functions that take a card throw as driver::Card does, and are for the thread that uses it; the others are pure.
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

// A program may not begin where the card stands. what() says why and what to do.
class PlaceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using driver::CardPlace;
using driver::keep_place;
using driver::kNoScales;
using driver::kScalesInPulses;
using driver::read_card_place;

// Hash of what turns pulses into coordinates: axes, scales, directions, kinematics. Neither of the two values above.
std::uint32_t scales_of(const machine::Machine& machine);
// Whether coordinates of this machine may be read from the place; a place in pulses fits every machine.
bool scales_fit(const CardPlace& place, const machine::Machine& machine);

// Where the machine stands; zeros where no place was set. The card has an axis for each of the machine's motors.
gcode::Coordinates standing_at(const machine::Machine& machine, const CardPlace& place);
// Axes with a motor that is missing in `motors` (bit n: axis n of the card), as letters with blanks between; "" if
// none.
std::string axes_without(const machine::Machine& machine, std::uint8_t motors);

// How a program begins.
struct Start {
  gcode::Coordinates at{};
  machine::Machine machine;  // soft limits hold for homed axes alone
  std::string limits_off;    // letters of the axes whose soft limits do not hold, as axes_without()
};
// `trust`: a place that was lost is taken for the machine's. Throws PlaceError for a place that was lost, for one in
// other scales, and where the machine requires homed axes.
Start start_at(const machine::Machine& machine, const CardPlace& place, bool trust);
// The same for a line in pulses of the card's axes in `moved`.
void check_line(const machine::Machine& machine, const CardPlace& place, std::uint8_t moved, bool trust);

// Soft limits at the end of a line by `pulses`, by axis of the card. Throws PlaceError where the line would end beyond
// one, and further out than it begins. Gives back the letters of axes whose limits do not hold: those that are not
// homed, and all where the place is in other scales.
std::string check_line_end(const machine::Machine& machine, const CardPlace& place,
                           const std::vector<std::int64_t>& pulses);

// Bits of the machine's motors.
std::uint8_t motors_of(const machine::Machine& machine);
// Names of the card's axes, by number, for messages of faults: the letters of the machine's axes, then "second motor of
// Y". With coupled motors (CoreXY) these are the axes in whose tables of the machine file switches and drives stand.
std::vector<std::string> names_of_card_axes(const machine::Machine& machine);

// The machine's soft limits in the card, as its last guard: for each axis that has min or max, a valid place, and a
// motor of its own (with CoreXY X and Y have none, and their limits are the host's alone). An end that the machine does
// not give is as far away as the card can count. None where the place is in other scales; the others are switched off.
// The card's reaction to them becomes the machine's. Does nothing on a card without soft limits.
void guard_soft_limits(driver::Card& card, const machine::Machine& machine, const CardPlace& place);
// The same of homed axes alone, for a machine that is none of start_at().
void guard_homed_axes(driver::Card& card, const machine::Machine& machine, const CardPlace& place);

// Machine zero so that the axes in `named` (bit n: axis n of the machine) stand at `at`, mm; the other coordinates
// stay. Motors in `homed` (bit n: axis n of the card) count as homed, the others that move with a named axis do not.
// Throws PlaceError where the other axes' place does not tell where these stand.
void place_axes(driver::Card& card, const machine::Machine& machine, unsigned named, const gcode::Coordinates& at,
                std::uint8_t homed);

// Sets machine zero of the axes named by `letters` where the card stands, and whether they count as homed. Throws
// PlaceError for a letter that the machine lacks, and where the other axes' place does not tell where these stand.
void set_zero(driver::Card& card, const machine::Machine& machine, const std::string& letters, bool homed);

}  // namespace trammel::run
