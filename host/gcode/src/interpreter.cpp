#include "interpreter.hpp"

#include <fmt/format.h>

#include <cmath>

#include "arc.hpp"

namespace trammel::gcode {
namespace {

constexpr double kMmPerInch = 25.4;
constexpr double kStill = 1e-9;  // mm: what is left of a sum that should be 0

constexpr double kLeastFeed = 1e-6;  // a minute; a millimetre in two years

constexpr int kTraverse = 0;
constexpr int kLine = 10;
constexpr int kArcClockwise = 20;
constexpr int kArcCounterClockwise = 30;
constexpr int kCancel = 800;
constexpr int kDwell = 40;
constexpr int kHome = 280;
constexpr int kMachineCoordinates = 530;
constexpr int kOrigin = 920;
constexpr int kOriginReset = 921;

}  // namespace

Interpreter::Interpreter(const machine::Machine& machine, Program& program)
    : machine_(machine), program_(program), here_(program.start) {}

// The order of execution is RS274/NGC's.
bool Interpreter::execute(const Block& block, std::size_t line) {
  line_ = line;
  for (const std::string& word : block.accepted) {
    ++program_.accepted[word];
  }
  check_leftovers(block);
  set_modes(block);
  set_feed(block);
  const std::optional<int> action = block.code(Group::kNonModal);
  if (action == kDwell) {
    dwell(block);
  } else if (action == kHome) {
    go_home(block);
  } else if (action == kOrigin) {
    set_origin(block);
  } else if (action == kOriginReset) {
    origin_ = {};
  }
  if (action != kHome && action != kOrigin) {
    move(block);
  }
  const std::optional<int> stopping = block.code(Group::kStopping);
  if (stopping == 20 || stopping == 300) {
    end(line);
    return false;
  }
  return true;
}

void Interpreter::end(std::size_t line) {
  line_ = line;
  Motion motion;
  motion.kind = MotionKind::kEnd;
  append(motion);
}

// Words that no word of the line would use.
void Interpreter::check_leftovers(const Block& block) const {
  const std::optional<int> action = block.code(Group::kNonModal);
  const std::optional<int> motion = block.code(Group::kMotion);
  const bool uses_axes = action == kHome || action == kOrigin;
  if (uses_axes && motion && motion != kCancel) {
    throw WordError{"G28 and G92 cannot share a line with a motion"};
  }
  if (block.letter('P') && action != kDwell && block.code(Group::kPathControl) != 640) {
    throw WordError{"P without G4 or G64"};
  }
  if (action == kDwell && !block.letter('P')) {
    throw WordError{"G4 needs P, its seconds"};
  }
  if (block.has_axis_words() && block.code(Group::kMotors)) {
    throw WordError{"axis words beside M18 or M84: only all motors together are understood"};
  }
  const std::optional<int> effective = uses_axes ? std::nullopt : (motion ? motion : motion_);
  const bool is_arc = effective == kArcClockwise || effective == kArcCounterClockwise;
  for (const char letter : {'I', 'J', 'K', 'R'}) {
    if (block.letter(letter) && !is_arc) {
      throw WordError{fmt::format("{} without G2 or G3", letter)};
    }
  }
}

void Interpreter::set_modes(const Block& block) {
  if (const auto plane = block.code(Group::kPlane)) {
    plane_ = *plane;
  }
  if (const auto units = block.code(Group::kUnits)) {
    inches_ = units == 200;
  }
  if (const auto system = block.code(Group::kCoordinates)) {
    coordinate_system_ = static_cast<std::size_t>((*system - 540) / 10);
  }
  if (const auto distance = block.code(Group::kArcDistance)) {
    centre_absolute_ = distance == 901;
  }
  if (const auto distance = block.code(Group::kDistance)) {
    absolute_ = distance == 900;
  }
  if (const auto extruder = block.code(Group::kExtruder)) {
    extruder_absolute_ = extruder == 820;
  }
}

void Interpreter::set_feed(const Block& block) {
  if (const auto mode = block.code(Group::kFeedMode)) {
    const FeedMode wanted = mode == 930 ? FeedMode::kInverseTime : FeedMode::kPerMinute;
    if (wanted != feed_mode_) {
      feed_.reset();
    }
    feed_mode_ = wanted;
  }
  if (const auto feed = block.letter('F')) {
    feed_ = *feed;
    feed_in_inches_ = inches_;
  }
}

void Interpreter::dwell(const Block& block) {
  Motion motion;
  motion.kind = MotionKind::kDwell;
  motion.seconds = *block.letter('P');
  append(motion);
}

// Through the programmed point to the home position of the axes named; bare G28: of all axes but the extruder, whose
// position has no home.
void Interpreter::go_home(const Block& block) {
  Motion motion;
  motion.kind = MotionKind::kTraverse;
  const bool all = !block.has_axis_words();
  if (!all) {
    motion.target = target_of(block);
    append(motion);
  }
  motion.target = here_;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (all ? machine_.axes[axis].letter != 'E' : block.axes[axis].has_value()) {
      motion.target[axis] = machine_.axes[axis].home;
    }
  }
  append(motion);
}

// G92: from now on the point where the machine stands has the coordinates given.
void Interpreter::set_origin(const Block& block) {
  if (!block.has_axis_words()) {
    throw WordError{"G92 without an axis word"};
  }
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (block.axes[axis]) {
      const double system = machine_.axes[axis].offsets[coordinate_system_];
      origin_[axis] = here_[axis] - system - to_mm(axis, *block.axes[axis]);
    }
  }
}

void Interpreter::move(const Block& block) {
  const std::optional<int> word = block.code(Group::kMotion);
  if (word) {
    motion_ = word == kCancel ? std::nullopt : word;
  }
  const bool explicit_arc = word == kArcClockwise || word == kArcCounterClockwise;
  const bool centre_words = block.letter('I') || block.letter('J') || block.letter('K') || block.letter('R');
  const bool machine_coordinates = block.code(Group::kNonModal) == kMachineCoordinates;
  if (machine_coordinates && motion_ != kTraverse && motion_ != kLine) {
    throw WordError{"G53 needs G0 or G1"};
  }
  if (!block.has_axis_words() && !explicit_arc && !centre_words) {
    if (machine_coordinates) {
      throw WordError{"G53 without an axis word"};
    }
    return;
  }
  if (!motion_) {
    throw WordError{"axis words without a motion word (G0, G1, G2 or G3)"};
  }
  if (motion_ == kTraverse || motion_ == kLine) {
    straight(block, motion_ == kTraverse);
  } else {
    arc(block, motion_ == kArcClockwise);
  }
}

void Interpreter::straight(const Block& block, bool rapid) {
  Motion motion;
  motion.kind = rapid ? MotionKind::kTraverse : MotionKind::kLine;
  motion.target = target_of(block);
  if (!rapid) {
    set_speed(block, motion);
  }
  append(motion);
}

void Interpreter::arc(const Block& block, bool clockwise) {
  constexpr Plane kPlaneXy{'X', 'Y', 'I', 'J', 'K'};
  constexpr Plane kPlaneZx{'Z', 'X', 'K', 'I', 'J'};
  constexpr Plane kPlaneYz{'Y', 'Z', 'J', 'K', 'I'};
  const Plane& plane = plane_ == 170 ? kPlaneXy : plane_ == 180 ? kPlaneZx : kPlaneYz;
  check_plane_words(block, plane);

  Motion motion;
  motion.kind = MotionKind::kArc;
  motion.clockwise = clockwise;
  motion.target = target_of(block);
  const std::size_t x = plane_axis(plane.first);
  const std::size_t y = plane_axis(plane.second);
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (axis != x && axis != y && std::abs(motion.target[axis] - here_[axis]) > kStill) {
      throw WordError{
          fmt::format("axis {} moves during an arc: helices are not supported", machine_.axes[axis].letter)};
    }
  }

  ArcWords words{{here_[x], here_[y]}, {motion.target[x], motion.target[y]}, clockwise, {}, {}, centre_absolute_, {}};
  const auto centre = [&](char letter, std::size_t axis) -> std::optional<double> {
    const auto word = block.letter(letter);
    if (!word) {
      return std::nullopt;
    }
    return to_mm(axis, *word) + (centre_absolute_ ? offset(axis) : 0);
  };
  words.centre_x = centre(plane.first_offset, x);
  words.centre_y = centre(plane.second_offset, y);
  if (const auto radius = block.letter('R')) {
    words.radius = to_mm(x, *radius);
  }
  const ArcCentre found = arc_centre(words);
  motion.axis_x = static_cast<std::uint8_t>(x);
  motion.axis_y = static_cast<std::uint8_t>(y);
  motion.centre_x = found.centre.x;
  motion.centre_y = found.centre.y;
  motion.full_circle = found.full_circle;
  set_speed(block, motion);
  append(motion);
}

void Interpreter::check_plane_words(const Block& block, const Plane& plane) const {
  if (block.letter(plane.unused_offset)) {
    throw WordError{
        fmt::format("{} in the plane {}{} (G{})", plane.unused_offset, plane.first, plane.second, plane_ / 10)};
  }
}

std::size_t Interpreter::plane_axis(char letter) const {
  const auto axis = machine_.axis(letter);
  if (!axis) {
    throw WordError{fmt::format("an arc in this plane needs an axis {}, which the machine lacks", letter)};
  }
  return *axis;
}

bool Interpreter::is_rotary(std::size_t axis) const {
  const char letter = machine_.axes[axis].letter;
  return letter == 'A' || letter == 'B' || letter == 'C';
}

double Interpreter::to_mm(std::size_t axis, double value) const {
  return inches_ && !is_rotary(axis) ? value * kMmPerInch : value;
}

// Machine coordinate of the program's zero.
double Interpreter::offset(std::size_t axis) const {
  return machine_.axes[axis].offsets[coordinate_system_] + origin_[axis];
}

Coordinates Interpreter::target_of(const Block& block) const {
  const bool machine_coordinates = block.code(Group::kNonModal) == kMachineCoordinates;
  Coordinates target = here_;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (!block.axes[axis]) {
      continue;
    }
    const bool extruder = machine_.axes[axis].letter == 'E';
    const bool absolute = extruder ? extruder_absolute_.value_or(absolute_) : absolute_;
    if (machine_coordinates && !absolute) {
      throw WordError{"G53 with relative distances"};
    }
    const double base = machine_coordinates ? 0 : absolute ? offset(axis) : here_[axis];
    target[axis] = base + to_mm(axis, *block.axes[axis]);
  }
  return target;
}

// Speed or duration of a motion with feed. A move of rotary axes alone is in degrees a minute, whatever the units.
void Interpreter::set_speed(const Block& block, Motion& motion) const {
  if (feed_mode_ == FeedMode::kInverseTime && !block.letter('F')) {
    throw WordError{"under G93 every motion needs an F word"};
  }
  if (!feed_ || *feed_ <= 0) {
    throw WordError{feed_ ? "feed is 0" : "motion with feed, but no F word before"};
  }
  if (*feed_ < kLeastFeed) {
    throw WordError{"feed is too small"};
  }
  if (feed_mode_ == FeedMode::kInverseTime) {
    motion.seconds = 60 / *feed_;
    return;
  }
  bool linear = motion.kind == MotionKind::kArc;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    linear = linear || (!is_rotary(axis) && std::abs(motion.target[axis] - here_[axis]) > kStill);
  }
  motion.feed = *feed_ * (feed_in_inches_ && linear ? kMmPerInch : 1) / 60;
}

void Interpreter::append(Motion motion) {
  motion.line = line_;
  if (motion.kind == MotionKind::kDwell || motion.kind == MotionKind::kEnd) {
    motion.target = here_;
  }
  here_ = motion.target;
  program_.motions.push_back(motion);
}

}  // namespace trammel::gcode
