// Converts a path operation of LinuxCNC to a line of G-code, which the project's own reader, planner and card then
// execute. Numbers are written with enough digits to reproduce the same double. Pure functions, thread-safe.
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

// The operation requests something impossible. what() is one line without the position.
class PathRefusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// LinuxCNC's linear units. Angles are degrees in either.
enum class PathUnits { kMillimetres, kInches };

// Shortest decimal in fixed notation that reads back as `value`. Throws PathRefusal for a value that is not finite.
std::string path_number(double value);

// Units and path control of the operation, which stay in force: "G21 G64 P0.05". A separate line, because P has another
// meaning in a line with an arc.
std::string path_modes(const trammel_operation& operation, PathUnits units);
// Outputs that the operation switches before it moves, "M62 P3", one line each. Outputs that the machine file does not
// name switch nothing at the card.
std::vector<std::string> output_lines(const trammel_operation& operation, const machine::Machine& machine);
// Plane, motion, axis words, feed; "" if nothing moves. `from`: the start of the operation, which is the end of the
// previous one. Throws PathRefusal for an operation that is not TRAMMEL_LINE, TRAMMEL_ARC or TRAMMEL_SWITCH, for a
// motion of an axis that the machine lacks, for a feed of 0, and for an arc outside the main planes.
std::string path_line(const trammel_operation& operation, const Pose& from, const machine::Machine& machine);

bool is_probe(const trammel_operation& operation);
Pose end_of(const trammel_operation& operation);
// Conversion between a pose and machine coordinates in mm and degrees. Letters that the machine lacks are 0.
gcode::Coordinates coordinates_of(const Pose& pose, const machine::Machine& machine, PathUnits units);
Pose pose_of(const gcode::Coordinates& coordinates, const machine::Machine& machine, PathUnits units);

}  // namespace trammel::linuxcnc
