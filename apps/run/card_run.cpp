#include "card_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "common/card_choice.hpp"
#include "common/errors.hpp"
#include "common/progress_bar.hpp"
#include "common/start_note.hpp"
#include "common/stop_at_signals.hpp"
#include "common/stop_text.hpp"
#include "common/terminal.hpp"
#include "end_text.hpp"
#include "go_there.hpp"
#include "profile_report.hpp"
#include "run_report.hpp"
#include "trammel/card_map.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"

namespace trammel::app {
namespace {

// Shows the progress of a run, and continues it after a connection was lost and restored.
class CardWatch final : public run::Observer {
 public:
  CardWatch(driver::Card& card, const transport::Connection& connection, const run::Runner& runner,
            const run::Plan& plan, bool progress)
      : card_(card), connection_(connection), runner_(runner), plan_(plan), bar_(progress) {}
  void sent() override { progress({}); }
  void progress(const run::Progress& /*progress*/) override {
    if (connection_.reconnections() != reconnections_) {
      reconnections_ = connection_.reconnections();
      tell("note", "the connection was lost and made again; the motion continues");
      // The run's own hold is not the server's: the run ends it, with its first piece that moves, on a ramp.
      if (!runner_.begins()) card_.request_hold(false);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    bar_.show(plan_.seconds > 0 ? std::min(1.0, seconds / plan_.seconds) : 0.0,
              fmt::format("{:.1f} s, planned {:.1f} s", seconds, plan_.seconds));
  }

 private:
  driver::Card& card_;
  const transport::Connection& connection_;
  const run::Runner& runner_;
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

// Present position in pulses relative to machine zero, by axis of the card.
planner::Pulses standing_pulses(const machine::Machine& machine, const run::CardPlace& place) {
  planner::Pulses pulses{};
  if (!place.was_set()) return pulses;
  for (std::size_t n = 0; n < machine.motors(); ++n) {
    pulses[n] = driver::pulses_between(place.zero[n], place.now.position[n]);
  }
  return pulses;
}

// Start of the program's first line.
gcode::Coordinates start_of(const machine::Machine& machine, const ResumeRecord& record) {
  planner::Pulses pulses{};
  std::copy_n(record.start.begin(), std::min(record.start.size(), pulses.size()), pulses.begin());
  return kinematics::Kinematics(machine).coordinates(pulses);
}

ResumeRecord interrupted_run(driver::Card& card, const CardRunOptions& options) {
  const std::optional<ResumeRecord> record = options.card.resume().read();
  if (!record)
    throw UsageError(
        "--resume: no record of a run on this card was found. If that run had a --resume-file, or another user started "
        "it, name its file with --resume-file");
  if (record->state == ResumeRecord::State::kDone)
    throw UsageError("--resume: the last run on this card reached its end, so there is nothing to resume");
  if (record->plan.empty()) throw UsageError("--resume: the last run used --stream, so it cannot be resumed");
  const std::string differs = difference(record->key, options.key);
  if (!differs.empty()) throw UsageError("--resume: not the run that was interrupted: " + differs);
  check_zeros(card, *record);
  return *record;
}

// The run to be continued, with the place of its stop.
ResumeRecord resumed_run(driver::Card& card, const machine::Machine& machine, const run::CardPlace& found,
                         const CardRunOptions& options) {
  interrupted_run(card, options);
  if (!found.was_set()) throw UsageError("--resume: the card was reset since the interrupted run");
  take_over(card, options.card, machine, true);
  const ResumeRecord record = interrupted_run(card, options);
  if (record.state != ResumeRecord::State::kStopped)
    throw UsageError("--resume: the place on the path where the run stopped is not known");
  return record;
}

void check_plan(const ResumeRecord& record, const run::Plan& plan) {
  if (record.plan == plan.identity) return;
  throw UsageError(
      "--resume: not the run that was interrupted: this planner, or this card, makes other commands from the program");
}

// Sets the start of a run in the middle of the program; the program's first line begins at the same point as before.
void begin_amid(const run::Start& start, const std::optional<ResumeRecord>& before, bool resume,
                run::RunSettings& settings) {
  if (before) settings.start = start_of(start.machine, *before);
  if (!resume) return;
  settings.first_line = 1;
  settings.place = before->place;
}

// For --from-line: the last run of the same program, which has the start of the program.
std::optional<ResumeRecord> run_before(driver::Card& card, const CardRunOptions& options) {
  if (options.settings.first_line == 1) return std::nullopt;
  try {
    const std::optional<ResumeRecord> record = options.card.resume().read();
    if (!record || record->plan.empty() || !difference(record->key, options.key).empty()) return std::nullopt;
    check_zeros(card, *record);
    return record;
  } catch (const UsageError&) {
    return std::nullopt;
  }
}

void tell_of_begin(const run::Plan& plan, const machine::Machine& machine) {
  std::string text = fmt::format("the run begins at line {}", plan.begin_line);
  if (plan.ticks_done != 0) text += fmt::format(", {} ticks into a path", plan.ticks_done);
  text += ", at " + run::place_text(kinematics::Kinematics(machine).coordinates(plan.start), machine);
  std::string on;
  for (unsigned n = 0; n < machine::kMaxOutputs; ++n) {
    if ((plan.restored.set >> n & 1) != 0) on += fmt::format(" {}", n);
  }
  if (!on.empty()) text += "; before it moves it switches on output" + on;
  tell("note", text);
}

ResumeRecord record_of(driver::Card& card, const CardRunOptions& options, const run::Plan& plan,
                       const machine::Machine& machine, const run::RunSettings& settings) {
  ResumeRecord record;
  record.key = options.key;
  record.plan = plan.identity;
  const planner::Pulses pulses = kinematics::Kinematics(machine).pulses(settings.start);
  record.start.assign(pulses.begin(), pulses.end());
  for (unsigned n = 0; n < card.identification().axes; ++n) record.zero.push_back(card.read_machine_zero(n));
  record.begin = run::begin_of(settings, plan);
  card.abort();  // resets the counts of begun commands
  record.time = card.read_snapshot().time;
  return record;
}

// The run's record: during the run its file states that the card has the place; afterwards it states the result.
class Record {
 public:
  Record(driver::Card& card, const CardRunOptions& options, const ResumeRecord& record)
      : card_(card), file_(options.card.resume()), record_(record) {
    file_.write(record_);
  }
  // The run is complete, so a file that cannot be written is only a note.
  void ended() {
    record_.state = ResumeRecord::State::kDone;
    try {
      file_.write(record_);
    } catch (const UsageError& error) {
      tell("note", error.what());
    }
  }
  void interrupted() noexcept {
    if (record_.plan.empty() || !keep_place_of_stop(card_, file_)) return;
    tell("note", place() + "`trammel run` with the same arguments and --resume continues the run");
  }

 private:
  // The place on the path; empty if a fault's message has reported it or the card does not answer.
  std::string place() const noexcept {
    try {
      const StoppedCard stopped = read_stopped(card_);
      if (!stopped.rest || stopped.faults() != 0) return {};
      return fmt::format("the run was stopped {}; ", path_text(*stopped.rest, stopped.clock_hz));
    } catch (const std::exception&) {
      return {};
    }
  }

  driver::Card& card_;
  ResumeFile file_;
  ResumeRecord record_;
};

// Runs with the watchdog: the card stops by itself if this program dies or is stopped.
run::Outcome run_watched(run::Runner& runner, driver::Card& card, transport::Connection& connection,
                         const machine::Machine& machine, const CardRunOptions& options, Record& record) {
  const MotionWatchdog watchdog(card, machine.motion);
  try {
    return run_until_signal(runner, card, machine, options.stream);
  } catch (const run::RunError&) {
    tell_of_stop(card, connection, machine);
    record.interrupted();
    throw;
  } catch (const EndedBySignal&) {
    record.interrupted();
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
  match_axes(card, machine);
  limit_patience(connection, machine.motion);
  CardRunResult result;
  run::CardPlace found = run::read_card_place(card);
  const bool trust = options.card.trust_position;
  const run::Start start = run::start_at(machine, found, trust);
  std::optional<ResumeRecord> before = run_before(card, options);
  if (options.resume) before = resumed_run(card, machine, found, options);
  tell_of_start(start, found);
  run::RunSettings settings = options.settings;
  settings.start = start.at;
  begin_amid(start, before, options.resume, settings);
  run::Runner runner(lines, start.machine, planner::limits_of(id), settings);
  const run::Plan plan = options.stream ? run::Plan{} : runner.plan();
  if (options.resume) check_plan(*before, plan);
  const bool amid = options.resume || (settings.first_line > 1 && !options.stream);
  if (amid) tell_of_begin(plan, start.machine);
  if (options.planned) options.planned(plan);

  take_over(card, options.card, machine, options.resume);
  const driver::Snapshot now = card.read_snapshot();
  if (now.position != found.now.position) {
    throw UsageError("--card: the card moved while the program was planned. Run the program again");
  }
  run::keep_place(card, found, run::scales_of(machine), run::motors_of(machine));
  run::set_keeps_place(card, machine);
  run::guard_soft_limits(card, start.machine, run::read_card_place(card));
  set_overrides(card, options);
  planner::Pulses standing = standing_pulses(machine, found);
  if (amid) {
    go_there(card, start.machine, standing, plan.start, options.yes);
    found = run::read_card_place(card);
    standing = standing_pulses(machine, found);
  }
  runner.stands_at(standing);
  Record record(card, options, record_of(card, options, plan, machine, settings));
  const driver::Snapshot begin = card.read_snapshot();
  CardWatch watch(card, connection, runner, plan, options.progress);
  runner.add(watch);
  result.outcome = run_watched(runner, card, connection, machine, options, record);
  record.ended();
  result.plan = runner.last_plan();
  result.clock_hz = id.clock_hz;
  result.seconds = static_cast<double>(card.read_snapshot().time - begin.time) / id.clock_hz;
  result.end = run::end_position(machine, result.outcome.final_position);
  result.profile = run::planned_profile(machine, options.settings);
  if (connection.frames() != nullptr) result.link = connection.frames()->counts();
  result.reconnections = connection.reconnections();
  return result;
}

std::string summary(const CardRunResult& result) {
  std::string text =
      fmt::format("{}: {}, {}, {:.3f} s of card time at {:g} MHz on {}\n", result.plan.file,
                  counted(result.plan.segments, "path segment"), counted(result.outcome.commands, "command"),
                  result.seconds, result.clock_hz * 1e-6, result.card);
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
