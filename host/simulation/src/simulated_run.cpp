#include "trammel/simulation/simulated_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "judges.hpp"
#include "operator_timeline.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/step_recorder.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::simulation {
namespace {

std::vector<OutputResult> outputs_of(const machine::MachineOutputs& named, const run::OutputRecorder& recorder) {
  std::vector<OutputResult> result;
  for (unsigned n = 0; n < machine::kMaxOutputs; ++n) {
    OutputResult output{n, {}, recorder.outputs()[n]};
    const auto word = [&](std::string name, std::uint16_t outputs) {
      if ((outputs >> n & 1) != 0) output.words.push_back(std::move(name));
    };
    word("M3", named.m3);
    word("M4", named.m4);
    word("M7", named.m7);
    word("M8", named.m8);
    word("S", named.pwm);
    for (std::size_t p = 0; p < named.numbered.size(); ++p) word(fmt::format("M62 P{}", p), named.numbered[p]);
    if (!output.words.empty()) result.push_back(output);
  }
  return result;
}

bool scripts_inputs(const Operation& operation) {
  return std::any_of(operation.events.begin(), operation.events.end(),
                     [](const OperatorEvent& event) { return event.kind == OperatorEvent::Kind::kInput; });
}

run::StepRecorder::Options recording_of(const RunOptions& options, double clock_hz) {
  run::StepRecorder::Options recording;
  recording.steps = options.steps;
  recording.path_steps = options.path_steps;
  recording.plot = options.plot;
  recording.clock_hz = clock_hz;
  return recording;
}

void tell(sim::Engine& engine, RunResult& result) {
  result.cycles = engine.cycles();
  result.lockstep_cycles = engine.lockstep_cycles();
  result.comparisons = engine.comparisons();
}

void tell(run::StepRecorder& recorder, RunResult& result) {
  result.steps = recorder.steps();
  result.largest_line_deviation = recorder.deviation().largest_line();
  result.largest_arc_deviation = recorder.deviation().largest_arc();
  result.line_place = recorder.deviation().line_place();
  result.arc_place = recorder.deviation().arc_place();
}

}  // namespace

// Each member listens or writes to members above it.
struct SimulatedRun::Instruments {
  Instruments(const sim::SimulationOptions& engine_options, const RunOptions& options, const machine::Machine& machine)
      : kind(engine_options.kind),
        recorder(recording_of(options, engine_options.clock_hz), kinematics::Kinematics(machine)),
        engine(options.surroundings ? options.surroundings(sim::make_engine(engine_options))
                                    : sim::make_engine(engine_options)),
        judges(recorder, options.outputs, engine_options.clock_hz),
        bus(*engine, engine_options.clock_hz, options.operation.bytes_per_second),
        timeline(options.operation, options.max_percent) {
    engine->set_sink(&judges.fork);
    timeline.schedule(bus, engine_options.clock_hz);
  }

  sim::EngineKind kind;
  run::StepRecorder recorder;
  std::unique_ptr<sim::Engine> engine;
  Judges judges;
  std::unique_ptr<report::ReportWriter> report;
  sim::TimedBus bus;
  OperatorTimeline timeline;
  std::optional<driver::Card> card;
};

SimulatedRun::SimulatedRun(run::ProgramLines lines, const machine::Machine& machine, const planner::CardLimits& card,
                           const RunOptions& options)
    : lines_(std::move(lines)),
      machine_(machine),
      options_(options),
      runner_(lines_, machine, card, options.settings),
      course_(machine) {
  if (options_.plot) runner_.add(course_);
}

SimulatedRun::~SimulatedRun() = default;

void SimulatedRun::make_card(const sim::SimulationOptions& engine) {
  instruments_ = std::make_unique<Instruments>(engine, options_, machine_);
  Instruments& made = *instruments_;
  if (course_.detail_command()) made.recorder.detail_of(*course_.detail_command());
  if (options_.report != nullptr) {
    made.report = std::make_unique<report::ReportWriter>(
        *options_.report, machine_, report::ReportSettings{engine.clock_hz, options_.report_window});
    made.report->program(*lines_());
    made.judges.fork.add(*made.report);
    runner_.add(*made.report);
  }
  made.card.emplace(driver::Card::open(made.bus));
  runner_.add(made.recorder);
  runner_.add(made.judges.feed);
}

driver::Card& SimulatedRun::card() { return *instruments_->card; }
std::uint64_t SimulatedRun::cycles() const { return instruments_->engine->cycles(); }
report::ReportWriter* SimulatedRun::report() { return instruments_->report.get(); }

RunResult SimulatedRun::result(const run::Outcome& outcome) {
  Instruments& made = *instruments_;
  made.recorder.finish();
  made.recorder.check(outcome.counted);
  return gather(outcome);
}

RunResult SimulatedRun::stopped_result(std::uint64_t commands) {
  Instruments& made = *instruments_;
  made.recorder.finish();
  run::Outcome outcome;
  outcome.commands = commands;
  outcome.counted = made.recorder.position();
  for (std::size_t joint = 0; joint < outcome.counted.size(); ++joint) {
    outcome.final_position.push_back(runner_.last_plan().start[joint] + outcome.counted[joint]);
  }
  RunResult result = gather(outcome);
  // These means count all that was sent, which is more than what was executed.
  result.commanded_feed.reset();
  result.achieved_feed.reset();
  return result;
}

RunResult SimulatedRun::gather(const run::Outcome& outcome) {
  Instruments& made = *instruments_;
  RunResult result;
  made.judges.tell(result);
  tell(made.recorder, result);
  result.events = made.timeline.made();
  result.outputs = outputs_of(machine_.outputs, made.judges.outputs);
  if (scripts_inputs(options_.operation)) result.inputs = made.card->read_inputs();
  result.plan = runner_.last_plan();
  result.outcome = outcome;
  result.end = run::end_position(machine_, outcome.final_position);
  result.engine = made.kind;
  tell(*made.engine, result);
  result.clock_hz = made.card->identification().clock_hz;
  if (options_.plot) {
    result.plot = {result.plan.file,        "mm",
                   course_.points(),        made.recorder.executed(),
                   made.recorder.thinned(), course_.detail(),
                   made.recorder.detail(),  made.recorder.speed()};
  }
  made.card.reset();
  made.engine.reset();
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  return result;
}

}  // namespace trammel::simulation
