#include "trammel/run/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "line_ring.hpp"
#include "pipeline.hpp"
#include "plan_gatherer.hpp"
#include "plan_identity.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/end_position.hpp"

namespace trammel::run {
namespace {

// Commands around the motion of a probe: PROBE and PROBE_END.
constexpr std::uint64_t kProbeCommands = 2;

// The first pass needs only the number of commands.
class NoSink final : public driver::CommandSink {
 public:
  void put(const driver::Command& /*command*/) override {}
};

// When this function returns, the card's ratio is 0.
void hold_at_once(driver::Card& card) {
  namespace reg = card_map::reg;
  constexpr int kLooks = 1000;
  std::array<driver::Access, 1> slew{driver::write_of(reg::kSlew, card.parts().registers.read(reg::kSlew))};
  card.set_slew_time(std::chrono::nanoseconds(0));
  card.set_hold(true);
  int looks = 0;
  while (!card.read_status().held && looks < kLooks) ++looks;
  card.parts().registers.transfer(slew.data(), slew.size(), "slew");
  if (looks == kLooks) throw driver::StateError("the card's hold has no effect: the run cannot begin with a ramp");
}

// Streams the plan and adds the current program line to errors of the card.
class ProgramStream final : private driver::CommandSink {
 public:
  ProgramStream(Pipeline& pipeline, driver::Card& card, const std::vector<Observer*>& observers,
                const machine::Machine& machine, bool single_block, bool& begins)
      : pipeline_(pipeline),
        observers_(observers),
        machine_(machine),
        single_block_(single_block),
        card_(card),
        before_(card.read_snapshot()),
        // A command has at least two halfwords: half of these slots are for the queue, half for commands held back by
        // the stream.
        lines_(card.identification().geometry_depth),
        held_until_(pipeline.ticks_done() != 0 ? 2 : 1),
        begins_(begins),
        stream_(card, options()) {
    begins_ = pipeline.replays();
  }
  ~ProgramStream() override { begins_ = false; }

  // Returns the end position of the program, pulses.
  planner::Pulses run() {
    planner::Pulses end = pipeline_.start();
    try {
      run_section(end);
      for (; pipeline_.at_probe(); run_section(end)) probe();
      stream_.finish();
    } catch (const driver::StoppedError& error) {
      lines_.begun(error.geometry_begun());
      throw StoppedOnPath(pipeline_.file(), lines_.current(), error.what(), machine_position(card_.read_snapshot()));
    } catch (const driver::Error& error) {
      look_at_begun(dynamic_cast<const driver::FaultError*>(&error) != nullptr);
      throw RunError(pipeline_.file(), lines_.current(), error.what());
    }
    return end;
  }

  std::uint64_t sent() const { return stream_.sent(); }
  const std::vector<ProbeMade>& probes() const { return probes_; }
  const driver::Snapshot& before() const { return before_; }

 private:
  // Streams up to the end or to the next probe. With slow program lines the stream never waits for room, so this loop
  // serves the requests of others.
  void run_section(planner::Pulses& end) {
    while (next()) {
      stream_.flush();
      driver::serve_requests(card_);
      for (Observer* observer : observers_) observer->sent();
      end = planned_.block.end;
      first_of_block_ = true;
    }
  }
  // Waits until all earlier commands are done. Collects the commands of the probe and sends them when they are
  // complete.
  void probe() {
    const gcode::Motion motion = pipeline_.begin_probe();
    const bool level = machine_.probe.touched_level != motion.probe_away;
    const driver::ProbeCommand condition{static_cast<std::uint8_t>(machine_.probe.input.value_or(0)), level};
    std::vector<driver::Command> paths;
    probe_paths_ = &paths;
    planned_.block.line = motion.line;
    announce(condition);
    while (next()) {
      for (Observer* observer : observers_) observer->sent();
      first_of_block_ = true;
    }
    announce(driver::ProbeEndCommand{});
    probe_paths_ = nullptr;
    if (paths.empty()) throw RunError(pipeline_.file(), motion.line, "a probe that moves by less than a pulse");
    end_probe(motion, stream_.probe(condition, paths));
  }
  void end_probe(const gcode::Motion& motion, const driver::ProbeResult& result) {
    using driver::ProbeOutcome;
    if (motion.probe_must_trip && result.outcome != ProbeOutcome::kTripped) {
      const bool missed = result.outcome == ProbeOutcome::kMissed;
      const char* const what =
          missed ? (motion.probe_away ? "the probe is not free at the end of its way"
                                      : "the probe has met nothing on its way")
                 : (motion.probe_away ? "the probe is free before it moves" : "the probe touches before it moves");
      throw RunError(pipeline_.file(), motion.line, what);
    }
    const bool tripped = result.outcome != ProbeOutcome::kMissed;
    const planner::Pulses rest = machine_position(result.rest);
    const planner::Pulses edge = result.outcome == ProbeOutcome::kTripped ? machine_position(result.edge) : rest;
    probes_.push_back({motion.line, tripped, pipeline_.millimetres(edge)});
    pipeline_.end_probe(edge, rest, tripped);
  }
  planner::Pulses machine_position(const driver::Snapshot& at) const {
    planner::Pulses position = pipeline_.start();
    for (std::size_t joint = 0; joint < pipeline_.kinematics().joints(); ++joint) {
      position[joint] += driver::pulses_between(before_.position[joint], at.position[joint]);
    }
    return position;
  }
  // On an error of the program, runs the commands before it to their end, which is a stop.
  bool next() {
    try {
      return pipeline_.next(*this, planned_);
    } catch (const ProgramError& error) {
      stream_.finish();
      throw RunError(error);
    }
  }
  void put(const driver::Command& command) override {
    if (first_of_block_) {
      if (single_block_ && commands_ != 0 && planned_.block.line != line_) stream_.finish();
      if (awaits_spindle_) await_spindle();
      awaits_spindle_ = planned_.block.awaits_spindle;
      line_ = planned_.block.line;
      for (Observer* observer : observers_) observer->sending(planned_);
      first_of_block_ = false;
    }
    send(command);
  }
  // Waits until all earlier commands are done. A fault during the wait is reported by the next send.
  void await_spindle() {
    constexpr std::chrono::milliseconds kLook{5};
    stream_.finish();
    const std::uint32_t inputs = machine_.spindle_at_speed();
    const std::chrono::duration<double> longest(machine_.outputs.at_speed_s);
    for (std::chrono::nanoseconds waited{0}; (card_.read_inputs() & inputs) == 0; waited += kLook) {
      if (card_.read_status().faulted) return;
      if (waited >= longest) {
        throw RunError(pipeline_.file(), line_,
                       fmt::format("the spindle is not at speed after {:g} s: no input of [inputs] spindle_at_speed is "
                                   "active; spindle.at_speed_s of the machine file is the longest wait",
                                   longest.count()));
      }
      driver::serve_requests(card_);
      card_.bus().sleep(kLook);
    }
  }
  void send(const driver::Command& command) {
    announce(command);
    if (probe_paths_ != nullptr) {
      probe_paths_->push_back(command);
    } else {
      stream_.put(command);
    }
  }
  // Call before the command goes to the stream.
  void announce(const driver::Command& command) {
    for (Observer* observer : observers_) observer->command(commands_, command);
    ++commands_;
    const bool geometry = !std::holds_alternative<driver::FeedCommand>(command);
    if (geometry && driver::counts_as_begun(command)) lines_.put(planned_.block.line);
  }
  driver::StreamOptions options() {
    // 200 polls per second: the queues hold far more than 5 ms of motion, and in a simulation every poll costs bus
    // clocks.
    constexpr std::uint32_t kLooksPerSecond = 200;
    driver::StreamOptions options;
    options.opens_in_hold = true;  // a hold by the operator
    options.poll_clocks = std::max<std::uint64_t>(64, card_.identification().clock_hz / kLooksPerSecond);
    options.progress = [this](const driver::StreamProgress& progress) {
      lines_.begun(progress.geometry_begun);
      release(progress.feed_begun);
      const Progress how_far{progress.geometry_begun, lines_.current(), progress.status};
      for (Observer* observer : observers_) observer->progress(how_far);
    };
    return options;
  }
  // A run that begins in the middle of the program is in a hold until its first piece that moves has begun.
  void release(std::uint32_t feed_begun) {
    if (!begins_ || feed_begun < held_until_) return;
    begins_ = false;
    card_.request_hold(false);
  }
  // After an error, updates the count of commands begun. A fault has reset the card's counters, but their values at the
  // fault were latched. If the link fails too, the last polled value remains.
  void look_at_begun(bool fault) {
    try {
      lines_.begun((fault ? card_.read_stop_snapshot() : card_.read_snapshot()).geometry_begun);
    } catch (const driver::Error&) {
    }
  }

  Pipeline& pipeline_;
  const std::vector<Observer*>& observers_;
  const machine::Machine& machine_;
  bool single_block_;
  std::size_t line_ = 0;  // line of the current block
  driver::Card& card_;
  driver::Snapshot before_;
  std::vector<ProbeMade> probes_;
  std::vector<driver::Command>* probe_paths_ = nullptr;  // set while a probe's commands are collected
  planner::PlannedBlock planned_;
  bool first_of_block_ = true;
  bool awaits_spindle_ = false;  // wait for the spindle before the next block
  std::uint64_t commands_ = 0;   // commands announced
  LineRing lines_;
  std::uint32_t held_until_;  // the hold ends when this many feed pieces and barriers have begun
  bool& begins_;
  driver::Stream stream_;
};

}  // namespace

ProgramError::ProgramError(gcode::Error error) : std::runtime_error(gcode::describe(error)), error_(std::move(error)) {}

RunError::RunError(const ProgramError& error) : std::runtime_error(error.what()), line_(error.error().line) {}

RunError::RunError(const std::string& file, std::size_t line, const std::string& message)
    : std::runtime_error(line == 0 ? fmt::format("{}: before the first command: {}", file, message)
                                   : fmt::format("{}:{}: {}", file, line, message)),
      line_(line) {}

Runner::Runner(ProgramLines lines, const machine::Machine& machine, const planner::CardLimits& card,
               const RunSettings& settings)
    : lines_(std::move(lines)), machine_(machine), card_(card), settings_(settings) {}

const Plan& Runner::plan() {
  RunSettings settings = settings_;
  settings.reader.name_all_unknown = true;
  PlanIdentity identity;
  Pipeline pipeline(lines_, machine_, card_, settings, {}, &identity);
  PlanGatherer gatherer(pipeline);
  NoSink sink;
  std::uint64_t commands = 0;
  planner::PlannedBlock planned;
  const auto plan_section = [&] {
    for (; pipeline.next(sink, planned); commands += planned.commands) {
      for (Observer* observer : observers_) observer->planned(planned, commands);
      gatherer.planned(planned, commands);
    }
  };
  for (plan_section(); pipeline.at_probe(); plan_section()) {
    gatherer.probe();
    pipeline.begin_probe();
    commands += kProbeCommands;
    plan_section();
    pipeline.assume_probe(planned.block.end);
  }
  plan_ = gatherer.plan();
  plan_.identity = identity.text();
  plan_.skipped = pipeline.skipped();
  plan_.ticks_done = pipeline.ticks_done();
  plan_.begin_line = pipeline.begin_line();
  plan_.restored = pipeline.restored();
  return plan_;
}

// Call before any motion. A run that begins in the middle of the program begins from ratio 0.
void Runner::prepare(driver::Card& card, const Pipeline& pipeline) const {
  if (settings_.stands_at && pipeline.start() != *settings_.stands_at) {
    const kinematics::Kinematics& kinematics = pipeline.kinematics();
    throw RunError(pipeline.file(), pipeline.begin_line(),
                   fmt::format("it begins at {}, but the machine stands at {}",
                               place_text(kinematics.coordinates(pipeline.start()), machine_),
                               place_text(kinematics.coordinates(*settings_.stands_at), machine_)));
  }
  configure(card, machine_);
  if (pipeline.replays()) hold_at_once(card);
}

void Runner::require_planned_for(driver::Card& card) const {
  const planner::CardLimits limits = planner::limits_of(card.identification());
  if (limits.clock_hz != card_.clock_hz || limits.axes != card_.axes || limits.accumulator != card_.accumulator ||
      limits.arc_generator != card_.arc_generator || (limits.outputs == 0 && card_.outputs != 0)) {
    throw std::invalid_argument("the program was planned for another card");
  }
}

Outcome Runner::run(driver::Card& card) {
  require_planned_for(card);
  // The callback serves stop and hold requests while a long window is planned.
  Pipeline pipeline(lines_, machine_, card_, settings_, [&card] { driver::serve_requests(card); });
  prepare(card, pipeline);
  ProgramStream stream(pipeline, card, observers_, machine_, settings_.single_block, begins_);
  const planner::Pulses end = stream.run();
  if (plan_.probes == 0 && (stream.sent() != plan_.commands || end != plan_.end)) {
    throw ProgramError({gcode::ErrorCode::kCannotRead, plan_.file, 0, "the program has changed while it was run"});
  }
  Outcome made = outcome(card, stream.before(), end);
  made.commands = stream.sent();
  made.probes = stream.probes();
  made.parameters = pipeline.parameters();
  made.ticks = pipeline.ticks();
  return made;
}

Outcome Runner::stream(driver::Card& card) {
  require_planned_for(card);
  Pipeline pipeline(lines_, machine_, card_, settings_, [&card] { driver::serve_requests(card); });
  prepare(card, pipeline);
  PlanGatherer gatherer(pipeline);
  std::vector<Observer*> observers = observers_;
  observers.push_back(&gatherer);
  ProgramStream stream(pipeline, card, observers, machine_, settings_.single_block, begins_);
  const planner::Pulses end = stream.run();
  plan_ = gatherer.plan();
  plan_.probes = stream.probes().size();
  Outcome made = outcome(card, stream.before(), end);
  made.commands = stream.sent();
  made.probes = stream.probes();
  made.parameters = pipeline.parameters();
  made.ticks = pipeline.ticks();
  return made;
}

// Throws unless the card's counts equal the planned ones.
Outcome Runner::outcome(driver::Card& card, const driver::Snapshot& before, const planner::Pulses& end) const {
  const driver::Snapshot after = card.read_snapshot();
  const kinematics::Kinematics kinematics(machine_);
  Outcome outcome;
  for (std::size_t joint = 0; joint < kinematics.joints(); ++joint) {
    const std::int64_t counted = driver::pulses_between(before.position[joint], after.position[joint]);
    const std::int64_t planned = end[joint] - plan_.start[joint];
    if (counted != planned) {
      throw std::runtime_error(
          fmt::format("axis {}: the card ended at pulse {}, the program at {}", joint, counted, planned));
    }
    outcome.counted.push_back(counted);
    outcome.final_position.push_back(end[joint]);
  }
  outcome.final_coordinates = kinematics.coordinates(end);
  if (card_map::has_engine(card.identification().engines, card_map::engine::kUnderrunHold)) {
    outcome.under_runs = card.parts().registers.read(card_map::reg::kUnderruns);
  }
  return outcome;
}

}  // namespace trammel::run
