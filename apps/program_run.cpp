#include "program_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "end_text.hpp"
#include "engine_options.hpp"
#include "errors.hpp"
#include "progress_bar.hpp"
#include "stop_at_signals.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/commanded_course.hpp"
#include "trammel/run/feed_meter.hpp"
#include "trammel/run/step_fork.hpp"
#include "trammel/run/step_recorder.hpp"

namespace trammel::app {
namespace {

// Shows how far the run is.
class Watch final : public run::Observer {
 public:
  Watch(const sim::Engine& engine, const run::Plan& plan, double clock_hz, bool progress)
      : engine_(engine), plan_(plan), clock_hz_(clock_hz), bar_(progress) {}
  void sent() override { progress({}); }
  void progress(const run::Progress& /*progress*/) override {
    const double seconds = static_cast<double>(engine_.cycles()) / clock_hz_;
    bar_.show(plan_.seconds > 0 ? seconds / plan_.seconds : 1.0,
              fmt::format("{:.1f} of {:.1f} s of card time", seconds, plan_.seconds));
  }

 private:
  const sim::Engine& engine_;
  const run::Plan& plan_;
  double clock_hz_;
  ProgressBar bar_;
};

// Everything beside the recorder that listens to the steps.
struct Judges {
  Judges(run::StepRecorder& recorder, run::TextSink* output_list, double clock_hz)
      : feed(clock_hz), outputs(output_list) {
    fork.add(recorder);
    fork.add(path);
    fork.add(shapers);
    fork.add(feed);
    fork.add(outputs);
  }
  void tell(RunResult& result) {
    shapers.finish();
    outputs.finish();
    result.path_steps = path.count();
    result.path_identity = path.text();
    if (shapers.range()) result.shaper_delay = *shapers.range();
    result.commanded_feed = feed.commanded();
    result.achieved_feed = feed.achieved();
  }

  run::StepFork fork;
  run::PathIdentity path;
  run::ShaperDelay shapers;
  run::FeedMeter feed;
  run::OutputRecorder outputs;
};

std::vector<OutputResult> outputs_of(const machine::MachineOutputs& named, const run::OutputRecorder& recorder) {
  std::vector<OutputResult> result;
  for (unsigned n = 0; n < machine::kMostOutputs; ++n) {
    OutputResult output{n, {}, recorder.outputs()[n]};
    const auto word = [&](const char* name, std::uint16_t outputs) {
      if ((outputs >> n & 1) != 0) output.words.emplace_back(name);
    };
    word("M3", named.m3);
    word("M4", named.m4);
    word("M7", named.m7);
    word("M8", named.m8);
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

void tell(const run::Plan& plan, RunResult& result) {
  result.program = plan.file;
  result.segments = plan.segments;
  result.planned_seconds = plan.seconds;
  result.motion = plan.motion;
  result.blends = plan.blends;
  result.accepted = plan.accepted;
  result.feeds_not_reached = plan.feeds_not_reached;
}

void tell(const run::Outcome& outcome, const machine::Machine& machine, RunResult& result) {
  result.final_position = outcome.final_position;
  result.final_millimetres = end_millimetres(machine, result.final_position);
  result.joint_for_each_axis = kinematics::Kinematics(machine).joint_for_each_axis();
  result.commands = outcome.commands;
  result.under_runs = outcome.under_runs;
  result.probes = outcome.probes;
  result.parameters = outcome.parameters;
}

void tell(const sim::Engine& engine, RunResult& result) {
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

std::unique_ptr<report::ReportWriter> report_of(const run::ProgramLines& lines, const machine::Machine& machine,
                                                std::uint32_t clock_hz, const RunOptions& options) {
  auto writer = std::make_unique<report::ReportWriter>(*options.report, machine,
                                                       report::ReportSettings{clock_hz, options.report_window});
  writer->program(*lines());
  return writer;
}

}  // namespace

RunResult run_program(const run::ProgramLines& lines, const machine::Machine& machine,
                      const sim::SimulationOptions& engine_options, const RunOptions& options,
                      std::unique_ptr<report::ReportWriter>* report) {
  const auto begun = std::chrono::steady_clock::now();
  if (options.report != nullptr && !kinematics::Kinematics(machine).joint_for_each_axis()) {
    throw UsageError("--report: its page shows machines with a motor for each axis; leave it out for corexy");
  }
  RunResult result;
  for (const machine::MachineAxis& axis : machine.axes) result.axes += axis.letter;
  run::Runner runner(lines, machine, limits_of(engine_options), options.settings);
  run::CommandedCourse course(machine);
  if (options.plot) runner.add(course);
  const run::Plan plan = options.stream ? run::Plan{} : runner.plan();

  if (options.planned) options.planned(plan);

  run::StepRecorder recorder(recording_of(options, engine_options.clock_hz), kinematics::Kinematics(machine));
  if (course.detail_command()) recorder.detail_of(*course.detail_command());

  const std::unique_ptr<sim::Engine> engine = sim::make_engine(engine_options);
  Judges judges(recorder, options.outputs, engine_options.clock_hz);
  if (report != nullptr && options.report != nullptr) {
    *report = report_of(lines, machine, engine_options.clock_hz, options);
    judges.fork.add(**report);
    runner.add(**report);
  }
  engine->set_sink(&judges.fork);
  sim::TimedBus bus(*engine, engine_options.clock_hz, options.operation.bytes_per_second);
  OperatorTimeline timeline(options.operation, options.most_percent);
  timeline.schedule(bus, engine_options.clock_hz);
  driver::Card card = driver::Card::open(bus);
  Watch watch(*engine, plan, card.identification().clock_hz, options.progress);
  runner.add(recorder);
  runner.add(judges.feed);
  runner.add(watch);
  const run::Outcome outcome = run_until_signal(runner, card, machine, options.stream);
  recorder.finish();
  recorder.check(outcome.counted);
  judges.tell(result);
  tell(recorder, result);
  result.events = timeline.made();
  result.outputs = outputs_of(machine.outputs, judges.outputs);
  if (scripts_inputs(options.operation)) result.inputs = card.inputs();

  tell(runner.last_plan(), result);
  result.engine = engine_options.kind == sim::EngineKind::kRtl ? "rtl" : "model";
  tell(outcome, machine, result);
  tell(*engine, result);
  result.clock_hz = card.identification().clock_hz;
  result.profile = profile_of(machine, options.settings);
  if (options.plot) {
    result.plot = {result.program,     "mm",
                   course.points(),    recorder.executed(),
                   recorder.thinned(), course.detail(),
                   recorder.detail(),  recorder.speed()};
  }
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace trammel::app
