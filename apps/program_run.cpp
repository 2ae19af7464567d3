#include "program_run.hpp"

#include <fmt/format.h>

#include <chrono>

#include "outputs.hpp"
#include "progress_bar.hpp"
#include "trammel/run/commanded_course.hpp"
#include "trammel/run/step_recorder.hpp"

namespace trammel::app {
namespace {

// Steps for the recorder and whoever else watches.
class StepFork final : public driver::StepSink {
 public:
  StepFork(driver::StepSink& recorder, RunWatcher* watcher) : recorder_(recorder), watcher_(watcher) {}
  void pin_step(const driver::PinStep& step) override {
    recorder_.pin_step(step);
    if (watcher_ != nullptr) watcher_->pin_step(step);
  }
  void path_step(const driver::PathStep& step) override {
    recorder_.path_step(step);
    if (watcher_ != nullptr) watcher_->path_step(step);
  }

 private:
  driver::StepSink& recorder_;
  RunWatcher* watcher_;
};

// Shows how far the run is; tells a watcher what is sent, and when.
class Watch final : public run::Observer {
 public:
  Watch(const sim::Engine& engine, const run::Plan& plan, double clock_hz, bool progress, RunWatcher* watcher)
      : engine_(engine), plan_(plan), clock_hz_(clock_hz), bar_(progress), watcher_(watcher) {}
  void sending(const planner::PlannedSegment& segment) override {
    if (watcher_ != nullptr) watcher_->sending(segment);
  }
  void sent() override {
    if (watcher_ != nullptr) watcher_->sent(engine_.cycles());
    progress();
  }
  void progress() override {
    const double seconds = static_cast<double>(engine_.cycles()) / clock_hz_;
    bar_.show(plan_.seconds > 0 ? seconds / plan_.seconds : 1.0,
              fmt::format("{:.1f} of {:.1f} s of card time", seconds, plan_.seconds));
  }

 private:
  const sim::Engine& engine_;
  const run::Plan& plan_;
  double clock_hz_;
  ProgressBar bar_;
  RunWatcher* watcher_;
};

}  // namespace

RunResult run_program(const gcode::Program& program, const machine::Machine& machine,
                      const sim::SimulationOptions& engine_options, const RunOutputs& outputs, RunWatcher* watcher) {
  const auto begun = std::chrono::steady_clock::now();
  RunResult result;
  run::StepRecorder::Options recording;
  for (const machine::MachineAxis& axis : machine.axes) {
    recording.steps_per_mm.push_back(axis.steps_per_mm);
    result.axes += axis.letter;
  }
  run::Runner runner(program, machine, engine_options.clock_hz);
  run::CommandedCourse course(machine);
  if (outputs.plot) runner.add(course);
  const run::Plan plan = runner.plan();

  const std::unique_ptr<FileSink> steps = outputs.steps ? std::make_unique<FileSink>(*outputs.steps) : nullptr;
  const std::unique_ptr<FileSink> path_steps =
      outputs.path_steps ? std::make_unique<FileSink>(*outputs.path_steps) : nullptr;
  recording.steps = steps.get();
  recording.path_steps = path_steps.get();
  recording.plot = outputs.plot.has_value();
  recording.clock_hz = engine_options.clock_hz;
  run::StepRecorder recorder(recording);
  if (course.detail_command()) recorder.detail_of(*course.detail_command());

  const std::unique_ptr<sim::Engine> engine = sim::make_engine(engine_options);
  StepFork fork(recorder, watcher);
  engine->set_sink(&fork);
  driver::Card card = driver::Card::open(*engine);
  Watch watch(*engine, plan, card.identification().clock_hz, outputs.progress, watcher);
  runner.add(recorder);
  runner.add(watch);
  const run::Outcome outcome = runner.run(card);
  recorder.finish();
  if (steps) steps->close();
  if (path_steps) path_steps->close();
  recorder.check(outcome.counted);

  result.program = program.file;
  result.engine = engine_options.kind == sim::EngineKind::kRtl ? "rtl" : "model";
  result.final_position = outcome.final_position;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    result.final_millimetres.push_back(static_cast<double>(result.final_position[a]) / machine.axes[a].steps_per_mm);
  }
  result.steps = recorder.steps();
  result.cycles = engine->cycles();
  result.clock_hz = card.identification().clock_hz;
  result.lockstep_cycles = engine->lockstep_cycles();
  result.comparisons = engine->comparisons();
  result.largest_line_deviation = recorder.deviation().largest_line();
  result.largest_arc_deviation = recorder.deviation().largest_arc();
  result.segments = plan.segments;
  result.commands = outcome.commands;
  result.planned_seconds = plan.seconds;
  result.accepted = program.accepted;
  if (outputs.plot) {
    result.plot = {program.file,    course.points(),   recorder.executed(), recorder.thinned(),
                   course.detail(), recorder.detail(), recorder.speed()};
  }
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace trammel::app
