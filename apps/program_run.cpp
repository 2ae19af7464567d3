#include "program_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "progress_bar.hpp"
#include "step_recorder.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/planner/planner.hpp"

namespace trammel::app {
namespace {

constexpr double kCentreScale = 256.0;

// The commanded path of a segment as points. In mm, where an arc is a circle whatever the axes' scales.
class CommandedPath {
 public:
  CommandedPath(const planner::PlannedSegment& segment, const std::vector<double>& steps_per_mm)
      : axes_(std::min<std::size_t>(3, steps_per_mm.size())), axis_x_(segment.axis_x), axis_y_(segment.axis_y) {
    double square = 0;
    for (std::size_t a = 0; a < steps_per_mm.size(); ++a) {
      start_[a] = static_cast<double>(segment.start[a]) / steps_per_mm[a];
      end_[a] = static_cast<double>(segment.end[a]) / steps_per_mm[a];
      square += std::pow(static_cast<double>(segment.end[a] - segment.start[a]), 2);
    }
    pulses_ = std::sqrt(square);
    if (segment.kind != gcode::MotionKind::kArc) return;
    centre_x_ = static_cast<double>(segment.centre_x) / kCentreScale / steps_per_mm[axis_x_];
    centre_y_ = static_cast<double>(segment.centre_y) / kCentreScale / steps_per_mm[axis_y_];
    radius_ = std::hypot(start_[axis_x_] - centre_x_, start_[axis_y_] - centre_y_);
    angle_ = std::atan2(start_[axis_y_] - centre_y_, start_[axis_x_] - centre_x_);
    turn_ = segment.clockwise ? -segment.sweep : segment.sweep;
    pulses_ = radius_ * segment.sweep * std::max(steps_per_mm[axis_x_], steps_per_mm[axis_y_]);
  }
  double pulses() const { return pulses_; }  // length, about

  // The point at a share, 0 to 1, of the path.
  Point at(double share) const {
    Point point{};
    for (std::size_t a = 0; a < axes_; ++a) point[a] = start_[a] + share * (end_[a] - start_[a]);
    if (radius_ > 0) {
      const double angle = angle_ + share * turn_;
      point[axis_x_] = centre_x_ + radius_ * std::cos(angle);
      point[axis_y_] = centre_y_ + radius_ * std::sin(angle);
    }
    return point;
  }

 private:
  std::size_t axes_;
  std::size_t axis_x_;
  std::size_t axis_y_;
  std::array<double, card_map::kMaxAxes> start_{};
  std::array<double, card_map::kMaxAxes> end_{};
  double centre_x_ = 0;
  double centre_y_ = 0;
  double radius_ = 0;  // 0: a line
  double angle_ = 0;
  double turn_ = 0;
  double pulses_ = 0;
};

// What one pass over the plan, before anything moves, tells.
struct Survey {
  double seconds = 0;
  std::uint64_t segments = 0;
  std::uint64_t commands = 0;
  std::optional<std::uint64_t> detail_command;  // the path to magnify
  std::vector<Point> detail;                    // its commanded course
  std::vector<Point> commanded;
};

bool is_geometry(const driver::Command& command) {
  return std::holds_alternative<driver::LineCommand>(command) || std::holds_alternative<driver::ArcCommand>(command);
}

// How well a segment shows single pulses: an arc best, then a line of several axes, then any path.
int detail_rank(const planner::PlannedSegment& segment) {
  if (segment.kind == gcode::MotionKind::kArc) return 3;
  int moving = 0;
  for (std::size_t a = 0; a < 3; ++a) moving += segment.end[a] != segment.start[a] ? 1 : 0;
  return std::min(moving, 2);
}

Survey survey(const gcode::Program& program, const machine::Machine& machine, std::uint32_t clock_hz,
              const std::vector<double>& steps_per_mm) {
  constexpr double kArcPoints = 64;
  Survey result;
  ThinnedPath commanded(10000);
  int best_rank = 0;
  planner::Planner planner(program, machine, clock_hz);
  planner::PlannedSegment segment;
  while (planner.next(segment)) {
    const auto geometry = std::find_if(segment.commands.begin(), segment.commands.end(), is_geometry);
    if (geometry != segment.commands.end()) {
      ++result.segments;
      const CommandedPath path(segment, steps_per_mm);
      if (commanded.given() == 0) commanded.add(path.at(0));
      const double points = segment.kind == gcode::MotionKind::kArc ? kArcPoints : 1;
      for (double i = 1; i <= points; ++i) commanded.add(path.at(i / points));
      const int rank = detail_rank(segment);
      if (rank > best_rank) {
        best_rank = rank;
        result.detail_command = result.commands + static_cast<std::uint64_t>(geometry - segment.commands.begin());
        result.detail.clear();
        const double length = std::min(path.pulses(), static_cast<double>(StepRecorder::kDetailPoints));
        for (double s = 0; s <= length; s += 1) result.detail.push_back(path.at(s / path.pulses()));
      }
    }
    result.commands += segment.commands.size();
  }
  result.seconds = planner.seconds();
  result.commanded = commanded.points();
  return result;
}

std::chrono::nanoseconds rounded_up(double nanoseconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::ceil(nanoseconds)));
}

void configure(driver::Card& card, const machine::Machine& machine) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const machine::MachineAxis& axis = machine.axes[i];
    driver::AxisSettings settings;
    settings.step_length = rounded_up(axis.step_length_ns);
    settings.step_space = rounded_up(axis.step_space_ns);
    settings.direction_setup = rounded_up(axis.direction_setup_ns);
    settings.direction_hold = rounded_up(axis.direction_hold_ns);
    settings.invert_second = axis.inverted;
    card.configure_axis(static_cast<unsigned>(i), settings);
  }
}

// Steps for the recorder and whoever else watches.
class StepFork final : public sim::StepSink {
 public:
  StepFork(StepRecorder& recorder, RunWatcher* watcher) : recorder_(recorder), watcher_(watcher) {}
  void pin_step(const sim::PinStep& step) override {
    recorder_.pin_step(step);
    if (watcher_ != nullptr) watcher_->pin_step(step);
  }
  void path_step(const sim::PathStep& step) override {
    recorder_.path_step(step);
    if (watcher_ != nullptr) watcher_->path_step(step);
  }

 private:
  StepRecorder& recorder_;
  RunWatcher* watcher_;
};

// Streams the plan; errors of the card get the line of the program that was being run.
class ProgramStream {
 public:
  ProgramStream(const gcode::Program& program, const machine::Machine& machine, sim::Engine& engine, driver::Card& card,
                StepRecorder& recorder, const Survey& plan, bool progress, RunWatcher* watcher)
      : program_(program),
        engine_(engine),
        recorder_(recorder),
        plan_(plan),
        bar_(progress),
        watcher_(watcher),
        planner_(program, machine, card.identification().clock_hz),
        card_(card),
        card_clock_hz_(card.identification().clock_hz),
        stream_(card, options()) {}

  // Gives back where the program ends, pulses.
  planner::Pulses run() {
    planner::Pulses end = planner_.start();
    try {
      planner::PlannedSegment segment;
      while (planner_.next(segment)) {
        for (const driver::Command& command : segment.commands) {
          recorder_.deviation().command(commands_++, command);
          if (!std::holds_alternative<driver::FeedCommand>(command)) geometry_lines_.push_back(segment.line);
        }
        if (watcher_ != nullptr) watcher_->sending(segment);
        stream_.send(segment.commands);
        if (watcher_ != nullptr) watcher_->sent(engine_.cycles());
        if (segment.kind != gcode::MotionKind::kDwell && segment.kind != gcode::MotionKind::kEnd) end = segment.end;
        show();
      }
      stream_.finish();
    } catch (const driver::FaultError& error) {
      // A fault has set the card's counters back; what had begun by then was latched.
      begun_ = card_.stop_snapshot().geometry_begun;
      throw std::runtime_error(fmt::format("{}:{}: {}", program_.file, current_line(), error.what()));
    } catch (const driver::Error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", program_.file, current_line(), error.what()));
    }
    return end;
  }

  std::uint64_t sent() const { return stream_.sent(); }

 private:
  driver::StreamOptions options() {
    // 200 looks a second: the queues hold far more than 5 ms of motion, and every look costs the simulation bus clocks.
    constexpr std::uint32_t kLooksPerSecond = 200;
    driver::StreamOptions options;
    options.poll_clocks = std::max<std::uint64_t>(64, card_clock_hz_ / kLooksPerSecond);
    options.progress = [this](const driver::StreamProgress& progress) {
      begun_ = progress.geometry_begun;
      show();
    };
    return options;
  }
  void show() {
    const double seconds = static_cast<double>(engine_.cycles()) / card_clock_hz_;
    bar_.show(plan_.seconds > 0 ? seconds / plan_.seconds : 1.0,
              fmt::format("{:.1f} of {:.1f} s of card time", seconds, plan_.seconds));
  }
  // The line of the path or barrier that the card has begun last; of the first one before that.
  std::size_t current_line() const {
    if (geometry_lines_.empty()) return 0;
    const std::size_t begun = std::max<std::size_t>(begun_, 1);
    return geometry_lines_[std::min(begun, geometry_lines_.size()) - 1];
  }

  const gcode::Program& program_;
  sim::Engine& engine_;
  StepRecorder& recorder_;
  const Survey& plan_;
  ProgressBar bar_;
  RunWatcher* watcher_;
  planner::Planner planner_;
  driver::Card& card_;
  std::uint32_t card_clock_hz_;
  std::uint64_t commands_ = 0;               // sent
  std::vector<std::size_t> geometry_lines_;  // of the program, by commands in the geometry queue
  std::uint32_t begun_ = 0;                  // of these, as the card said last
  driver::Stream stream_;
};

void check_end(const std::vector<std::int64_t>& card, const StepRecorder& recorder, const planner::Pulses& start,
               const planner::Pulses& end) {
  for (std::size_t a = 0; a < card.size(); ++a) {
    if (card[a] != recorder.position()[a]) {
      throw std::runtime_error(fmt::format("axis {}: the card counts {} pulses, {} were seen at the pin", a, card[a],
                                           recorder.position()[a]));
    }
    if (card[a] != end[a] - start[a]) {
      throw std::runtime_error(
          fmt::format("axis {}: the card ended at pulse {}, the program at {}", a, card[a], end[a] - start[a]));
    }
  }
}

}  // namespace

RunResult run_program(const gcode::Program& program, const machine::Machine& machine,
                      const sim::SimulationOptions& engine_options, const RunOutputs& outputs, RunWatcher* watcher) {
  const auto begun = std::chrono::steady_clock::now();
  StepRecorder::Options recording;
  recording.steps = outputs.steps;
  recording.path_steps = outputs.path_steps;
  recording.plot = outputs.plot.has_value();
  recording.clock_hz = engine_options.clock_hz;
  RunResult result;
  for (const machine::MachineAxis& axis : machine.axes) {
    recording.steps_per_mm.push_back(axis.steps_per_mm);
    result.axes += axis.letter;
  }
  Survey plan = survey(program, machine, engine_options.clock_hz, recording.steps_per_mm);

  const std::unique_ptr<sim::Engine> engine = sim::make_engine(engine_options);
  StepRecorder recorder(recording);
  if (plan.detail_command) recorder.detail_of(*plan.detail_command);
  StepFork steps(recorder, watcher);
  engine->set_sink(&steps);
  driver::Card card = driver::Card::open(*engine);
  configure(card, machine);
  ProgramStream stream(program, machine, *engine, card, recorder, plan, outputs.progress, watcher);
  const planner::Pulses end = stream.run();
  const driver::Snapshot snapshot = card.snapshot();
  recorder.finish();

  result.final_position.assign(snapshot.position.begin(),
                               snapshot.position.begin() + static_cast<std::ptrdiff_t>(machine.axes.size()));
  planner::Planner start(program, machine, engine_options.clock_hz);
  check_end(result.final_position, recorder, start.start(), end);
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    result.final_position[a] += start.start()[a];
    result.final_millimetres.push_back(static_cast<double>(result.final_position[a]) / machine.axes[a].steps_per_mm);
  }
  result.program = program.file;
  result.engine = engine_options.kind == sim::EngineKind::kRtl ? "rtl" : "model";
  result.steps = recorder.steps();
  result.cycles = engine->cycles();
  result.clock_hz = card.identification().clock_hz;
  result.lockstep_cycles = engine->lockstep_cycles();
  result.comparisons = engine->comparisons();
  result.largest_line_deviation = recorder.deviation().largest_line();
  result.largest_arc_deviation = recorder.deviation().largest_arc();
  result.segments = plan.segments;
  result.commands = stream.sent();
  result.planned_seconds = plan.seconds;
  result.accepted = program.accepted;
  if (outputs.plot) {
    result.plot = {program.file,           std::move(plan.commanded), recorder.executed(), recorder.thinned(),
                   std::move(plan.detail), recorder.detail(),         recorder.speed()};
  }
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace trammel::app
