#include "card_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "common/card_choice.hpp"
#include "common/errors.hpp"
#include "common/progress_bar.hpp"
#include "common/stop_at_signals.hpp"
#include "common/terminal.hpp"
#include "end_text.hpp"
#include "profile_report.hpp"
#include "run_report.hpp"
#include "trammel/card_map.hpp"

namespace trammel::app {
namespace {

// Shows how far the run is, and lets it go on after a connection that was lost and made anew.
class CardWatch final : public run::Observer {
 public:
  CardWatch(driver::Card& card, const transport::Connection& connection, const run::Plan& plan, bool progress)
      : card_(card), connection_(connection), plan_(plan), bar_(progress) {}
  void sent() override { progress({}); }
  void progress(const run::Progress& /*progress*/) override {
    if (connection_.reconnections() != reconnections_) {
      reconnections_ = connection_.reconnections();
      tell("note", "the connection was lost and is there again; the motion goes on");
      card_.request_hold(false);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    bar_.show(plan_.seconds > 0 ? std::min(1.0, seconds / plan_.seconds) : 0.0,
              fmt::format("{:.1f} s, planned {:.1f} s", seconds, plan_.seconds));
  }

 private:
  driver::Card& card_;
  const transport::Connection& connection_;
  const run::Plan& plan_;
  ProgressBar bar_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::uint64_t reconnections_ = 0;
};

void set_overrides(driver::Card& card, const CardRunOptions& options) {
  card.set_override(driver::PieceClass::kFeed, options.percent, options.max_percent);
  if (!card_map::has_engine(card.identification().engines, card_map::engine::kClasses)) return;
  card.set_override(driver::PieceClass::kRapid, options.rapid_percent, options.max_percent);
  card.set_override(driver::PieceClass::kFixed, 100, options.max_percent);
}

// The program begins where the machine stands.
run::RunSettings settings_at(const machine::Machine& machine, const driver::Snapshot& found,
                             run::RunSettings settings) {
  settings.start = run::standing_at(machine, found);
  settings.start_is_known = true;
  if (settings.start != gcode::Coordinates{}) {
    tell("note", fmt::format("the machine stands at {}, counted from its place at the card's reset",
                             run::place_text(settings.start, machine)));
  }
  return settings;
}

// The card stops by itself where this program dies or is stopped.
run::Outcome run_watched(run::Runner& runner, driver::Card& card, const machine::Machine& machine, bool stream) {
  const MotionWatchdog watchdog(card, machine.motion);
  try {
    return run_until_signal(runner, card, machine, stream);
  } catch (const run::RunError&) {
    tell_of_fault(card);
    throw;
  }
}

std::string link_text(const CardRunResult& result) {
  if (result.link.requests == 0) return {};
  return fmt::format("  link: {} requests, {} sent again, {} connections made anew\n", result.link.requests,
                     result.link.sent_again, result.reconnections);
}

}  // namespace

CardRunResult run_on_card(const run::ProgramLines& lines, const machine::Machine& machine, driver::Card& card,
                          transport::Connection& connection, const CardRunOptions& options) {
  const driver::Identification& id = card.identification();
  if (machine.motors() > id.axes) {
    throw UsageError(fmt::format("--card: it has {} axes, the machine {} motors", id.axes, machine.motors()));
  }
  CardRunResult result;
  const driver::Snapshot found = card.read_snapshot();
  run::Runner runner(lines, machine, planner::limits_of(id), settings_at(machine, found, options.settings));
  const run::Plan plan = options.stream ? run::Plan{} : runner.plan();
  if (options.planned) options.planned(plan);

  take_over(card, options.clear_faults);
  set_overrides(card, options);
  const driver::Snapshot before = card.read_snapshot();
  if (before.position != found.position) {
    throw UsageError("--card: it has moved while the program was planned: run the program again");
  }
  CardWatch watch(card, connection, plan, options.progress);
  runner.add(watch);
  result.outcome = run_watched(runner, card, machine, options.stream);
  result.plan = runner.last_plan();
  result.clock_hz = id.clock_hz;
  result.seconds = static_cast<double>(card.read_snapshot().time - before.time) / id.clock_hz;
  result.end = run::end_position(machine, result.outcome.final_position);
  result.profile = run::planned_profile(machine, options.settings);
  if (connection.frames() != nullptr) result.link = connection.frames()->counts();
  result.reconnections = connection.reconnections();
  return result;
}

std::string summary(const CardRunResult& result) {
  std::string text =
      fmt::format("{}: {} path segments, {} commands, {:.3f} s of card time at {:g} MHz on {}\n", result.plan.file,
                  result.plan.segments, result.outcome.commands, result.seconds, result.clock_hz * 1e-6, result.card);
  text += end_text(result.end);
  text += profile_text(result.profile);
  if (result.outcome.under_runs) text += fmt::format("  under-runs since reset: {}\n", *result.outcome.under_runs);
  text += probes_text(result.end.axes, result.outcome.probes);
  text += link_text(result) + blends_text(result.plan.blends);
  return text + accepted_words(result.plan.accepted);
}

std::string json_text(const CardRunResult& result) {
  nlohmann::ordered_json json;
  json["program"] = result.plan.file;
  json["card"] = result.card;
  json["axes"] = result.end.axes;
  json["final_position"] = result.end.pulses;
  json["seconds"] = result.seconds;
  json["clock_hz"] = result.clock_hz;
  json["segments"] = result.plan.segments;
  json["commands"] = result.outcome.commands;
  json["planned_seconds"] = result.plan.seconds;
  json["profile"] = profile_name(result.profile);
  json["motion"] = motion_json(result.plan.motion);
  json["blends"] = blends_json(result.plan.blends);
  json["under_runs"] = nullptr;
  if (result.outcome.under_runs) json["under_runs"] = *result.outcome.under_runs;
  json["feeds_not_reached"] = feeds_json(result.plan.feeds_not_reached);
  json["probes"] = probes_json(result.end.axes, result.outcome.probes);
  json["link"] = {{"requests", result.link.requests},
                  {"sent_again", result.link.sent_again},
                  {"reconnections", result.reconnections}};
  json["accepted_words"] = result.plan.accepted;
  return json.dump(2) + "\n";
}

}  // namespace trammel::app
