#include "interpreter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "codes.hpp"
#include "left_out.hpp"
#include "word_uses.hpp"

namespace trammel::gcode {
namespace {

constexpr double kStill = 1e-9;  // mm: below this, a sum that should be 0 counts as 0

// The smallest max_velocity of a machine file is 0.001 mm/s. A feed below that is a typing error: 10 mm would take
// hours.
constexpr double kMinFeed = 0.06;  // mm/min, or degrees/min
// Under G93: one motion takes at most 1,000 minutes.
constexpr double kMinInverseTime = 0.001;  // 1/min

constexpr int kSpindleClockwise = 30;
constexpr int kSpindleCounterClockwise = 40;
constexpr int kSpindleOff = 50;
constexpr int kMist = 70;
constexpr int kFlood = 80;
constexpr int kCoolantOff = 90;
constexpr int kOnWithMotion = 620;
constexpr int kOnAtRest = 640;
constexpr int kOffAtRest = 650;

bool is_probe(std::optional<int> word) {
  return word && (*word == code::kSkip || (*word >= code::kProbe && *word <= code::kProbeAwayQuietly));
}

// Errors of values. Another result of a probe could remove them.
bool is_of_values(ErrorCode code) {
  switch (code) {
    case ErrorCode::kFeedTooSmall:
    case ErrorCode::kArcRadiusZero:
    case ErrorCode::kArcRadiusTooSmall:
    case ErrorCode::kArcRadiusFullCircle:
    case ErrorCode::kArcOffCircle:
    case ErrorCode::kArcTurns:
    case ErrorCode::kCycleLevels:
    case ErrorCode::kTooManyMotions:
    case ErrorCode::kProbeWay:
      return true;
    default:
      return false;
  }
}

}  // namespace

Interpreter::Interpreter(const machine::Machine& machine, const Coordinates& start)
    : machine_(machine), offsets_(machine), tools_(machine) {
  here_.at = start;
}

// The order of execution is that of RS274/NGC.
Interpreter::Outcome Interpreter::execute(const WordSet& words, std::size_t line, LineMotions& motions,
                                          Problem& problem) {
  line_ = line;
  const Context context{words, motions, problem};
  const std::size_t before = motions.size();
  if (!words.is_plain() && !set_modes(context)) {
    return Outcome::kFailed;
  }
  modes_.set_feed(words);
  if ((words.later() || words.has_axis_words()) && depends(words)) {
    ++lines_on_probes_;
  }
  if (!act(context) && !defer(context, before)) {
    return Outcome::kFailed;
  }
  set_power(motions, before);
  const std::optional<int> stopping = words.code(Group::kStopping);
  if (stopping == 20 || stopping == 300) {
    change_outputs(0, machine_.outputs.spindle() | machine_.outputs.coolant(), motions);
    modes_.spindle = kSpindleOff;
    end(line, motions);
    return Outcome::kEnded;
  }
  if (stopping) {
    stop(motions, 0);  // M0, M1; there is no operator to wait for here
  }
  return Outcome::kGoesOn;
}

bool Interpreter::set_modes(const Context& context) {
  const WordSet& words = context.words;
  if (!check_uses(words, modes_.motion, context.problem)) {
    return false;
  }
  const int spindle_before = modes_.spindle;
  const double speed_before = modes_.spindle_speed;
  modes_.set(words);
  if (const auto tool = words.letter('T')) {
    tools_.select(static_cast<unsigned>(*tool));
  }
  if (words.code(Group::kToolChange)) {
    tools_.change();
    stop(context.motions, 0);
  }
  switch_outputs(context);
  if (words.code(Group::kNumbered) && !switch_numbered(context)) {
    return false;
  }
  if (modes_.spindle != spindle_before || modes_.spindle_speed != speed_before) spin_up(context.motions);
  if (const auto system = words.code(Group::kCoordinates)) {
    offsets_.select(static_cast<std::size_t>(*system <= 590 ? (*system - 540) / 10 : *system - 590 + 5));
  }
  const auto length = words.code(Group::kToolLength);
  if (length != code::kToolOffsets) {
    return !length || tools_.apply(words, offsets_, context.problem);
  }
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (words.has_axis(axis)) {
      offsets_.set_tool(axis, {to_mm(axis, words.axis(axis)), words.axis_later(axis)});
    }
  }
  return words.has_axis_words() || context.problem.set(ErrorCode::kMissingWord, "G43.1 without an axis word");
}

bool Interpreter::act(const Context& context) {
  const std::optional<int> action = context.words.code(Group::kNonModal);
  switch (action.value_or(code::kMachineCoordinates)) {
    case code::kSet:
      return set_system(context);
    case code::kHome:
      return go_home(context, false);
    case code::kSecondHome:
      return go_home(context, true);
    case code::kOrigin:
    case code::kLocalOrigin:
      return set_origin(context, action == code::kLocalOrigin);
    case code::kDwell:
      // Can be below 0 only as long as a probe decides it.
      stop(context.motions, std::max(0.0, *context.words.dwell()));
      break;
    case code::kStoreHome:
    case code::kStoreSecondHome:
      offsets_.set_home(action == code::kStoreSecondHome, here_);
      break;
    case code::kOriginClear:
      offsets_.shift_clear();
      break;
    case code::kOriginOff:
      offsets_.shift_off();
      break;
    case code::kOriginOn:
      offsets_.shift_on();
      break;
    default:
      break;
  }
  return move(context);
}

bool Interpreter::depends(const WordSet& words) const {
  if (words.later() || here_.later != 0 || modes_.feed_later || sticky_.later) {
    return true;
  }
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (words.has_axis(axis) && offsets_.later(axis)) {
      return true;
    }
  }
  return false;
}

// A line whose values depend on a probe is checked when it is reached. Until then it moves nothing, its end point is
// not known, and, if the line is a probe, its results are not known either.
bool Interpreter::defer(const Context& context, std::size_t motions_before) {
  if (!depends(context.words) || !is_of_values(context.problem.code)) {
    return false;
  }
  context.motions.cut(motions_before);
  here_.later |= context.words.axes();
  if (is_probe(modes_.motion)) {
    if (modes_.motion == code::kSkip) modes_.motion.reset();
    probe_target_ = here_.at;
    probe_axes_ = here_.later;
    assume_probed();
  }
  return true;
}

void Interpreter::end(std::size_t line, LineMotions& motions) { motions.add(MotionKind::kEnd, line).target = here_.at; }

bool Interpreter::switches(int number) const {
  const machine::MachineOutputs& outputs = machine_.outputs;
  switch (number) {
    case 3:
      return (outputs.m3 | outputs.pwm) != 0;
    case 4:
      return (outputs.m4 | outputs.pwm) != 0;
    case 5:
      return outputs.spindle() != 0;
    case 7:
      return outputs.m7 != 0;
    case 8:
      return outputs.m8 != 0;
    case 9:
      return outputs.coolant() != 0;
    case 62:
    case 63:
    case 64:
    case 65:
      return true;  // always, because others are refused
    default:
      return false;
  }
}

// Before the line's motion; RS274/NGC switches spindle and coolant then.
void Interpreter::switch_outputs(const Context& context) {
  const machine::MachineOutputs& outputs = machine_.outputs;
  std::uint16_t set = 0;
  std::uint16_t clear = 0;
  if (const auto spindle = context.words.code(Group::kSpindle)) {
    set = spindle == kSpindleClockwise ? outputs.m3 : spindle == kSpindleCounterClockwise ? outputs.m4 : 0;
    if (spindle != kSpindleOff) set = static_cast<std::uint16_t>(set | outputs.pwm);
    clear = static_cast<std::uint16_t>(outputs.spindle() & ~set);
  }
  if (const auto coolant = context.words.code(Group::kCoolant)) {
    const int switched = coolant == kMist ? outputs.m7 : coolant == kFlood ? outputs.m8 : 0;
    set = static_cast<std::uint16_t>(set | switched);
    if (coolant == kCoolantOff) clear = static_cast<std::uint16_t>(clear | outputs.coolant());
  }
  change_outputs(set, clear, context.motions);
}

// LinuxCNC's numbered outputs: switched in place on the path, or after a stop.
bool Interpreter::switch_numbered(const Context& context) {
  const int word = *context.words.code(Group::kNumbered);
  const double number = *context.words.letter('P');
  const auto& numbered = machine_.outputs.numbered;
  const std::uint16_t outputs =
      number < static_cast<double>(numbered.size()) ? numbered[static_cast<std::size_t>(number)] : 0;
  if (outputs == 0) {
    return context.problem.set(ErrorCode::kNoOutput,
                               fmt::format("{} P{:.10g}: [outputs] of the machine file names no output for p{:.10g}",
                                           name_of('M', word), number, number));
  }
  if (word == kOnAtRest || word == kOffAtRest) stop(context.motions, 0);
  const bool on = word == kOnWithMotion || word == kOnAtRest;
  change_outputs(on ? outputs : 0, on ? 0 : outputs, context.motions);
  return true;
}

// A spindle needs time to reach a new speed. Cutting waits for it.
void Interpreter::spin_up(LineMotions& motions) {
  const machine::MachineOutputs& outputs = machine_.outputs;
  if (modes_.spindle == kSpindleOff) return;
  const bool awaits = machine_.awaits_spindle();
  const double seconds = outputs.pwm != 0 ? outputs.spin_up_s : 0;
  if (awaits || seconds > 0) stop(motions, seconds).awaits_spindle = awaits;
}

// A laser burns in motions at feed, never in a traverse or a probe. At rest it may burn if the motion mode is one at
// feed. This is the rule of Grbl 1.1 (https://github.com/gnea/grbl, doc/markdown/laser_mode.md).
bool Interpreter::laser_may_burn(MotionKind kind) const {
  switch (kind) {
    case MotionKind::kLine:
    case MotionKind::kArc:
      return true;
    case MotionKind::kDwell:
      return modes_.motion == code::kLine || modes_.motion == code::kArcClockwise ||
             modes_.motion == code::kArcCounterClockwise;
    default:
      return false;
  }
}

void Interpreter::set_power(LineMotions& motions, std::size_t first) const {
  const machine::MachineOutputs& outputs = machine_.outputs;
  if (outputs.pwm == 0 || modes_.spindle == kSpindleOff) return;
  const double power = std::clamp(modes_.spindle_speed / outputs.max_s, 0.0, 1.0);
  for (std::size_t i = first; i < motions.size(); ++i) {
    Motion& motion = motions[i];
    if (motion.kind == MotionKind::kEnd || (outputs.laser && !laser_may_burn(motion.kind))) continue;
    motion.power = power;
    motion.power_follows = outputs.laser && modes_.spindle == kSpindleCounterClockwise;
  }
}

void Interpreter::change_outputs(std::uint16_t set, std::uint16_t clear, LineMotions& motions) {
  if ((set | clear) == 0) return;
  Motion& motion = motions.add(MotionKind::kOutput, line_);
  motion.target = here_.at;
  motion.set = set;
  motion.clear = clear;
}

Motion& Interpreter::stop(LineMotions& motions, double seconds) {
  Motion& motion = motions.add(MotionKind::kDwell, line_);
  motion.target = here_.at;
  motion.seconds = seconds;
  return motion;
}

bool Interpreter::move(const Context& context) {
  const auto& [words, motions, problem] = context;
  const std::optional<int> word = words.code(Group::kMotion);
  const std::optional<int> before = modes_.motion;
  if (word) {
    modes_.motion = word == code::kCancel ? std::nullopt : word;
  }
  const std::optional<int> motion = modes_.motion;
  const bool explicit_arc = word == code::kArcClockwise || word == code::kArcCounterClockwise;
  const bool is_arc = motion == code::kArcClockwise || motion == code::kArcCounterClockwise;
  const bool centre_words =
      is_arc && (words.letter('I') || words.letter('J') || words.letter('K') || words.letter('R'));
  const bool machine_coordinates = words.code(Group::kNonModal) == code::kMachineCoordinates &&
                                   (words.has_axis_words() || explicit_arc || centre_words);
  if (machine_coordinates && motion != code::kTraverse && motion != code::kLine) {
    return problem.set(ErrorCode::kMachineCoordinates, "G53 needs G0 or G1");
  }
  const bool axis_words = words.has_axis_words() && words.code(Group::kToolLength) != code::kToolOffsets;
  if (!axis_words && !explicit_arc && !centre_words) {
    if (word && (is_cycle(word) || *word == code::kSpline || *word == code::kQuadratic || is_probe(word))) {
      return problem.set(ErrorCode::kMissingWord, fmt::format("{} without an axis word", name_of('G', *word)));
    }
    return true;
  }
  if (!motion) {
    return problem.set(ErrorCode::kNoMotionMode, "axis words without a motion word (G0, G1, G2 or G3)");
  }
  if (motion != code::kSpline) {
    spline_end_.reset();
  }
  if (motion == code::kTraverse || motion == code::kLine) {
    return straight(context, motion == code::kTraverse);
  }
  if (is_arc) {
    return arc(context, motion == code::kArcClockwise);
  }
  if (is_cycle(motion)) {
    return cycle(context, before);
  }
  if (*motion == code::kSpline || *motion == code::kQuadratic) {
    return spline(context);
  }
  return probe(context);
}

bool Interpreter::straight(const Context& context, bool rapid) {
  Place target;
  if (!target_of(context, target)) {
    return false;
  }
  Motion& motion = context.motions.add(rapid ? MotionKind::kTraverse : MotionKind::kLine, line_);
  motion.target = target.at;
  if (!rapid && !set_speed(context, motion)) {
    return false;
  }
  arrive(target, motion);
  return true;
}

// Precondition: the motion has its target.
void Interpreter::arrive(const Place& target, Motion& motion) {
  motion.path_control = modes_.path_control;
  motion.tolerance = modes_.tolerance;
  motion.later = static_cast<std::uint8_t>(target.later);
  here_ = target;
}

bool Interpreter::is_rotary(std::size_t axis) const {
  const char letter = machine_.axes[axis].letter;
  return letter == 'A' || letter == 'B' || letter == 'C';
}

double Interpreter::to_mm(std::size_t axis, double value) const {
  return modes_.inches && !is_rotary(axis) ? value * kMmPerInch : value;
}

// Value of a letter in mm along an axis; 0 if the line does not have it.
Value Interpreter::word(const WordSet& words, char letter, std::size_t axis) const {
  return {to_mm(axis, words.letter(letter).value_or(0)), words.later(letter)};
}

bool Interpreter::is_absolute(std::size_t axis) const {
  const bool extruder = machine_.axes[axis].letter == 'E';
  return extruder ? modes_.extruder_absolute.value_or(modes_.absolute) : modes_.absolute;
}

bool Interpreter::target_of(const Context& context, Place& target) const {
  const WordSet& words = context.words;
  const bool machine_coordinates = words.code(Group::kNonModal) == code::kMachineCoordinates;
  target = here_;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (!words.has_axis(axis)) {
      continue;
    }
    const bool absolute = is_absolute(axis);
    if (machine_coordinates && !absolute) {
      return context.problem.set(ErrorCode::kMachineCoordinates, "G53 with relative distances");
    }
    const double base = machine_coordinates ? 0 : absolute ? offsets_.total(axis) : here_.at[axis];
    const bool base_later = !machine_coordinates && (absolute ? offsets_.later(axis) : here_.is_later(axis));
    target.set(axis, base + to_mm(axis, words.axis(axis)), base_later || words.axis_later(axis));
  }
  return true;
}

// Speed or duration of a motion with feed. The feed of rotary axes alone is in degrees per minute, whatever the units.
bool Interpreter::set_speed(const Context& context, Motion& motion) const {
  Problem& problem = context.problem;
  if (modes_.inverse_time && !context.words.letter('F')) {
    return problem.set(ErrorCode::kNoFeed, "under G93 every motion needs an F word");
  }
  if (!modes_.feed) {
    return problem.set(ErrorCode::kNoFeed, "motion with feed, but no F word before");
  }
  if (*modes_.feed == 0) return problem.set(ErrorCode::kFeedTooSmall, "feed is 0");
  if (modes_.inverse_time) {
    if (*modes_.feed < kMinInverseTime) {
      return problem.set(ErrorCode::kFeedTooSmall,
                         fmt::format("feed is too small: under G93 at least F{} (1,000 minutes)", kMinInverseTime));
    }
    motion.seconds = 60 / *modes_.feed;
    return true;
  }
  bool linear = motion.kind == MotionKind::kArc;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    linear = linear || (!is_rotary(axis) && std::abs(motion.target[axis] - here_.at[axis]) > kStill);
  }
  const double per_minute = *modes_.feed * (modes_.feed_in_inches && linear ? kMmPerInch : 1);
  if (per_minute < kMinFeed) {
    return problem.set(ErrorCode::kFeedTooSmall, fmt::format("feed is too small: {:g} {}/min, at least {} are possible",
                                                             per_minute, linear ? "mm" : "degrees", kMinFeed));
  }
  motion.feed = per_minute / 60;
  return true;
}

}  // namespace trammel::gcode
