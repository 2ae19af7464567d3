#include "profile_report.hpp"

#include <fmt/format.h>

namespace trammel::app {
namespace {

constexpr double kLongestRise = 1;  // s

}  // namespace

const char* profile_name(const run::PlannedProfile& profile) { return profile.s_curve ? "s-curve" : "trapezoid"; }

std::string profile_text(const run::PlannedProfile& profile) {
  std::string text = fmt::format("  profile: {}", profile_name(profile));
  if (profile.without_jerk.empty()) return text + "\n";
  text += " (S-curves need a max_jerk of";
  for (const char letter : profile.without_jerk) text += fmt::format(" {}", letter);
  return text + ")\n";
}

std::vector<std::string> jerk_warnings(const machine::Machine& machine) {
  std::vector<std::string> lines;
  for (const machine::MachineAxis& axis : machine.axes) {
    if (axis.max_jerk == 0 || axis.max_acceleration / axis.max_jerk <= kLongestRise) continue;
    lines.push_back(
        fmt::format("axis {}: at a max_jerk of {:g} its acceleration takes {:.3g} s to rise to {:g}; max_jerk is in "
                    "mm/s^3",
                    axis.letter, axis.max_jerk, axis.max_acceleration / axis.max_jerk, axis.max_acceleration));
  }
  return lines;
}

}  // namespace trammel::app
