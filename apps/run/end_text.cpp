#include "end_text.hpp"

#include <fmt/format.h>

namespace trammel::app {

std::string end_text(const run::EndPosition& end, const std::vector<std::uint64_t>& made) {
  std::string text;
  for (std::size_t a = 0; a < end.axes.size(); ++a) {
    if (!end.joint_for_each_axis) {
      text += fmt::format("  {}: ends at {:.4f} mm\n", end.axes[a], end.millimetres[a]);
      continue;
    }
    const std::string first = made.empty() ? "" : fmt::format("{} pulses made, ", made[a]);
    text +=
        fmt::format("  {}: {}ends at pulse {} ({:.4f} mm)\n", end.axes[a], first, end.pulses[a], end.millimetres[a]);
  }
  if (end.joint_for_each_axis) return text;
  text += fmt::format("  motors: at pulses {}\n", fmt::join(end.pulses, ", "));
  if (!made.empty()) text += fmt::format("  motors: {} pulses made\n", fmt::join(made, ", "));
  return text;
}

}  // namespace trammel::app
