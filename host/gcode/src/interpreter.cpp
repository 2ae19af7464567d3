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
constexpr int kSpindleClockwise = 30;
constexpr int kSpindleCounterClockwise = 40;
constexpr int kMist = 70;
constexpr int kFlood = 80;
constexpr int kCoolantOff = 90;
constexpr int kOrigin = 920;
constexpr int kOriginReset = 921;

}  // namespace

// The order of execution is RS274/NGC's.
Interpreter::Outcome Interpreter::execute(const WordSet& words, std::size_t line, LineMotions& motions,
                                          Problem& problem) {
  line_ = line;
  const Context context{words, motions, problem};
  if (!words.is_plain()) {
    if (!check_leftovers(context)) {
      return Outcome::kFailed;
    }
    set_modes(words);
    switch_outputs(context);
  }
  set_feed(words);
  if (!act(context)) {
    return Outcome::kFailed;
  }
  const std::optional<int> stopping = words.code(Group::kStopping);
  if (stopping == 20 || stopping == 300) {
    change_outputs(0, machine_.outputs.all(), motions);
    end(line, motions);
    return Outcome::kEnded;
  }
  if (stopping) {
    motions.add(MotionKind::kDwell, line).target = here_;  // M0, M1: a stop, without anybody to wait for
  }
  return Outcome::kGoesOn;
}

bool Interpreter::act(const Context& context) {
  const std::optional<int> action = context.words.code(Group::kNonModal);
  if (action == kHome) {
    return go_home(context);
  }
  if (action == kOrigin) {
    return set_origin(context);
  }
  if (action == kDwell) {
    dwell(context);
  } else if (action == kOriginReset) {
    origin_ = {};
  }
  return move(context);
}

void Interpreter::end(std::size_t line, LineMotions& motions) { motions.add(MotionKind::kEnd, line).target = here_; }

// Words that no word of the line would use.
bool Interpreter::check_leftovers(const Context& context) const {
  const auto& [words, motions, problem] = context;
  const std::optional<int> action = words.code(Group::kNonModal);
  const std::optional<int> motion = words.code(Group::kMotion);
  const bool uses_axes = action == kHome || action == kOrigin;
  if (uses_axes && motion && motion != kCancel) {
    return problem.set(ErrorCode::kTwoUsesOfAxisWords, "G28 and G92 cannot share a line with a motion");
  }
  if (action == kDwell && !words.letter('P')) {
    return problem.set(ErrorCode::kMissingWord, "G4 needs P, its seconds");
  }
  if (words.has_axis_words() && words.code(Group::kMotors)) {
    return problem.set(ErrorCode::kTwoUsesOfAxisWords,
                       "axis words beside M18 or M84: only all motors together are understood");
  }
  const std::optional<int> effective = uses_axes ? std::nullopt : (motion ? motion : motion_);
  const bool is_arc = effective == kArcClockwise || effective == kArcCounterClockwise;
  const bool has_centre = words.letter('I') || words.letter('J') || words.letter('K') || words.letter('R');
  const bool makes_arc = is_arc && (motion || has_centre || words.has_axis_words());
  if (words.letter('P') && action != kDwell && words.code(Group::kPathControl) != 640 && !makes_arc) {
    return problem.set(ErrorCode::kUnusedWord, "P without G2, G3, G4 or G64");
  }
  if (words.letter('Q') && words.code(Group::kPathControl) != 640) {
    return problem.set(ErrorCode::kUnusedWord, "Q without G64");
  }
  for (const char letter : {'I', 'J', 'K', 'R'}) {
    if (words.letter(letter) && !is_arc) {
      return problem.set(ErrorCode::kUnusedWord, fmt::format("{} without G2 or G3", letter));
    }
  }
  return true;
}

void Interpreter::set_modes(const WordSet& words) {
  if (const auto plane = words.code(Group::kPlane)) {
    plane_ = *plane;
  }
  if (const auto units = words.code(Group::kUnits)) {
    inches_ = units == 200;
  }
  if (const auto system = words.code(Group::kCoordinates)) {
    coordinate_system_ = static_cast<std::size_t>((*system - 540) / 10);
  }
  if (const auto distance = words.code(Group::kArcDistance)) {
    centre_absolute_ = distance == 901;
  }
  if (const auto distance = words.code(Group::kDistance)) {
    absolute_ = distance == 900;
  }
  if (const auto extruder = words.code(Group::kExtruder)) {
    extruder_absolute_ = extruder == 820;
  }
  set_path_control(words);
}

void Interpreter::set_path_control(const WordSet& words) {
  const std::optional<int> control = words.code(Group::kPathControl);
  if (!control) {
    return;
  }
  path_control_ = *control == 610   ? PathControl::kExactPath
                  : *control == 611 ? PathControl::kExactStop
                                    : PathControl::kContinuous;
  const std::optional<double> tolerance = words.letter('P');
  tolerance_ = path_control_ == PathControl::kContinuous && tolerance ? *tolerance * (inches_ ? kMmPerInch : 1) : 0;
}

void Interpreter::set_feed(const WordSet& words) {
  if (const auto mode = words.code(Group::kFeedMode)) {
    const FeedMode wanted = mode == 930 ? FeedMode::kInverseTime : FeedMode::kPerMinute;
    if (wanted != feed_mode_) {
      feed_.reset();
    }
    feed_mode_ = wanted;
  }
  if (const auto feed = words.letter('F')) {
    feed_ = *feed;
    feed_in_inches_ = inches_;
  }
}

bool Interpreter::switches(int number) const {
  const machine::MachineOutputs& outputs = machine_.outputs;
  switch (number) {
    case 3:
      return outputs.m3 != 0;
    case 4:
      return outputs.m4 != 0;
    case 5:
      return outputs.spindle() != 0;
    case 7:
      return outputs.m7 != 0;
    case 8:
      return outputs.m8 != 0;
    case 9:
      return outputs.coolant() != 0;
    default:
      return false;
  }
}

// Before the line's motion, as spindle and coolant are switched in RS274/NGC.
void Interpreter::switch_outputs(const Context& context) {
  const machine::MachineOutputs& outputs = machine_.outputs;
  std::uint16_t set = 0;
  std::uint16_t clear = 0;
  if (const auto spindle = context.words.code(Group::kSpindle)) {
    set = spindle == kSpindleClockwise ? outputs.m3 : spindle == kSpindleCounterClockwise ? outputs.m4 : 0;
    clear = static_cast<std::uint16_t>(outputs.spindle() & ~set);
  }
  if (const auto coolant = context.words.code(Group::kCoolant)) {
    const int switched = coolant == kMist ? outputs.m7 : coolant == kFlood ? outputs.m8 : 0;
    set = static_cast<std::uint16_t>(set | switched);
    if (coolant == kCoolantOff) clear = static_cast<std::uint16_t>(clear | outputs.coolant());
  }
  change_outputs(set, clear, context.motions);
}

void Interpreter::change_outputs(std::uint16_t set, std::uint16_t clear, LineMotions& motions) {
  if ((set | clear) == 0) return;
  Motion& motion = motions.add(MotionKind::kOutput, line_);
  motion.target = here_;
  motion.set = set;
  motion.clear = clear;
  switched_ |= set | clear;
  on_ = static_cast<std::uint16_t>((on_ & ~clear) | set);
}

void Interpreter::restore_outputs(std::size_t line, LineMotions& motions) const {
  if (switched_ == 0) return;
  Motion& motion = motions.add(MotionKind::kOutput, line);
  motion.target = here_;
  motion.set = on_;
  motion.clear = static_cast<std::uint16_t>(switched_ & ~on_);
}

void Interpreter::dwell(const Context& context) {
  Motion& motion = context.motions.add(MotionKind::kDwell, line_);
  motion.target = here_;
  motion.seconds = *context.words.letter('P');
}

// Through the programmed point to the home position of the axes named; bare G28: of all axes but the extruder, whose
// position has no home.
bool Interpreter::go_home(const Context& context) {
  const bool all = !context.words.has_axis_words();
  if (!all) {
    Motion& point = context.motions.add(MotionKind::kTraverse, line_);
    if (!target_of(context, point.target)) {
      return false;
    }
    here_ = point.target;
  }
  Motion& motion = context.motions.add(MotionKind::kTraverse, line_);
  motion.target = here_;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (all ? machine_.axes[axis].letter != 'E' : context.words.has_axis(axis)) {
      motion.target[axis] = machine_.axes[axis].home;
    }
  }
  here_ = motion.target;
  return true;
}

// G92: from now on the point where the machine stands has the coordinates given.
bool Interpreter::set_origin(const Context& context) {
  if (!context.words.has_axis_words()) {
    return context.problem.set(ErrorCode::kMissingWord, "G92 without an axis word");
  }
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (context.words.has_axis(axis)) {
      const double system = machine_.axes[axis].offsets[coordinate_system_];
      origin_[axis] = here_[axis] - system - to_mm(axis, context.words.axis(axis));
    }
  }
  return true;
}

bool Interpreter::move(const Context& context) {
  const auto& [words, motions, problem] = context;
  const std::optional<int> word = words.code(Group::kMotion);
  if (word) {
    motion_ = word == kCancel ? std::nullopt : word;
  }
  const bool explicit_arc = word == kArcClockwise || word == kArcCounterClockwise;
  const bool centre_words = words.letter('I') || words.letter('J') || words.letter('K') || words.letter('R');
  const bool machine_coordinates = words.code(Group::kNonModal) == kMachineCoordinates;
  if (machine_coordinates && motion_ != kTraverse && motion_ != kLine) {
    return problem.set(ErrorCode::kMachineCoordinates, "G53 needs G0 or G1");
  }
  if (!words.has_axis_words() && !explicit_arc && !centre_words) {
    return !machine_coordinates || problem.set(ErrorCode::kMachineCoordinates, "G53 without an axis word");
  }
  if (!motion_) {
    return problem.set(ErrorCode::kNoMotionMode, "axis words without a motion word (G0, G1, G2 or G3)");
  }
  if (motion_ == kTraverse || motion_ == kLine) {
    return straight(context, motion_ == kTraverse);
  }
  return arc(context, motion_ == kArcClockwise);
}

bool Interpreter::straight(const Context& context, bool rapid) {
  Motion& motion = context.motions.add(rapid ? MotionKind::kTraverse : MotionKind::kLine, line_);
  motion.path_control = path_control_;
  motion.tolerance = tolerance_;
  if (!target_of(context, motion.target) || (!rapid && !set_speed(context, motion))) {
    return false;
  }
  here_ = motion.target;
  return true;
}

bool Interpreter::arc(const Context& context, bool clockwise) {
  constexpr Plane kPlaneXy{'X', 'Y', 'I', 'J', 'K'};
  constexpr Plane kPlaneZx{'Z', 'X', 'K', 'I', 'J'};
  constexpr Plane kPlaneYz{'Y', 'Z', 'J', 'K', 'I'};
  const Plane& plane = plane_ == 170 ? kPlaneXy : plane_ == 180 ? kPlaneZx : kPlaneYz;
  Problem& problem = context.problem;
  if (context.words.letter(plane.unused_offset)) {
    return problem.set(ErrorCode::kArcOutsidePlane, fmt::format("{} in the plane {}{} (G{})", plane.unused_offset,
                                                                plane.first, plane.second, plane_ / 10));
  }
  Motion& motion = context.motions.add(MotionKind::kArc, line_);
  motion.path_control = path_control_;
  motion.tolerance = tolerance_;
  motion.clockwise = clockwise;
  std::size_t x = 0;
  std::size_t y = 0;
  if (!target_of(context, motion.target) || !plane_axis(plane.first, x, problem) ||
      !plane_axis(plane.second, y, problem) || !set_turns(context, motion)) {
    return false;
  }
  motion.axis_x = static_cast<std::uint8_t>(x);
  motion.axis_y = static_cast<std::uint8_t>(y);
  if (!arc_geometry(context, plane, motion) || !set_speed(context, motion)) {
    return false;
  }
  here_ = motion.target;
  return true;
}

// The motion has its target and the axes of its plane.
bool Interpreter::arc_geometry(const Context& context, const Plane& plane, Motion& motion) const {
  const std::size_t x = motion.axis_x;
  const std::size_t y = motion.axis_y;
  ArcWords words{
      {here_[x], here_[y]}, {motion.target[x], motion.target[y]}, motion.clockwise, {}, {}, centre_absolute_, {}};
  const auto centre = [&](char letter, std::size_t axis) -> std::optional<double> {
    const auto word = context.words.letter(letter);
    if (!word) {
      return std::nullopt;
    }
    return to_mm(axis, *word) + (centre_absolute_ ? offset(axis) : 0);
  };
  words.centre_x = centre(plane.first_offset, x);
  words.centre_y = centre(plane.second_offset, y);
  if (const auto radius = context.words.letter('R')) {
    words.radius = to_mm(x, *radius);
  }
  ArcCentre found{};
  if (!find_centre(words, found, context.problem)) {
    return false;
  }
  motion.centre_x = found.centre.x;
  motion.centre_y = found.centre.y;
  motion.full_circle = found.full_circle;
  return true;
}

// P, where neither G4 nor G64 takes it: all turns, the last one perhaps not a whole one.
bool Interpreter::set_turns(const Context& context, Motion& motion) const {
  constexpr double kMostTurns = 10'000;
  const WordSet& words = context.words;
  const auto turns = words.letter('P');
  if (!turns || words.code(Group::kNonModal) == kDwell || words.code(Group::kPathControl)) {
    return true;
  }
  if (*turns < 1 || *turns > kMostTurns || *turns != std::floor(*turns)) {
    return context.problem.set(
        ErrorCode::kArcTurns,
        fmt::format("P{:.10g}: an arc makes a whole number of turns, 1 to {:.0f}", *turns, kMostTurns));
  }
  motion.turns = static_cast<std::uint32_t>(*turns) - 1;
  return true;
}

bool Interpreter::plane_axis(char letter, std::size_t& axis, Problem& problem) const {
  const auto found = machine_.axis(letter);
  if (!found) {
    return problem.set(ErrorCode::kArcPlaneAxis,
                       fmt::format("an arc in this plane needs an axis {}, which the machine lacks", letter));
  }
  axis = *found;
  return true;
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

bool Interpreter::target_of(const Context& context, Coordinates& target) const {
  const WordSet& words = context.words;
  const bool machine_coordinates = words.code(Group::kNonModal) == kMachineCoordinates;
  target = here_;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (!words.has_axis(axis)) {
      continue;
    }
    const bool extruder = machine_.axes[axis].letter == 'E';
    const bool absolute = extruder ? extruder_absolute_.value_or(absolute_) : absolute_;
    if (machine_coordinates && !absolute) {
      return context.problem.set(ErrorCode::kMachineCoordinates, "G53 with relative distances");
    }
    const double base = machine_coordinates ? 0 : absolute ? offset(axis) : here_[axis];
    target[axis] = base + to_mm(axis, words.axis(axis));
  }
  return true;
}

// Speed or duration of a motion with feed. A move of rotary axes alone is in degrees a minute, whatever the units.
bool Interpreter::set_speed(const Context& context, Motion& motion) const {
  Problem& problem = context.problem;
  if (feed_mode_ == FeedMode::kInverseTime && !context.words.letter('F')) {
    return problem.set(ErrorCode::kNoFeed, "under G93 every motion needs an F word");
  }
  if (!feed_) {
    return problem.set(ErrorCode::kNoFeed, "motion with feed, but no F word before");
  }
  if (*feed_ < kLeastFeed) {
    return problem.set(ErrorCode::kFeedTooSmall, *feed_ == 0 ? "feed is 0" : "feed is too small");
  }
  if (feed_mode_ == FeedMode::kInverseTime) {
    motion.seconds = 60 / *feed_;
    return true;
  }
  bool linear = motion.kind == MotionKind::kArc;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    linear = linear || (!is_rotary(axis) && std::abs(motion.target[axis] - here_[axis]) > kStill);
  }
  motion.feed = *feed_ * (feed_in_inches_ && linear ? kMmPerInch : 1) / 60;
  return true;
}

}  // namespace trammel::gcode
