#include "run_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "end_text.hpp"
#include "profile_report.hpp"

namespace trammel::app {

using simulation::MadeEvent;
using simulation::OperatorEvent;
using simulation::OutputResult;
using simulation::RunResult;

namespace {

// Mismatches of a run with a result: always 0, because a mismatch ends the run.
constexpr int kMismatches = 0;

// Without an exponent and without insignificant digits.
std::string number(double feed) { return feed < 100 ? fmt::format("{:.3g}", feed) : fmt::format("{:.0f}", feed); }

const char* text_of(planner::SpeedLimit cause) {
  switch (cause) {
    case planner::SpeedLimit::kAxisVelocity:
      return "beyond the max_velocity of an axis";
    case planner::SpeedLimit::kPulseShape:
      return "beyond the step length and space of an axis";
    case planner::SpeedLimit::kAcceleration:
      return "too short, or too strong a curve or corner, for the max_acceleration";
    case planner::SpeedLimit::kWindow:
      return "too short a look-ahead (motion.window)";
    case planner::SpeedLimit::kClock:
      return "beyond the card's clock";
    case planner::SpeedLimit::kNone:
      break;
  }
  return "";
}

const char* name_of(OperatorEvent::Kind kind) {
  switch (kind) {
    case OperatorEvent::Kind::kOverride:
      return "override";
    case OperatorEvent::Kind::kHold:
      return "hold";
    case OperatorEvent::Kind::kResume:
      return "resume";
    case OperatorEvent::Kind::kEmergencyStop:
      return "emergency stop";
    case OperatorEvent::Kind::kInput:
      break;
  }
  return "input";
}

nlohmann::ordered_json outputs_json(const std::vector<OutputResult>& outputs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const OutputResult& output : outputs) {
    list.push_back({{"output", output.number},
                    {"words", output.words},
                    {"on", output.at_pin.on},
                    {"off", output.at_pin.off},
                    {"level", output.at_pin.level ? 1 : 0}});
  }
  return list;
}

std::string outputs_text(const std::vector<OutputResult>& outputs) {
  std::string text;
  for (const OutputResult& output : outputs) {
    text += fmt::format("  output {} ({}): switched on {} times, off {} times, {} at the end\n", output.number,
                        fmt::join(output.words, ", "), output.at_pin.on, output.at_pin.off,
                        output.at_pin.level ? "on" : "off");
  }
  return text;
}

nlohmann::ordered_json events_json(const std::vector<MadeEvent>& events) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const MadeEvent& made : events) {
    using Kind = OperatorEvent::Kind;
    const Kind kind = made.event.kind;
    nlohmann::ordered_json entry;
    entry["event"] = name_of(kind);
    if (kind == Kind::kOverride) entry["percent"] = made.event.percent;
    if (kind == Kind::kInput) {
      entry["input"] = made.event.input;
      entry["level"] = made.event.level ? 1 : 0;
    }
    if (kind == Kind::kEmergencyStop) entry["pressed"] = made.event.level;
    entry["seconds"] = made.event.seconds;
    entry["cycle"] = made.cycle;
    list.push_back(entry);
  }
  return list;
}

}  // namespace

std::string counted(std::uint64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string probes_planned(const run::Plan& plan) {
  if (plan.probes == 0) return {};
  return fmt::format(
      "  probes, planned as if they ended at their targets: {}; lines that depend on them and are checked when "
      "reached: {}\n",
      plan.probes, plan.lines_on_probes);
}

std::string accepted_words(const std::map<std::string, std::size_t>& words) {
  const std::array<std::pair<std::string_view, const char*>, 8> reasons{{
      {"|M0|M1|", "stops for the operator, which a simulation does not make:"},
      {"|G64 Q|", "lines are not joined (naive CAM detector):"},
      {"|M3|M4|M5|M7|M8|M9|", "no output for them in [outputs] of the machine file:"},
      {"|S|", "no output for it in [spindle] of the machine file:"},
      {"|M6|", "tool changes, each a stop:"},
      {"|G28|", "rapids to the home position of the machine file, nothing was searched:"},
      {"|G4 P|", "dwells in seconds, which printers' firmware takes as milliseconds:"},
      {"", "no hardware:"},
  }};
  std::array<std::string, reasons.size()> lists;
  for (const auto& [word, count] : words) {
    const std::string name = "|" + word + "|";
    std::size_t i = 0;
    while (!reasons[i].first.empty() && reasons[i].first.find(name) == std::string_view::npos) ++i;
    lists[i] += fmt::format(" {} ({})", word, count);
  }
  std::string text;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (!lists[i].empty()) text += fmt::format("  {}{}\n", reasons[i].second, lists[i]);
  }
  return text;
}

nlohmann::ordered_json motion_json(const run::PlannedMotion& motion) {
  return {{"stops", motion.stops},
          {"velocity_jump", motion.velocity_jump},
          {"acceleration_step", motion.acceleration_step}};
}

std::string blends_text(const run::Blends& blends) {
  const auto count = [&](planner::Corner corner) { return blends.corners[static_cast<std::size_t>(corner)]; };
  std::string text;
  if (count(planner::Corner::kBlended) != 0) {
    text += fmt::format("  blends (G64 P): {}, at most {:.4g} mm from the programmed path\n",
                        count(planner::Corner::kBlended), blends.distance);
  }
  std::string kept;
  const auto say = [&](planner::Corner corner, const char* why) {
    if (count(corner) != 0) kept += fmt::format("{} {} ({})", kept.empty() ? "" : ",", count(corner), why);
  };
  say(planner::Corner::kReversal, "reversals");
  say(planner::Corner::kNoCurve, "with an arc or helix in another plane, or without room for an arc");
  say(planner::Corner::kInvisible, "a blend would stay within a quarter of a pulse");
  say(planner::Corner::kFaster, "a blend would take longer");
  return kept.empty() ? text : text + "  corners not rounded by G64 P:" + kept + "\n";
}

nlohmann::ordered_json blends_json(const run::Blends& blends) {
  const auto count = [&](planner::Corner corner) { return blends.corners[static_cast<std::size_t>(corner)]; };
  return {{"count", count(planner::Corner::kBlended)},
          {"distance", blends.distance},
          {"kept",
           {{"reversal", count(planner::Corner::kReversal)},
            {"no_curve", count(planner::Corner::kNoCurve)},
            {"invisible", count(planner::Corner::kInvisible)},
            {"faster", count(planner::Corner::kFaster)}}}};
}

nlohmann::ordered_json feeds_json(const std::vector<run::FeedNotReached>& feeds) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const run::FeedNotReached& feed : feeds) {
    list.push_back({{"cause", text_of(feed.cause)},
                    {"count", feed.count},
                    {"line", feed.line},
                    {"commanded", feed.wanted},
                    {"reached", feed.reached}});
  }
  return list;
}

std::vector<std::string> plan_warnings(const run::Plan& plan) {
  std::vector<std::string> lines;
  for (const run::FeedNotReached& feed : plan.feeds_not_reached) {
    lines.push_back(fmt::format("{} {} not reach the feed: {}; the worst is at {}:{}, {} of {} mm/min", feed.count,
                                feed.count == 1 ? "move does" : "moves do", text_of(feed.cause), plan.file, feed.line,
                                number(feed.reached), number(feed.wanted)));
  }
  if (const auto dwells = plan.accepted.find("G4 P"); dwells != plan.accepted.end()) {
    lines.push_back(
        fmt::format("{}: G4 P is taken as seconds ({} {}). The program has words of 3D printers, whose firmware takes "
                    "P as milliseconds; G4 S means seconds to both",
                    plan.file, dwells->second, dwells->second == 1 ? "time" : "times"));
  }
  return lines;
}

// In machine coordinates.
std::string probes_text(const std::string& axes, const std::vector<run::ProbeMade>& probes) {
  std::string text;
  for (const run::ProbeMade& probe : probes) {
    text += fmt::format("  probe at line {}: {}", probe.line, probe.tripped ? "edge at" : "no edge, ended at");
    for (std::size_t a = 0; a < axes.size(); ++a) text += fmt::format(" {}{:.4f}", axes[a], probe.edge[a]);
    text += " (machine coordinates, mm)\n";
  }
  return text;
}

nlohmann::ordered_json probes_json(const std::string& axes, const std::vector<run::ProbeMade>& probes) {
  auto list = nlohmann::ordered_json::array();
  for (const run::ProbeMade& probe : probes) {
    const std::vector<double> edge(probe.edge.begin(), probe.edge.begin() + static_cast<std::ptrdiff_t>(axes.size()));
    list.push_back({{"line", probe.line}, {"tripped", probe.tripped}, {"position", edge}});
  }
  return list;
}

namespace {

// The excess over the planned time is caused by under-runs if nobody held the card or changed its speed.
std::string under_runs_text(const RunResult& result, double seconds) {
  if (!result.outcome.under_runs) return "";
  std::string text = fmt::format("  under-runs: {}", *result.outcome.under_runs);
  if (*result.outcome.under_runs != 0 && result.events.empty()) {
    text += fmt::format(", {:.3f} s longer than planned", seconds - result.plan.seconds);
  }
  return text + "\n";
}

}  // namespace

std::string run_summary(const RunResult& result, const run::PlannedProfile& profile) {
  const double seconds = static_cast<double>(result.cycles) / result.clock_hz;
  std::string text = fmt::format("{}: {}, {}, {:.3f} s of card time at {:g} MHz\n", result.plan.file,
                                 counted(result.plan.segments, "path segment"),
                                 counted(result.outcome.commands, "command"), seconds, result.clock_hz * 1e-6);
  text += end_text(result.end, result.steps);
  text += profile_text(profile);
  text += under_runs_text(result, seconds);
  text += fmt::format("  largest deviation: lines {:.4f} pulses, arcs {:.4f} pulses\n", result.largest_line_deviation,
                      result.largest_arc_deviation);
  text += fmt::format("  path: {} steps, identity {}; shapers {} to {} clocks late\n", result.path_steps,
                      result.path_identity, result.shaper_delay.least, result.shaper_delay.most);
  if (result.achieved_feed) {
    text += fmt::format("  mean feed {} of {} mm/min\n", number(*result.achieved_feed), number(*result.commanded_feed));
  }
  text += blends_text(result.plan.blends);
  text += probes_text(result.end.axes, result.outcome.probes);
  text += outputs_text(result.outputs);
  if (!result.events.empty())
    text += fmt::format("  overrides, holds and inputs during the run: {}\n", result.events.size());
  if (result.lockstep_cycles) {
    text += fmt::format("  lockstep: {} cycles, {} comparisons, {} mismatches\n", *result.lockstep_cycles,
                        result.comparisons, kMismatches);
  } else {
    text += "  engine: golden model alone (no lockstep)\n";
  }
  text += fmt::format("  simulated {} cycles in {:.1f} s, {:.2f} M cycles/s\n", result.cycles, result.wall_seconds,
                      static_cast<double>(result.cycles) / result.wall_seconds * 1e-6);
  return text + accepted_words(result.plan.accepted);
}

namespace {

nlohmann::ordered_json place_json(const run::DeviationMeter::Place& place, std::size_t axes) {
  if (place.line == 0) return nullptr;
  const std::vector<std::int64_t> position(place.position.begin(),
                                           place.position.begin() + static_cast<std::ptrdiff_t>(axes));
  return {{"line", place.line}, {"position", position}};
}

nlohmann::ordered_json run_json(const RunResult& result, const run::PlannedProfile& profile) {
  nlohmann::ordered_json json;
  json["program"] = result.plan.file;
  json["engine"] = result.engine == sim::EngineKind::kRtl ? "rtl" : "model";
  json["axes"] = result.end.axes;
  json["final_position"] = result.end.pulses;
  json["steps"] = result.steps;
  json["cycles"] = result.cycles;
  json["seconds"] = static_cast<double>(result.cycles) / result.clock_hz;
  json["clock_hz"] = result.clock_hz;
  json["lockstep_cycles"] = nullptr;
  if (result.lockstep_cycles) json["lockstep_cycles"] = *result.lockstep_cycles;
  json["comparisons"] = result.comparisons;
  json["mismatches"] = kMismatches;
  json["path_steps"] = {{"count", result.path_steps}, {"identity", result.path_identity}};
  json["shaper_delay"] = {{"least", result.shaper_delay.least}, {"most", result.shaper_delay.most}};
  json["max_deviation"] = {{"line", result.largest_line_deviation}, {"arc", result.largest_arc_deviation}};
  json["segments"] = result.plan.segments;
  json["commands"] = result.outcome.commands;
  json["planned_seconds"] = result.plan.seconds;
  json["profile"] = profile_name(profile);
  json["motion"] = motion_json(result.plan.motion);
  json["blends"] = blends_json(result.plan.blends);
  json["under_runs"] = nullptr;
  if (result.outcome.under_runs) json["under_runs"] = *result.outcome.under_runs;
  json["feed"] = {{"commanded", nullptr}, {"achieved", nullptr}};
  if (result.commanded_feed) json["feed"]["commanded"] = *result.commanded_feed;
  if (result.achieved_feed) json["feed"]["achieved"] = *result.achieved_feed;
  json["feeds_not_reached"] = feeds_json(result.plan.feeds_not_reached);
  json["events"] = events_json(result.events);
  json["outputs"] = outputs_json(result.outputs);
  json["inputs"] = nullptr;
  if (result.inputs) json["inputs"] = *result.inputs;
  json["probes"] = probes_json(result.end.axes, result.outcome.probes);
  json["accepted_words"] = result.plan.accepted;
  return json;
}

}  // namespace

std::string json_text(const RunResult& result, const run::PlannedProfile& profile,
                      const nlohmann::ordered_json& world) {
  nlohmann::ordered_json json = run_json(result, profile);
  if (!world.is_null()) json["world"] = world;
  return json.dump(2) + "\n";
}

std::string report_json(const RunResult& result, const run::PlannedProfile& profile,
                        const nlohmann::ordered_json& surroundings) {
  nlohmann::ordered_json json = run_json(result, profile);
  json["deviation_places"] = {{"line", place_json(result.line_place, result.end.axes.size())},
                              {"arc", place_json(result.arc_place, result.end.axes.size())}};
  json.update(surroundings);
  // A name may contain any bytes.
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace trammel::app
