// A path operation of LinuxCNC as a line of G-code, which the project's own reader, planner and card then take. The
// numbers are written with as many digits as bring the same double back. Pure functions, thread-safe.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/gcode/motion.hpp"
#include "trammel/linuxcnc/shared_region.h"
#include "trammel/machine/machine.hpp"

namespace trammel::linuxcnc {

// By axis letter, X Y Z A B C U V W: machine units of LinuxCNC (mm or inch), degrees.
using Pose = std::array<double, TRAMMEL_POSE>;
inline constexpr std::string_view kPoseLetters = "XYZABCUVW";

// What an operation asks for and cannot be: one line, without its place.
class PathRefusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// LinuxCNC's linear units. Angles are degrees in either.
enum class PathUnits { kMillimetres, kInches };

// Shortest decimal in fixed notation that reads back as `value`. Throws PathRefusal for what is no finite number.
std::string path_number(double value);

// Units and path control of the operation, which hold until others are given: "G21 G64 P0.05". A line of its own, since
// P means something else beside an arc.
std::string path_modes(const trammel_operation& operation, PathUnits units);
// Outputs that the operation switches before it moves, "M62 P3", each on a line of its own; those that the machine file
// does not name switch nothing at the card.
std::vector<std::string> output_lines(const trammel_operation& operation, const machine::Machine& machine);
// Plane, motion, axis words, feed; "" where nothing moves. `from`: where the operation begins, which is where the one
// before ended. Throws PathRefusal for an operation that is no TRAMMEL_LINE, TRAMMEL_ARC or TRAMMEL_SWITCH, one that
// moves an axis the machine lacks, a feed of 0, an arc outside the main planes.
std::string path_line(const trammel_operation& operation, const Pose& from, const machine::Machine& machine);

bool is_probe(const trammel_operation& operation);
Pose end_of(const trammel_operation& operation);
// Machine coordinates, mm and degrees, of a pose, and back. Letters that the machine lacks are 0.
gcode::Coordinates coordinates_of(const Pose& pose, const machine::Machine& machine, PathUnits units);
Pose pose_of(const gcode::Coordinates& coordinates, const machine::Machine& machine, PathUnits units);

}  // namespace trammel::linuxcnc
