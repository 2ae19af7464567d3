#include <algorithm>

#include "handle.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/arc_chord.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::c {
namespace {

driver::LineCommand line_of(const trammel_line_command& line) {
  driver::LineCommand out;
  out.ticks = line.ticks;
  if (line.ticks == 0 || line.ticks >> card_map::constant::kFractionBits != 0) {
    throw driver::ArgumentError("a line's ticks are 1 .. 2^40 - 1, not " + std::to_string(line.ticks));
  }
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const std::int64_t pulses = line.pulses[axis];
    const auto ticks = static_cast<std::int64_t>(line.ticks);
    if (pulses < -ticks || pulses > ticks) {
      throw driver::ArgumentError("axis " + std::to_string(axis) + " has more pulses than the line has ticks");
    }
    if (pulses == 0) continue;
    out.mask = static_cast<std::uint8_t>(out.mask | 1U << axis);
    out.increment[axis] = driver::rounded_increment(pulses, line.ticks);
  }
  return out;
}

driver::ArcGeometry geometry_of(const trammel_arc_command& arc) {
  return {arc.centre_x, arc.centre_y, arc.end_x,  arc.end_y, arc.clockwise,
          arc.sweep,    arc.turns,    arc.axis_x, arc.axis_y};
}

driver::StepRule rule_of(bool eight_directions) {
  return eight_directions ? driver::StepRule::kEightDirections : driver::StepRule::kFourDirections;
}

driver::ArcCommand arc_of(const trammel_arc_command& arc) {
  if (std::any_of(std::begin(arc.further), std::end(arc.further), [](std::int64_t way) { return way != 0; })) {
    throw driver::ArgumentError("only an arc in chords (TRAMMEL_ARC_CHORD) moves further axes");
  }
  return driver::make_arc(geometry_of(arc), arc.ticks, rule_of(arc.eight_directions));
}

driver::ArcChordCommand chords_of(const trammel_arc_command& arc) {
  if (arc.eight_directions) throw driver::ArgumentError("an arc in chords has no eight_directions");
  driver::HelixGeometry helix;
  helix.arc = geometry_of(arc);
  std::copy(std::begin(arc.further), std::end(arc.further), helix.further.begin());
  return driver::make_helix(helix, arc.ticks);
}

driver::ArcCommand ellipse_of(const trammel_ellipse_command& arc) {
  driver::EllipseGeometry geometry;
  geometry.semi_x = arc.semi_x;
  geometry.semi_y = arc.semi_y;
  geometry.start_x = arc.start_x;
  geometry.start_y = arc.start_y;
  geometry.end_x = arc.end_x;
  geometry.end_y = arc.end_y;
  geometry.clockwise = arc.clockwise;
  geometry.sweep = arc.sweep;
  geometry.turns = arc.turns;
  geometry.axis_x = arc.axis_x;
  geometry.axis_y = arc.axis_y;
  return driver::make_ellipse(geometry, arc.ticks, rule_of(arc.eight_directions));
}

driver::FeedCommand feed_of(const trammel_feed_command& feed) {
  driver::FeedCommand out;
  out.ticks = feed.ticks;
  out.rate = feed.rate;
  out.acceleration = feed.acceleration;
  out.jerk = feed.jerk;
  out.floor = feed.floor;
  out.stop_distance = feed.stop_distance;
  out.piece_class = piece_class_of(feed.piece_class);
  out.silent = feed.silent;
  out.slew_shift = static_cast<std::uint8_t>(std::min<std::uint32_t>(feed.slew_shift, UINT8_MAX));
  return out;
}

}  // namespace

driver::Command command_of(const trammel_command& command) {
  switch (command.kind) {
    case TRAMMEL_LINE:
      return line_of(command.as.line);
    case TRAMMEL_ARC:
      return arc_of(command.as.arc);
    case TRAMMEL_ELLIPSE:
      return ellipse_of(command.as.ellipse);
    case TRAMMEL_ARC_CHORD:
      return chords_of(command.as.arc);
    case TRAMMEL_FEED:
      return feed_of(command.as.feed);
    case TRAMMEL_DWELL:
      return driver::DwellCommand{command.as.dwell_clocks};
    case TRAMMEL_END:
      return driver::EndCommand{};
    case TRAMMEL_OUTPUT:
      return driver::OutputCommand{command.as.output.set, command.as.output.clear};
    case TRAMMEL_MARK:
      return driver::MarkCommand{};
    case TRAMMEL_WAIT_INPUT: {
      const trammel_input_condition& until = command.as.wait_input;
      return driver::WaitInputCommand{until.input, until.level, until.timeout};
    }
    case TRAMMEL_PWM: {
      const trammel_pwm_command& pwm = command.as.pwm;
      return driver::PwmCommand{pwm.channel, pwm.duty, pwm.follows, pwm.shift, pwm.gain};
    }
  }
  throw driver::ArgumentError("kind " + std::to_string(command.kind) + " is none of trammel_command_kind");
}

}  // namespace trammel::c
