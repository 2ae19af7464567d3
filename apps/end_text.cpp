#include "end_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "trammel/kinematics/kinematics.hpp"

namespace trammel::app {

std::vector<double> end_millimetres(const machine::Machine& machine, const std::vector<std::int64_t>& pulses) {
  kinematics::Pulses at{};
  std::copy_n(pulses.begin(), std::min(pulses.size(), at.size()), at.begin());
  const kinematics::Coordinates end = kinematics::Kinematics(machine).coordinates(at);
  return {end.begin(), end.begin() + static_cast<std::ptrdiff_t>(machine.axes.size())};
}

std::string end_text(const std::string& axes, const std::vector<std::int64_t>& pulses,
                     const std::vector<double>& millimetres, bool joint_for_each_axis,
                     const std::vector<std::uint64_t>& made) {
  std::string text;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (!joint_for_each_axis) {
      text += fmt::format("  {}: ends at {:.4f} mm\n", axes[a], millimetres[a]);
      continue;
    }
    const std::string first = made.empty() ? "" : fmt::format("{} pulses made, ", made[a]);
    text += fmt::format("  {}: {}ends at pulse {} ({:.4f} mm)\n", axes[a], first, pulses[a], millimetres[a]);
  }
  if (joint_for_each_axis) return text;
  text += fmt::format("  motors: at pulses {}\n", fmt::join(pulses, ", "));
  if (!made.empty()) text += fmt::format("  motors: {} pulses made\n", fmt::join(made, ", "));
  return text;
}

}  // namespace trammel::app
