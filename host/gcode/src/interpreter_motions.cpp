// The motion words: curves, drilling cycles and probing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arc.hpp"
#include "codes.hpp"
#include "interpreter.hpp"
#include "left_out.hpp"
#include "splines.hpp"

namespace trammel::gcode {

const Interpreter::Plane& Interpreter::plane() const {
  static constexpr Plane kPlaneXy{'X', 'Y', 'Z', 'I', 'J', 'K'};
  static constexpr Plane kPlaneZx{'Z', 'X', 'Y', 'K', 'I', 'J'};
  static constexpr Plane kPlaneYz{'Y', 'Z', 'X', 'J', 'K', 'I'};
  return modes_.plane == 170 ? kPlaneXy : modes_.plane == 180 ? kPlaneZx : kPlaneYz;
}

bool Interpreter::plane_axis(char letter, const char* what, std::size_t& axis, Problem& problem) const {
  const auto found = machine_.axis(letter);
  if (!found) {
    return problem.set(ErrorCode::kArcPlaneAxis,
                       fmt::format("{} in this plane needs an axis {}, which the machine lacks", what, letter));
  }
  axis = *found;
  return true;
}

bool Interpreter::arc(const Context& context, bool clockwise) {
  const Plane& in = plane();
  Problem& problem = context.problem;
  if (context.words.letter(in.unused_offset).value_or(0) != 0) {
    return problem.set(ErrorCode::kArcOutsidePlane, fmt::format("{} in the plane {}{} (G{})", in.unused_offset,
                                                                in.first, in.second, modes_.plane / 10));
  }
  std::size_t x = 0;
  std::size_t y = 0;
  if (!plane_axis(in.first, "an arc", x, problem) || !plane_axis(in.second, "an arc", y, problem)) {
    return false;
  }
  Place target;
  if (!target_of(context, target)) {
    return false;
  }
  Motion& motion = context.motions.add(MotionKind::kArc, line_);
  motion.target = target.at;
  motion.clockwise = clockwise;
  motion.axis_x = static_cast<std::uint8_t>(x);
  motion.axis_y = static_cast<std::uint8_t>(y);
  if (!set_turns(context, motion) || !arc_geometry(context, in, motion) || !set_speed(context, motion)) {
    return false;
  }
  arrive(target, motion);
  return true;
}

// Precondition: the motion has its target and the axes of its plane.
bool Interpreter::arc_geometry(const Context& context, const Plane& plane, Motion& motion) const {
  const std::size_t x = motion.axis_x;
  const std::size_t y = motion.axis_y;
  ArcWords words{{here_.at[x], here_.at[y]},
                 {motion.target[x], motion.target[y]},
                 motion.clockwise,
                 {},
                 {},
                 modes_.centre_absolute,
                 {}};
  const auto centre = [&](char letter, std::size_t axis) -> std::optional<double> {
    const auto word = context.words.letter(letter);
    if (!word) {
      return std::nullopt;
    }
    return to_mm(axis, *word) + (modes_.centre_absolute ? offsets_.total(axis) : 0);
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

// P, if neither G4 nor G64 takes it: the number of turns, of which the last one may be incomplete.
bool Interpreter::set_turns(const Context& context, Motion& motion) const {
  constexpr double kMaxTurns = 10'000;
  const WordSet& words = context.words;
  const auto turns = words.letter('P');
  if (!turns || words.code(Group::kNonModal) == code::kDwell || words.code(Group::kPathControl) == code::kBlend) {
    return true;
  }
  if (*turns < 1 || *turns > kMaxTurns || *turns != std::floor(*turns)) {
    return context.problem.set(
        ErrorCode::kArcTurns,
        fmt::format("P{:.10g}: an arc makes a whole number of turns, 1 to {:.0f}", *turns, kMaxTurns));
  }
  motion.turns = static_cast<std::uint32_t>(*turns) - 1;
  return true;
}

// `first`: control point from the start; `second`: control point from the end; mm.
bool Interpreter::spline_controls(const Context& context, std::array<double, 2>& first, std::array<double, 2>& second) {
  const auto& [words, motions, problem] = context;
  const bool i = words.letter('I').has_value();
  const bool j = words.letter('J').has_value();
  const double unit = modes_.mm_per_unit();
  first = {words.letter('I').value_or(0) * unit, words.letter('J').value_or(0) * unit};
  if (modes_.motion == code::kQuadratic) {
    return (first[0] != 0 || first[1] != 0) ||
           problem.set(ErrorCode::kMissingWord, "G5.1 needs I or J, its control point from the start");
  }
  if (!words.letter('P') || !words.letter('Q')) {
    return problem.set(ErrorCode::kMissingWord, "G5 needs P and Q, its second control point from the end");
  }
  second = {*words.letter('P') * unit, *words.letter('Q') * unit};
  if (i != j || (!i && !spline_end_)) {
    return problem.set(ErrorCode::kMissingWord, "G5 needs I and J; both may be missing where it follows another G5");
  }
  if (!i) first = {-(*spline_end_)[0], -(*spline_end_)[1]};
  return true;
}

bool Interpreter::spline(const Context& context) {
  const auto& [words, motions, problem] = context;
  std::size_t x = 0;
  std::size_t y = 0;
  if (modes_.plane != 170) {
    return problem.set(ErrorCode::kArcOutsidePlane, "G5 and G5.1 are curves in the plane XY (G17)");
  }
  if (!plane_axis('X', "a spline", x, problem) || !plane_axis('Y', "a spline", y, problem)) return false;
  if ((words.axes() & ~(1U << x | 1U << y)) != 0) {
    return problem.set(ErrorCode::kArcOutsidePlane, "G5 and G5.1 move X and Y alone");
  }
  if (modes_.inverse_time) return problem.set(ErrorCode::kInverseTime, "G5 and G5.1 need a feed: G94, not G93");
  std::array<double, 2> first{};
  std::array<double, 2> second{};
  Place target;
  if (!spline_controls(context, first, second) || !target_of(context, target)) return false;
  const PlanePoint start{here_.at[x], here_.at[y]};
  const PlanePoint end{target.at[x], target.at[y]};
  const PlanePoint control{start.x + first[0], start.y + first[1]};
  const Cubic curve = modes_.motion == code::kQuadratic
                          ? cubic_of(start, control, end)
                          : Cubic{start, control, {end.x + second[0], end.y + second[1]}, end};
  const std::uint32_t lines = lines_of(curve);
  if (lines > kMaxSplineLines) {
    return problem.set(ErrorCode::kTooManyMotions,
                       fmt::format("a curve that takes more than {} lines", kMaxSplineLines));
  }
  for (std::uint32_t n = 1; n <= lines; ++n) {
    const PlanePoint point = point_of(curve, n, lines);
    Motion& motion = motions.add(MotionKind::kLine, line_);
    Place to = target;
    to.at[x] = point.x;
    to.at[y] = point.y;
    motion.target = to.at;
    if (!set_speed(context, motion)) return false;
    arrive(to, motion);
    if (n < lines) motion.path_control = PathControl::kContinuous;  // the program has no corner there
  }
  if (modes_.motion == code::kSpline) spline_end_ = second;
  return true;
}

// Appends the motions of a cycle.
class Interpreter::CycleMotions final : public CycleSink {
 public:
  CycleMotions(Interpreter& in, const Context& context, const PlaneAxes& axes, double seconds)
      : in_(in), context_(context), axes_(axes), seconds_(seconds) {}
  bool good() const { return good_; }

  void position(const std::array<double, 2>& to) override {
    Place target = in_.here_;
    target.at[axes_.first] = to[0];
    target.at[axes_.second] = to[1];
    go(CycleStep::kRapid, target);
  }
  void level(CycleStep how, double to) override {
    if (how == CycleStep::kDwell) {
      in_.stop(context_.motions, seconds_);
      return;
    }
    Place target = in_.here_;
    target.at[axes_.normal] = to;
    go(how, target);
  }

 private:
  void go(CycleStep how, const Place& target) {
    if (!good_ || target.at == in_.here_.at) return;
    Motion& motion =
        context_.motions.add(how == CycleStep::kFeed ? MotionKind::kLine : MotionKind::kTraverse, in_.line_);
    motion.target = target.at;
    good_ = how != CycleStep::kFeed || in_.set_speed(context_, motion);
    in_.arrive(target, motion);
    // The corners of a cycle are not blended.
    if (motion.path_control == PathControl::kContinuous) motion.path_control = PathControl::kExactPath;
    motion.tolerance = 0;
  }

  Interpreter& in_;
  const Context& context_;
  const PlaneAxes& axes_;
  double seconds_;
  bool good_ = true;
};

bool Interpreter::check_cycle(const Context& context, const PlaneAxes& axes) const {
  const auto& [words, motions, problem] = context;
  const std::string name = name_of('G', *modes_.motion);
  if (modes_.inverse_time) {
    return problem.set(ErrorCode::kInverseTime, fmt::format("{} needs a feed: G94, not G93", name));
  }
  if ((words.axes() & ~(1U << axes.first | 1U << axes.second | 1U << axes.normal)) != 0) {
    return problem.set(ErrorCode::kArcOutsidePlane, fmt::format("{} moves X, Y and Z alone", name));
  }
  const auto repeats = words.letter('L');
  if (repeats && (*repeats < 1 || *repeats > kMaxCycleMotions)) {
    return problem.set(ErrorCode::kTooManyMotions,
                       fmt::format("L{:.10g}: a cycle is repeated 1 to {} times", *repeats, kMaxCycleMotions));
  }
  return true;
}

// `fresh`: this is the first line of the cycle.
bool Interpreter::set_sticky(const Context& context, int code, const PlaneAxes& axes, bool fresh) {
  const auto& [words, motions, problem] = context;
  const char* const missing = !words.has_axis(axes.normal)               ? "the bottom of its holes"
                              : !words.letter('R')                       ? "R, the level above its holes"
                              : pecks(code) && !words.letter('Q')        ? "Q, the depth of a peck"
                              : dwells_below(code) && !words.letter('P') ? "P, the seconds at the bottom"
                                                                         : nullptr;
  if (fresh && missing != nullptr) {
    return problem.set(ErrorCode::kMissingWord, fmt::format("{} needs {}", name_of('G', code), missing));
  }
  sticky_.later = (sticky_.later && !fresh) || words.later('R') || words.later('Q') || words.later('P') ||
                  words.axis_later(axes.normal);
  if (words.letter('R')) sticky_.retract = word(words, 'R', axes.normal).value;
  if (words.letter('Q')) sticky_.peck = word(words, 'Q', axes.normal).value;
  if (words.letter('P')) sticky_.seconds = std::max(0.0, *words.letter('P'));
  if (words.has_axis(axes.normal)) sticky_.bottom = to_mm(axes.normal, words.axis(axes.normal));
  return true;
}

void Interpreter::begin_series(std::size_t normal) {
  sticky_.start = here_.at[normal];
  sticky_.zero = offsets_.total(normal);
  sticky_.start_later = here_.is_later(normal) || offsets_.later(normal);
}

// The holes of a line, from the present position; `target` is the first hole.
CycleHoles Interpreter::holes_to(const Place& target, int code, const PlaneAxes& axes, double repeats) const {
  CycleHoles holes;
  holes.code = code;
  holes.start = here_.at[axes.normal];
  const double zero = offsets_.total(axes.normal);
  const double start = sticky_.start + (zero - sticky_.zero);  // it keeps its coordinate when an offset changes
  holes.retract = (modes_.absolute ? zero : start) + sticky_.retract;
  holes.bottom = (modes_.absolute ? zero : holes.retract) + sticky_.bottom;
  holes.clear = modes_.retract_to_start ? std::max(start, holes.retract) : holes.retract;
  holes.peck = sticky_.peck;
  holes.seconds = sticky_.seconds;
  holes.first = {target.at[axes.first], target.at[axes.second]};
  if (!modes_.absolute) {
    holes.next = {holes.first[0] - here_.at[axes.first], holes.first[1] - here_.at[axes.second]};
  }
  holes.count = static_cast<std::uint32_t>(repeats);
  return holes;
}

bool Interpreter::cycle(const Context& context, std::optional<int> before) {
  const auto& [words, motions, problem] = context;
  const int code = *modes_.motion;
  const Plane& in = plane();
  PlaneAxes axes{};
  if (!plane_axis(in.first, "a cycle", axes.first, problem) ||
      !plane_axis(in.second, "a cycle", axes.second, problem) ||
      !plane_axis(in.normal, "a cycle", axes.normal, problem) || !check_cycle(context, axes)) {
    return false;
  }
  const bool series = is_cycle(before) && cycle_plane_ == modes_.plane;
  if (!set_sticky(context, code, axes, before != code || !series)) return false;
  if (!series) begin_series(axes.normal);
  cycle_plane_ = modes_.plane;
  Place target;
  if (!target_of(context, target)) return false;
  const CycleHoles holes = holes_to(target, code, axes, words.letter('L').value_or(1));
  if (holes.retract < holes.bottom) {
    return problem.set(ErrorCode::kCycleLevels,
                       fmt::format("R of {} is below {}, the bottom of the hole", name_of('G', code), in.normal));
  }
  if (pecks(code) && !(holes.peck > 0)) {
    return problem.set(ErrorCode::kCycleLevels, fmt::format("Q of {} must be above 0", name_of('G', code)));
  }
  if (motions_of(holes) > kMaxCycleMotions) {
    return problem.set(ErrorCode::kTooManyMotions,
                       fmt::format("a cycle of more than {} motions on one line", kMaxCycleMotions));
  }
  here_.later = target.later;
  const bool needs_start = !modes_.absolute || modes_.retract_to_start;
  if (sticky_.later || offsets_.later(axes.normal) || (needs_start && sticky_.start_later)) {
    here_.later |= 1U << axes.normal;
  }
  CycleMotions sink(*this, context, axes, holes.seconds);
  drill(holes, sink);
  return sink.good();
}

bool Interpreter::probe(const Context& context) {
  const auto& [words, motions, problem] = context;
  const int code = *modes_.motion;
  const std::string name = name_of('G', code);
  if (modes_.inverse_time) {
    return problem.set(ErrorCode::kInverseTime, fmt::format("{} needs a feed: G94, not G93", name));
  }
  if (!machine_.probe.input) {
    return problem.set(
        ErrorCode::kNoProbe,
        fmt::format("{}: the machine file has no probe: --set probe.input=N or [probe] of the file names its "
                    "input",
                    name));
  }
  Place target;
  if (!target_of(context, target)) return false;
  if (target.at == here_.at) {
    return problem.set(ErrorCode::kProbeWay, fmt::format("{} ends where it begins", name));
  }
  Motion& motion = motions.add(MotionKind::kProbe, line_);
  motion.target = target.at;
  motion.probe_away = code == code::kProbeAway || code == code::kProbeAwayQuietly;
  motion.probe_must_trip = code == code::kProbe || code == code::kProbeAway;
  if (!set_speed(context, motion)) return false;
  if (code == code::kSkip) modes_.motion.reset();  // G31 counts for one line
  motion.later = static_cast<std::uint8_t>(target.later);
  probe_target_ = target.at;
  probe_axes_ = here_.later;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    if (target.at[axis] != here_.at[axis] || target.is_later(axis)) probe_axes_ |= 1U << axis;
  }
  return true;
}

// Results are program coordinates in the units of the line, as in LinuxCNC.
void Interpreter::probed(const Coordinates& edge, const Coordinates& rest, bool tripped) {
  here_ = {};
  here_.at = rest;
  for (int nth = 0; nth < kParameterAxes; ++nth) {
    const auto axis = parameter_axis(machine_, nth);
    auto& result = probe_results_[static_cast<std::size_t>(nth)];
    result = axis ? Value{to_program(*axis, edge[*axis]), offsets_.later(*axis)} : Value{};
  }
  probe_success_ = {tripped ? 1.0 : 0.0, false};
}

void Interpreter::assume_probed() {
  probed(probe_target_, probe_target_, true);
  here_.later = probe_axes_;
  probe_success_.later = true;
  for (int nth = 0; nth < kParameterAxes; ++nth) {
    const auto axis = parameter_axis(machine_, nth);
    if (axis && (probe_axes_ >> *axis & 1U) != 0) probe_results_[static_cast<std::size_t>(nth)].later = true;
  }
}

}  // namespace trammel::gcode
