#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "machine_command.hpp"
#include "trammel/machine/stop_ways.hpp"

namespace trammel::app {
namespace {

using machine::Machine;
using machine::MachineAxis;
using machine::StopWay;

const char* unit_of(const MachineAxis& axis) {
  return axis.letter == 'A' || axis.letter == 'B' || axis.letter == 'C' ? "degrees" : "mm";
}

std::string switch_text(const MachineAxis& axis, const StopWay& way) {
  const char* const unit = unit_of(axis);
  const double spare = axis.overtravel - way.behind_switch();
  return fmt::format(
      "  limit switch: {0:.3g} {4} in its filter time + {1:.3g} {4} of ramp = {2:.3g} {4}; overtravel {3:g} {4}: {5}\n",
      *way.filter, way.ramp, way.behind_switch(), axis.overtravel, unit,
      spare >= 0 ? std::string("a ramp fits")
                 : fmt::format("a ramp does not fit, it needs {:.3g} {} more", -spare, unit));
}

std::string soft_text(const Machine& machine, const MachineAxis& axis, const StopWay& way) {
  if (!std::isfinite(axis.min) && !std::isfinite(axis.max))
    return axis.endless ? "  soft limits: none, the axis is endless\n" : "  soft limits: none\n";
  const auto end = [](double place) { return std::isfinite(place) ? fmt::format("{:g}", place) : std::string("none"); };
  const std::string guard = machine.inputs.on_soft_limit == machine::OnInput::kImmediate
                                ? "immediately at them, as inputs.on_soft_limit says"
                                : fmt::format("up to {:.3g} {} behind them", way.ramp, unit_of(axis));
  return fmt::format("  soft limits: {} to {} {}; jogs brake {:.3g} {} before them, the card's own guard stops {}\n",
                     end(axis.min), end(axis.max), unit_of(axis), way.ramp, unit_of(axis), guard);
}

std::string axis_text(const Machine& machine, std::size_t n, const StopWay& way) {
  const MachineAxis& axis = machine.axes[n];
  std::string text = fmt::format("axis {}: stops from {:g} {}/s in v * T/2 = {:.3g} {}\n", axis.letter,
                                 axis.max_velocity, unit_of(axis), way.ramp, unit_of(axis));
  if (way.filter) text += switch_text(axis, way);
  return text + soft_text(machine, axis, way);
}

// The card has one reaction for all limits, so the axes without enough overtravel determine it.
std::string limits_text(const Machine& machine, const std::vector<StopWay>& ways) {
  bool any = false;
  std::string short_ones;
  for (std::size_t n = 0; n < ways.size(); ++n) {
    any = any || ways[n].filter.has_value();
    if (machine::ramp_fits(ways[n], machine.axes[n])) continue;
    short_ones += fmt::format("{}{}", short_ones.empty() ? "" : ", ", machine.axes[n].letter);
  }
  if (!any) return "limit switches: none\n";
  if (machine.inputs.on_limit == machine::OnLimit::kImmediate)
    return "limit switches: immediate stop, as inputs.on_limit says\n";
  if (short_ones.empty()) return "limit switches: stop on a ramp\n";
  return fmt::format(
      "limit switches: immediate stop at all of them, because a ramp does not fit behind those of axis {}. For a ramp, "
      "this axis needs more overtravel, a shorter filter or a lower max_velocity\n",
      short_ones);
}

}  // namespace

std::string stop_text(const Machine& machine) {
  const std::vector<StopWay> ways = machine::stop_ways(machine);
  std::string text =
      fmt::format("T = {:.3g} s from full speed to rest, for all axes\n", machine::hold_seconds(machine));
  for (std::size_t n = 0; n < ways.size(); ++n) text += axis_text(machine, n, ways[n]);
  return text + limits_text(machine, ways);
}

}  // namespace trammel::app
