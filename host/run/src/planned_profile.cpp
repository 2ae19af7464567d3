#include "trammel/run/planned_profile.hpp"

namespace trammel::run {

PlannedProfile planned_profile(const machine::Machine& machine, const RunSettings& settings) {
  PlannedProfile result;
  result.s_curve =
      planner::profile_of(machine, {settings.single_block, settings.profile}) == planner::SpeedProfile::kSCurve;
  if (settings.profile != planner::SpeedProfile::kByMachine) return result;
  for (const machine::MachineAxis& axis : machine.axes) {
    if (axis.max_jerk == 0) result.without_jerk += axis.letter;
  }
  return result;
}

}  // namespace trammel::run
