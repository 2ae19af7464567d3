#include "trammel/linuxcnc/path_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>

namespace trammel::linuxcnc {
namespace {

constexpr double kMillimetresPerInch = 25.4;
constexpr double kSecondsPerMinute = 60;
// LinuxCNC's types of motion, with the numbers of its interface.
constexpr int kTraverse = 1;
constexpr int kToolChange = 4;
constexpr int kProbing = 5;
constexpr int kIndexRotary = 6;
// An arc with ends closer than this is a full turn: positions summed by G91 differ in their last digits.
constexpr double kSamePlace = 1e-9;

bool is_linear(std::size_t letter) { return letter < 3 || letter > 5; }

double scale_of(std::size_t letter, PathUnits units) {
  return units == PathUnits::kInches && is_linear(letter) ? kMillimetresPerInch : 1;
}

std::string word_of(char letter, double value) { return fmt::format(" {}{}", letter, path_number(value)); }

std::string path_control(const trammel_operation& operation) {
  switch (operation.blending) {
    case TRAMMEL_EXACT_STOP:
      return " G61.1";
    case TRAMMEL_EXACT_PATH:
      return " G61";
    default:
      return operation.tolerance > 0 ? " G64" + word_of('P', operation.tolerance) : " G64";
  }
}

bool is_rapid(const trammel_operation& operation) {
  return operation.motion == kTraverse || operation.motion == kToolChange || operation.motion == kIndexRotary;
}

std::string feed_word(const trammel_operation& operation) {
  if (!(operation.speed > 0)) throw PathRefusal("a motion with a feed of 0: give F");
  const double speed = operation.most_speed > 0 ? std::min(operation.speed, operation.most_speed) : operation.speed;
  return word_of('F', speed * kSecondsPerMinute);
}

// Axis words of the axes that move, and of all axes in `always`. Throws if the machine lacks an axis that moves.
std::string axis_words(const Pose& from, const Pose& end, const machine::Machine& machine, std::string_view always) {
  std::string words;
  for (std::size_t n = 0; n < kPoseLetters.size(); ++n) {
    const char letter = kPoseLetters[n];
    const bool moves = end[n] != from[n];
    if (!machine.axis(letter)) {
      if (moves) throw PathRefusal(fmt::format("a motion of axis {}, which the machine file does not have", letter));
      continue;
    }
    if (moves || always.find(letter) != std::string_view::npos) words += word_of(letter, end[n]);
  }
  return words;
}

std::string line_motion(const trammel_operation& operation, const Pose& from, const machine::Machine& machine) {
  const std::string axes = axis_words(from, end_of(operation), machine, "");
  if (axes.empty()) return "";
  if (is_probe(operation)) {
    return (operation.probe_away != 0 ? "G38.5" : "G38.3") + axes + feed_word(operation);
  }
  if (is_rapid(operation)) return "G0" + axes;
  return "G1" + axes + feed_word(operation);
}

struct Plane {
  const char* word;
  std::size_t first;  // the plane's axes, in the order in which G2 is clockwise
  std::size_t second;
  std::size_t normal;
};
constexpr std::array<Plane, 3> kPlanes{{{"G17", 0, 1, 2}, {"G18", 2, 0, 1}, {"G19", 1, 2, 0}}};
constexpr std::string_view kCentreLetters = "IJK";

const Plane& plane_of(const trammel_operation& operation) {
  for (const Plane& plane : kPlanes) {
    if (operation.normal[plane.normal] != 0 && operation.normal[plane.first] == 0 &&
        operation.normal[plane.second] == 0) {
      return plane;
    }
  }
  throw PathRefusal("an arc outside the planes XY, ZX and YZ");
}

std::string arc_motion(const trammel_operation& operation, const Pose& from, const machine::Machine& machine) {
  const Plane& plane = plane_of(operation);
  Pose end = end_of(operation);
  if (std::abs(end[plane.first] - from[plane.first]) < kSamePlace &&
      std::abs(end[plane.second] - from[plane.second]) < kSamePlace) {
    end[plane.first] = from[plane.first];
    end[plane.second] = from[plane.second];
  }
  // A negative number of turns is clockwise as seen along the normal.
  const bool clockwise = (operation.turns < 0) == (operation.normal[plane.normal] > 0);
  const std::int64_t turns = operation.turns < 0 ? -std::int64_t{operation.turns} : std::int64_t{operation.turns} + 1;
  const char always[] = {kPoseLetters[plane.first], kPoseLetters[plane.second], '\0'};
  std::string text = plane.word;
  text += clockwise ? " G2" : " G3";
  text += axis_words(from, end, machine, always);
  for (const std::size_t axis : {plane.first, plane.second}) {
    text += word_of(kCentreLetters[axis], operation.centre[axis] - from[axis]);
  }
  if (turns > 1) text += fmt::format(" P{}", turns);
  return text + feed_word(operation);
}

}  // namespace

std::string path_number(double value) {
  if (!std::isfinite(value)) throw PathRefusal("a number that is not finite");
  // The smallest double has 1,074 digits after the point, the largest 309 before it.
  std::array<char, 1100> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  return {digits.data(), end.ptr};
}

std::string path_modes(const trammel_operation& operation, PathUnits units) {
  return (units == PathUnits::kInches ? "G20" : "G21") + path_control(operation);
}

std::vector<std::string> output_lines(const trammel_operation& operation, const machine::Machine& machine) {
  const bool at_rest = operation.kind == TRAMMEL_SWITCH;
  std::vector<std::string> lines;
  for (std::size_t n = 0; n < machine.outputs.numbered.size(); ++n) {
    if ((operation.outputs >> n & 1U) == 0 || machine.outputs.numbered[n] == 0) continue;
    const bool on = (operation.levels >> n & 1U) != 0;
    lines.push_back(fmt::format("{} P{}", at_rest ? on ? "M64" : "M65" : on ? "M62" : "M63", n));
  }
  return lines;
}

std::string path_line(const trammel_operation& operation, const Pose& from, const machine::Machine& machine) {
  if (operation.kind == TRAMMEL_LINE) return line_motion(operation, from, machine);
  if (operation.kind == TRAMMEL_ARC) return arc_motion(operation, from, machine);
  if (operation.kind == TRAMMEL_SWITCH) return "";
  throw PathRefusal("an operation that is no motion");
}

bool is_probe(const trammel_operation& operation) { return operation.motion == kProbing; }

Pose end_of(const trammel_operation& operation) {
  Pose end{};
  std::copy(std::begin(operation.end), std::end(operation.end), end.begin());
  return end;
}

gcode::Coordinates coordinates_of(const Pose& pose, const machine::Machine& machine, PathUnits units) {
  gcode::Coordinates coordinates{};
  for (std::size_t n = 0; n < kPoseLetters.size(); ++n) {
    const std::optional<std::size_t> axis = machine.axis(kPoseLetters[n]);
    if (axis) coordinates[*axis] = pose[n] * scale_of(n, units);
  }
  return coordinates;
}

Pose pose_of(const gcode::Coordinates& coordinates, const machine::Machine& machine, PathUnits units) {
  Pose pose{};
  for (std::size_t n = 0; n < kPoseLetters.size(); ++n) {
    const std::optional<std::size_t> axis = machine.axis(kPoseLetters[n]);
    if (axis) pose[n] = coordinates[*axis] / scale_of(n, units);
  }
  return pose;
}

}  // namespace trammel::linuxcnc
