#include "trammel/run/end_position.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "trammel/kinematics/kinematics.hpp"

namespace trammel::run {

EndPosition end_position(const machine::Machine& machine, const std::vector<std::int64_t>& pulses) {
  const kinematics::Kinematics kinematics(machine);
  kinematics::Pulses at{};
  std::copy_n(pulses.begin(), std::min(pulses.size(), at.size()), at.begin());
  const kinematics::Coordinates end = kinematics.coordinates(at);
  EndPosition result;
  for (const machine::MachineAxis& axis : machine.axes) result.axes += axis.letter;
  result.pulses = pulses;
  result.millimetres.assign(end.begin(), end.begin() + static_cast<std::ptrdiff_t>(machine.axes.size()));
  result.joint_for_each_axis = kinematics.joint_for_each_axis();
  return result;
}

const char* unit_of(char letter) { return letter == 'A' || letter == 'B' || letter == 'C' ? "degrees" : "mm"; }

std::string place_text(const gcode::Coordinates& place, const machine::Machine& machine) {
  std::string text;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const std::string unit = unit_of(machine.axes[i].letter);
    const bool last = i + 1 == machine.axes.size();
    const bool ends = last || unit != unit_of(machine.axes[i + 1].letter);
    text += fmt::format("{}{} {:.4f}{}", i == 0 ? "" : " ", machine.axes[i].letter, place[i], ends ? " " + unit : "");
  }
  return text;
}

}  // namespace trammel::run
