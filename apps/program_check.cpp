#include "program_check.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "run_report.hpp"

namespace trammel::app {

CheckResult check_program(const run::ProgramLines& lines, const machine::Machine& machine,
                          const planner::CardLimits& card, const run::RunSettings& settings) {
  CheckResult result;
  result.plan = run::Runner(lines, machine, card, settings).plan();
  result.profile = profile_of(machine, settings);
  result.clock_hz = card.clock_hz;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    result.axes += machine.axes[a].letter;
    result.final_millimetres.push_back(static_cast<double>(result.plan.end[a]) / machine.axes[a].steps_per_mm);
  }
  return result;
}

std::string summary(const CheckResult& result) {
  const run::Plan& plan = result.plan;
  std::string text = fmt::format("{}: {} path segments, {} commands, {:.3f} s planned at {:g} MHz; nothing was run\n",
                                 plan.file, plan.segments, plan.commands, plan.seconds, result.clock_hz * 1e-6);
  for (std::size_t a = 0; a < result.axes.size(); ++a) {
    text +=
        fmt::format("  {}: ends at pulse {} ({:.4f} mm)\n", result.axes[a], plan.end[a], result.final_millimetres[a]);
  }
  return text + summary(result.profile) + blends_text(plan.blends) + probes_planned(plan) +
         accepted_words(plan.accepted);
}

std::string json_text(const CheckResult& result) {
  const run::Plan& plan = result.plan;
  nlohmann::ordered_json json;
  json["program"] = plan.file;
  json["axes"] = result.axes;
  json["final_position"] = nlohmann::ordered_json::array();
  for (std::size_t a = 0; a < result.axes.size(); ++a) json["final_position"].push_back(plan.end[a]);
  json["clock_hz"] = result.clock_hz;
  json["segments"] = plan.segments;
  json["commands"] = plan.commands;
  json["planned_seconds"] = plan.seconds;
  json["profile"] = name_of(result.profile);
  json["motion"] = motion_json(plan.motion);
  json["blends"] = blends_json(plan.blends);
  json["feeds_not_reached"] = feeds_json(plan.feeds_not_reached);
  json["probes"] = plan.probes;
  json["lines_on_probes"] = plan.lines_on_probes;
  json["accepted_words"] = plan.accepted;
  return json.dump(2) + "\n";
}

}  // namespace trammel::app
