#include "trammel/run/jog_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "jog_profile.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::run {
namespace {

constexpr double kShaperShare = 0.95;     // fraction of the shaper's maximum pulse rate
constexpr double kTicksPerPulse = 128;    // makes step intervals even to 1/64
constexpr double kMaxPulses = 0x1p30;     // per jog and axis: half of the counters' range in each direction
constexpr double kMaxTicks = 0x1p39;      // half of a command's 40 bits
constexpr double kMinPathTicks = 64;      // per path
constexpr double kMinTickRate = 0x1p-30;  // ticks per clock

// Limits along a direction: those of all axes that move.
struct Allowed {
  double speed = std::numeric_limits<double>::infinity();         // mm/s along the path
  double acceleration = std::numeric_limits<double>::infinity();  // mm/s^2
  double length = std::numeric_limits<double>::infinity();        // mm to the first soft limit
  double pulses = 0;                                              // pulses of the finest axis per mm of path
};

// The distance that an axis may move in a direction, in the finest steps that move it; an integer within the soft
// limits.
double room(const machine::MachineAxis& axis, double finest, double here, bool upwards) {
  const double limit = upwards ? std::floor(axis.max * finest) : -std::ceil(axis.min * finest);
  return std::min(limit - (upwards ? here : -here) * finest, kMaxPulses);
}

// Applies the limits of the joints along a direction.
void limit_joints(const kinematics::Kinematics& kinematics, const driver::CardTiming& card,
                  const gcode::Coordinates& direction, Allowed& result) {
  for (std::size_t joint = 0; joint < kinematics.joints(); ++joint) {
    const double share = std::abs(kinematics.joint_rate(joint, direction));
    if (share == 0) continue;
    const kinematics::Joint& of = kinematics.joint(joint);
    const double shaper = kShaperShare * card.clock_hz / card.pulse_period[joint] / of.steps_per_mm;
    result.speed = std::min(result.speed, std::min(of.limits.velocity, shaper) / share);
    result.acceleration = std::min(result.acceleration, of.limits.acceleration / share);
    result.pulses = std::max(result.pulses, share * of.steps_per_mm);
  }
}

Allowed allowed(const machine::Machine& machine, const kinematics::Kinematics& kinematics,
                const driver::CardTiming& card, const planner::Pulses& here, const gcode::Coordinates& direction) {
  Allowed result;
  const gcode::Coordinates at = kinematics.coordinates(here);
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    if (direction[a] == 0) continue;
    const machine::MachineAxis& axis = machine.axes[a];
    const double share = std::abs(direction[a]);
    const double finest = kinematics.finest(a);
    const double pulses = room(axis, finest, at[a], direction[a] > 0);
    if (pulses < 1) {
      throw driver::ArgumentError(fmt::format("jog: axis {} stands at its soft limit, {:g} mm", axis.letter,
                                              direction[a] > 0 ? axis.max : axis.min));
    }
    result.speed = std::min(result.speed, axis.max_velocity / share);
    result.acceleration = std::min(result.acceleration, axis.max_acceleration / share);
    result.length = std::min(result.length, pulses / finest / share);
  }
  limit_joints(kinematics, card, direction, result);
  return result;
}

double norm(const machine::Machine& machine, const gcode::Coordinates& vector) {
  double sum = 0;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) sum += vector[a] * vector[a];
  if (!(sum > 0) || !std::isfinite(sum)) throw driver::ArgumentError("jog: no axis is told to move");
  return std::sqrt(sum);
}

// The path, which ends at rest. `length`: mm along the path; `limits`: the limits along it.
JogPath made(const kinematics::Kinematics& kinematics, const driver::CardTiming& card,
             const gcode::Coordinates& direction, double length, double speed, const Allowed& limits) {
  JogPath path;
  path.length = length;
  path.speed = speed;
  path.ramp_seconds = 2 * speed / limits.acceleration;
  const double rate = speed * limits.pulses;  // pulses/s
  const double per_pulse =
      std::max(std::min(kTicksPerPulse, kMaxTickRate * card.clock_hz / rate), kMinTickRate * card.clock_hz / rate);
  const double ticks = std::clamp(std::round(per_pulse * limits.pulses * length), kMinPathTicks, kMaxTicks);
  path.ticks = static_cast<std::uint64_t>(ticks);
  gcode::Coordinates way{};
  for (std::size_t a = 0; a < kinematics.axes(); ++a) way[a] = direction[a] * length;
  for (std::size_t joint = 0; joint < kinematics.joints(); ++joint) {
    // Rounded towards zero, so never beyond a limit.
    const double slack = 1e-9;
    path.pulses[joint] = static_cast<std::int64_t>(kinematics.pulse_rate(joint, way) * (1 + slack));
    if (path.pulses[joint] != 0) path.mask = static_cast<std::uint8_t>(path.mask | 1U << joint);
  }
  if (path.mask == 0)
    throw driver::ArgumentError(fmt::format("jog: {:g} mm are less than a pulse of any axis", length));
  const double density = ticks / length / card.clock_hz;
  const double tick_rate = std::min(speed * density, kMaxTickRate);
  path.pieces = jog_profile(path.ticks, tick_rate, limits.acceleration * density / card.clock_hz);
  constexpr double kMaxStop = std::numeric_limits<std::uint32_t>::max();
  path.stop_distance = static_cast<std::uint32_t>(
      std::clamp(std::ceil(path.ramp_seconds / 2 * card.clock_hz * tick_rate), 1.0, kMaxStop));
  for (std::size_t i = 0; i + 1 < path.pieces.size(); ++i) path.pieces[i].stop_distance = path.stop_distance;
  return path;
}

}  // namespace

driver::LineCommand line_of(const JogPath& path, std::uint64_t from, std::uint64_t to) {
  driver::LineCommand line;
  line.ticks = to - from;
  line.mask = path.mask;
  const auto pulses_at = [&](std::size_t axis, std::uint64_t tick) {
    return std::llround(static_cast<double>(path.pulses[axis]) *
                        (static_cast<double>(tick) / static_cast<double>(path.ticks)));
  };
  for (std::size_t a = 0; a < path.pulses.size(); ++a) {
    const std::int64_t pulses = pulses_at(a, to) - pulses_at(a, from);
    if (pulses != 0) line.increment[a] = driver::rounded_increment(pulses, line.ticks);
  }
  return line;
}

JogPath jog_path(const machine::Machine& machine, const driver::CardTiming& card, const planner::Pulses& here,
                 const gcode::Coordinates& velocity) {
  const double speed = norm(machine, velocity);
  gcode::Coordinates direction{};
  for (std::size_t a = 0; a < machine.axes.size(); ++a) direction[a] = velocity[a] / speed;
  const kinematics::Kinematics kinematics(machine);
  const Allowed limits = allowed(machine, kinematics, card, here, direction);
  const double ramps = limits.speed * limits.speed / limits.acceleration;  // mm, total of both ramps
  if (limits.length < 2 * ramps) {
    return made(kinematics, card, direction, limits.length, std::min(speed, limits.speed), limits);
  }
  JogPath path = made(kinematics, card, direction, limits.length, limits.speed, limits);
  if (path.pieces.size() == 3) {
    // The pieces begin at full rate; the ratio rises from 0.
    path.pieces[1].ticks += path.pieces[0].ticks;
    path.pieces.erase(path.pieces.begin());
    path.ramped_by_time_base = true;
  }
  return path;
}

JogPath jog_path(const machine::Machine& machine, const driver::CardTiming& card, const planner::Pulses& here,
                 const gcode::Coordinates& distance, double speed) {
  if (!(speed > 0) || !std::isfinite(speed)) {
    throw driver::ArgumentError(fmt::format("jog: a speed of {:g} mm/s", speed));
  }
  const double length = norm(machine, distance);
  gcode::Coordinates direction{};
  for (std::size_t a = 0; a < machine.axes.size(); ++a) direction[a] = distance[a] / length;
  const kinematics::Kinematics kinematics(machine);
  const Allowed limits = allowed(machine, kinematics, card, here, direction);
  return made(kinematics, card, direction, std::min(length, limits.length), std::min(speed, limits.speed), limits);
}

}  // namespace trammel::run
