#include "run_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <nlohmann/json.hpp>

namespace trammel::app {
namespace {

// Words that the reader takes and that have no effect, by the reason why.
std::string accepted_words(const std::map<std::string, std::size_t>& words) {
  std::string stops;
  std::string blending;
  std::string hardware;
  for (const auto& [word, count] : words) {
    std::string& list = word == "M0" || word == "M1" ? stops : (word == "G64" ? blending : hardware);
    list += fmt::format(" {} ({})", word, count);
  }
  std::string text;
  if (!stops.empty()) text += "  stops for the operator, which a simulation does not make:" + stops + "\n";
  if (!blending.empty()) text += "  no blending yet, every motion ends in an exact stop:" + blending + "\n";
  if (!hardware.empty()) text += "  accepted, without hardware yet:" + hardware + "\n";
  return text;
}

// Without an exponent, and without digits that nobody reads.
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

}  // namespace

std::vector<std::string> feed_warnings(const run::Plan& plan) {
  std::vector<std::string> lines;
  for (const run::FeedNotReached& feed : plan.feeds_not_reached) {
    lines.push_back(fmt::format("{} {} not reach the feed: {}; the furthest off at {}:{}, {} of {} mm/min", feed.count,
                                feed.count == 1 ? "move does" : "moves do", text_of(feed.cause), plan.file, feed.line,
                                number(feed.reached), number(feed.wanted)));
  }
  return lines;
}

std::string summary(const RunResult& result) {
  const double seconds = static_cast<double>(result.cycles) / result.clock_hz;
  std::string text = fmt::format("{}: {} path segments, {} commands, {:.3f} s of card time at {:g} MHz\n",
                                 result.program, result.segments, result.commands, seconds, result.clock_hz * 1e-6);
  for (std::size_t a = 0; a < result.axes.size(); ++a) {
    text += fmt::format("  {}: {} pulses made, ends at pulse {} ({:.4f} mm)\n", result.axes[a], result.steps[a],
                        result.final_position[a], result.final_millimetres[a]);
  }
  text += fmt::format("  largest deviation: lines {:.4f} pulses, arcs {:.4f} pulses\n", result.largest_line_deviation,
                      result.largest_arc_deviation);
  if (result.lockstep_cycles) {
    text += fmt::format("  lockstep: {} cycles, {} comparisons, {} mismatches\n", *result.lockstep_cycles,
                        result.comparisons, result.mismatches);
  } else {
    text += "  engine: golden model alone (no lockstep)\n";
  }
  text += fmt::format("  simulated {} cycles in {:.1f} s, {:.2f} M cycles/s\n", result.cycles, result.wall_seconds,
                      static_cast<double>(result.cycles) / result.wall_seconds * 1e-6);
  return text + accepted_words(result.accepted);
}

nlohmann::ordered_json json_of(const RunResult& result) {
  nlohmann::ordered_json json;
  json["program"] = result.program;
  json["engine"] = result.engine;
  json["axes"] = result.axes;
  json["final_position"] = result.final_position;
  json["steps"] = result.steps;
  json["cycles"] = result.cycles;
  json["seconds"] = static_cast<double>(result.cycles) / result.clock_hz;
  json["clock_hz"] = result.clock_hz;
  json["lockstep_cycles"] = nullptr;
  if (result.lockstep_cycles) json["lockstep_cycles"] = *result.lockstep_cycles;
  json["comparisons"] = result.comparisons;
  json["mismatches"] = result.mismatches;
  json["max_deviation"] = {{"line", result.largest_line_deviation}, {"arc", result.largest_arc_deviation}};
  json["segments"] = result.segments;
  json["commands"] = result.commands;
  json["planned_seconds"] = result.planned_seconds;
  json["accepted_words"] = result.accepted;
  return json;
}

}  // namespace trammel::app
