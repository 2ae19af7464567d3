#include "trammel/machine/stop_ways.hpp"

#include <algorithm>
#include <cmath>

#include "trammel/driver/roles.hpp"

namespace trammel::machine {

namespace {

constexpr double kScanClocks = 64;

// Filter time of an axis's limit switches plus a scan, s; none if it has no limit switch.
std::optional<double> filter_of_limits(const Machine& machine, std::size_t axis) {
  using driver::AxisRole;
  using driver::Role;
  const auto& roles = machine.inputs.roles;
  const std::uint32_t limits = roles[Role(AxisRole::kLimitMinus, static_cast<unsigned>(axis)).number()].inputs |
                               roles[Role(AxisRole::kLimitPlus, static_cast<unsigned>(axis)).number()].inputs;
  if (limits == 0) return std::nullopt;
  double longest = 0;
  for (unsigned n = 0; n < kMaxInputs; ++n) {
    if ((limits >> n & 1) != 0) longest = std::max(longest, machine.inputs.filter_of(n));
  }
  return longest * 1e-3 + kScanClocks / machine.clock_hz;
}

}  // namespace

std::vector<StopWay> stop_ways(const Machine& machine) {
  std::vector<StopWay> ways(machine.axes.size());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const double velocity = machine.axes[i].max_velocity;
    ways[i].ramp = velocity * hold_seconds(machine) / 2;
    if (const auto seconds = filter_of_limits(machine, i)) ways[i].filter = velocity * *seconds;
  }
  return ways;
}

bool ramp_fits(const StopWay& way, const MachineAxis& axis) {
  return !way.filter || way.behind_switch() <= axis.overtravel;
}

double hold_share(const Machine& machine) {
  const double reserve = machine.motion.hold_reserve;
  return reserve > 0 ? reserve : 0.5;
}

double hold_seconds(const Machine& machine) {
  double longest = 0;
  for (const MachineAxis& axis : machine.axes) {
    longest = std::max(longest, axis.max_velocity / axis.max_acceleration);
  }
  return longest / hold_share(machine);
}

LimitStop limit_stop(const Machine& machine) {
  LimitStop stop;
  stop.ramps = machine.inputs.on_limit != OnLimit::kImmediate;
  const std::vector<StopWay> ways = stop_ways(machine);
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const MachineAxis& axis = machine.axes[i];
    if (!ways[i].filter) continue;
    stop.ramps = stop.ramps && ramp_fits(ways[i], axis);
    const double counted = axis.overtravel - *ways[i].filter;
    stop.overtravel[i] = static_cast<std::uint32_t>(std::clamp(std::floor(counted * axis.steps_per_mm), 0.0, 65535.0));
  }
  return stop;
}

}  // namespace trammel::machine
