#include "trammel/run/end_position.hpp"

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

}  // namespace trammel::run
