#include "program_check.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "end_text.hpp"
#include "profile_report.hpp"
#include "run_report.hpp"
#include "trammel/kinematics/kinematics.hpp"

namespace trammel::app {

CheckResult check_program(const run::ProgramLines& lines, const machine::Machine& machine,
                          const planner::CardLimits& card, const run::RunSettings& settings) {
  CheckResult result;
  result.plan = run::Runner(lines, machine, card, settings).plan();
  result.profile = run::planned_profile(machine, settings);
  result.clock_hz = card.clock_hz;
  const auto* const end = result.plan.end.begin();
  result.end = run::end_position(machine, {end, end + kinematics::Kinematics(machine).joints()});
  return result;
}

std::string summary(const CheckResult& result) {
  const run::Plan& plan = result.plan;
  std::string text = fmt::format("{}: {}, {}, {:.3f} s planned at {:g} MHz; nothing was run\n", plan.file,
                                 counted(plan.segments, "path segment"), counted(plan.commands, "command"),
                                 plan.seconds, result.clock_hz * 1e-6);
  text += end_text(result.end);
  return text + profile_text(result.profile) + blends_text(plan.blends) + probes_planned(plan) +
         accepted_words(plan.accepted);
}

std::string json_text(const CheckResult& result) {
  const run::Plan& plan = result.plan;
  nlohmann::ordered_json json;
  json["program"] = plan.file;
  json["axes"] = result.end.axes;
  json["final_position"] = result.end.pulses;
  json["clock_hz"] = result.clock_hz;
  json["segments"] = plan.segments;
  json["commands"] = plan.commands;
  json["planned_seconds"] = plan.seconds;
  json["profile"] = profile_name(result.profile);
  json["motion"] = motion_json(plan.motion);
  json["blends"] = blends_json(plan.blends);
  json["feeds_not_reached"] = feeds_json(plan.feeds_not_reached);
  json["probes"] = plan.probes;
  json["lines_on_probes"] = plan.lines_on_probes;
  json["accepted_words"] = plan.accepted;
  return json.dump(2) + "\n";
}

}  // namespace trammel::app
