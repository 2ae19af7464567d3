// The settings of a line: homes, coordinate systems, the origin.
#include <fmt/format.h>

#include "codes.hpp"
#include "interpreter.hpp"
#include "left_out.hpp"

namespace trammel::gcode {

// G28 and G30: moves through the programmed point to the home position of the named axes. Without axis letters it moves
// all axes but the extruder, whose position has no home.
bool Interpreter::go_home(const Context& context, bool second) {
  const unsigned named = context.words.axes() | context.words.bare_axes();
  const bool all = named == 0;
  if (context.words.has_axis_words()) {
    Place point;
    if (!target_of(context, point)) {
      return false;
    }
    Motion& motion = context.motions.add(MotionKind::kTraverse, line_);
    motion.target = point.at;
    motion.later = static_cast<std::uint8_t>(point.later);
    here_ = point;
  }
  Place target = here_;
  const Place& home = offsets_.home(second);
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (all ? machine_.axes[axis].letter != 'E' : (named >> axis & 1U) != 0) {
      target.set(axis, home.at[axis], home.is_later(axis));
    }
  }
  Motion& motion = context.motions.add(MotionKind::kTraverse, line_);
  motion.target = target.at;
  motion.later = static_cast<std::uint8_t>(target.later);
  here_ = target;
  return true;
}

// G10 L2 and L20.
bool Interpreter::set_system(const Context& context) {
  const auto& [words, motions, problem] = context;
  const auto what = words.letter('L');
  if (!what || (*what != 2 && *what != 20)) {
    return problem.set(
        ErrorCode::kUnsupportedWord,
        what ? fmt::format("G10 L{:.10g}: only L2 and L20 are supported{}", *what,
                           *what == 1 || *what == 10 || *what == 11 ? "; tool lengths come from the machine file" : "")
             : std::string("G10 needs L2 or L20; alone on its line it is a printer's retraction"));
  }
  if (words.letter('R')) {
    return problem.set(ErrorCode::kUnsupportedWord, "G10 R: coordinate systems cannot be turned");
  }
  const auto number = words.letter('P');
  if (!number) {
    return problem.set(ErrorCode::kMissingWord,
                       "G10 needs P, the coordinate system: 1 (G54) to 9 (G59.3), 0: this one");
  }
  if (words.later('P')) return problem.set(ErrorCode::kDependsOnProbe, "G10: P cannot depend on a probe");
  if (*number < 0 || *number > static_cast<double>(machine::kCoordinateSystems) ||
      *number != static_cast<double>(static_cast<int>(*number))) {
    return problem.set(ErrorCode::kCoordinateSystem,
                       fmt::format("G10 P{:.10g}: coordinate systems are 1 (G54) to 9 (G59.3), 0: this one", *number));
  }
  const std::size_t system = *number == 0 ? offsets_.system() : static_cast<std::size_t>(*number) - 1;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (!words.has_axis(axis)) continue;
    const Value value{to_mm(axis, words.axis(axis)), words.axis_later(axis)};
    if (*what == 2) {
      offsets_.set_system(system, axis, value);
    } else {
      offsets_.set_system_at(system, axis, here_, value);
    }
  }
  return true;
}

// G92: the present point of the machine gets the given coordinates. G52 (`local`): the program's zero gets the given
// coordinates in the coordinate system. As in LinuxCNC, both set the same offset.
bool Interpreter::set_origin(const Context& context, bool local) {
  const WordSet& words = context.words;
  if (!words.has_axis_words()) {
    return context.problem.set(ErrorCode::kMissingWord, fmt::format("{} without an axis word", local ? "G52" : "G92"));
  }
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (!words.has_axis(axis)) continue;
    const Value value{to_mm(axis, words.axis(axis)), words.axis_later(axis)};
    if (local) {
      offsets_.set_shift(axis, value);
    } else {
      offsets_.shift_at(axis, here_, value);
    }
  }
  offsets_.shift_on();
  return true;
}

}  // namespace trammel::gcode
