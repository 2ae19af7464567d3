#include "trammel/report/report_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <stdexcept>
#include <vector>

#include "path_record.hpp"
#include "step_coder.hpp"
#include "time_map.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/planner/card_limits.hpp"
#include "trammel/report/motion_clock.hpp"
#include "trammel/report/page.hpp"
#include "trammel/report/page_stream.hpp"

namespace trammel::report {
namespace {

// The feed ticks of a path's command, and their relation to its path ticks.
struct CommandTicks {
  std::uint64_t number = 0;
  std::uint64_t begin = 0;     // feed ticks before the command
  std::uint64_t prescale = 0;  // 2^-40 path ticks per feed tick; 0: path ticks are feed ticks
  std::uint64_t last = 0;      // feed ticks of the command
};

// The feed tick of a path tick: the prescaler is a pulse generator, whose phase begins at one half.
std::uint64_t feed_tick(const CommandTicks& command, std::uint64_t path_tick) {
  if (command.prescale == 0) return command.begin + path_tick;
  const double tick =
      std::ceil((static_cast<double>(path_tick) - 0.5) * 0x1p40 / static_cast<double>(command.prescale));
  return command.begin + std::min(static_cast<std::uint64_t>(tick), command.last);
}

// By axis: pulses of a motor per mm of the axis, and mm of the axis per pulse of the motor.
std::string ratios_json(const kinematics::Kinematics& kinematics, std::size_t motor) {
  std::vector<double> pulses;
  for (std::size_t axis = 0; axis < kinematics.axes(); ++axis) {
    kinematics::Direction along{};
    along[axis] = 1;
    pulses.push_back(kinematics.pulse_rate(motor, along));
  }
  kinematics::Pulses one{};
  one[motor] = 1;
  const kinematics::Coordinates moved = kinematics.coordinates(one);
  const std::vector<double> way(moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(kinematics.axes()));
  return fmt::format(R"("pulses_per_mm":[{:.17g}],"mm_per_pulse":[{:.17g}])", fmt::join(pulses, ","),
                     fmt::join(way, ","));
}

}  // namespace

class ReportWriter::State {
 public:
  State(run::TextSink& to, const machine::Machine& of, const ReportSettings& with)
      : sink(to),
        machine(of),
        settings(with),
        motion(to, "motion"),
        times(to, "times"),
        paths(to, of),
        clock([this](const MotionSegment& segment) { put(segment); }),
        spacing(std::max<std::uint64_t>(256, with.clock_hz / 500)) {
    for (unsigned axis = 0; axis < of.motors(); ++axis) steps.push_back(std::make_unique<StepCoder>(to, axis));
    before.resize(of.motors());
    beside.resize(of.motors());
    if (with.window) {
      first_cycle = with.window->first;
      last_cycle = with.window->second;
    }
  }

  void put(const MotionSegment& segment) {
    motion.varint(segment.path - motion_path);
    motion_path = segment.path;
    motion.varint(segment.clocks);
    motion.number(static_cast<float>(segment.rate));
    motion.number(static_cast<float>(segment.acceleration));
    motion.number(static_cast<float>(segment.jerk));
  }
  void keep(const TimeMap::Point& point) {
    times.varint((point.motion - kept.motion) << 1 | (point.first ? 1U : 0U));
    times.varint(point.cycle - kept.cycle);
    if (point.first) times.varint(point.motion - point.begin);
    kept = point;
  }
  // Offers a step to the map of times; the last step of a motion is always one of its points.
  void anchor(const driver::PathStep& step) {
    const CommandTicks& command = commands.front();
    const TimeMap::Point point{clock.clock_of(feed_tick(command, step.tick)), step.cycle, new_stretch, stretch_begin};
    map.add(point, [this](const TimeMap::Point& one) { keep(one); });
    anchored = step.cycle;
    new_stretch = false;
  }
  void barrier() {
    clock.barrier();
    barrier_put = true;
    after_barrier = clock.next_begins();
  }
  void enter(std::uint64_t command);
  void count_clock(const driver::PathStep& step);
  bool inside(std::uint64_t cycle) const { return cycle >= first_cycle && cycle <= last_cycle; }
  std::string machine_json() const;

  run::TextSink& sink;
  const machine::Machine& machine;
  ReportSettings settings;
  std::vector<std::unique_ptr<StepCoder>> steps;  // by motor
  PageStream motion;
  PageStream times;
  PathCoder paths;
  MotionClock clock;
  TimeMap map;
  TimeMap::Point kept;
  std::uint64_t motion_path = 0;

  std::uint64_t blocks = 0;           // blocks sent
  std::deque<PathRecord> under_way;   // blocks with outstanding steps
  std::deque<CommandTicks> commands;  // path commands with outstanding steps
  struct Stretch {
    std::uint64_t first;  // number of its first path
    std::uint64_t begin;  // motion clock at its begin
  };
  std::deque<Stretch> stretches;  // stretches between barriers that have not begun
  bool barrier_put = true;
  std::uint64_t after_barrier = 0;  // motion clock after the last barrier
  bool first_of_block = false;

  std::uint64_t spacing;  // clocks between steps offered to the map of times
  std::uint64_t anchored = 0;
  bool new_stretch = false;
  std::uint64_t stretch_begin = 0;
  std::optional<driver::PathStep> last;
  std::optional<planner::Pulses> start;

  std::uint64_t first_cycle = 0;  // first clock of the steps in the page
  std::uint64_t last_cycle = ~std::uint64_t{0};
  std::vector<std::int64_t> before;   // pulses before the window, by motor
  std::vector<std::uint64_t> beside;  // steps that are not in the page
  std::uint64_t clocks_before = 0;    // clocks with steps before the window
};

// Removes the commands before that of a step, and writes the blocks before it.
void ReportWriter::State::enter(std::uint64_t command) {
  while (!commands.empty() && commands.front().number < command) commands.pop_front();
  if (commands.empty() || commands.front().number != command) {
    throw std::logic_error("a step of a command that was never sent");
  }
  while (under_way.size() > 1 && under_way[1].first_command <= command) {
    paths.put(under_way.front());
    under_way.pop_front();
  }
}

void ReportWriter::State::count_clock(const driver::PathStep& step) {
  ++under_way.front().step_clocks;
  if (step.cycle < first_cycle) ++clocks_before;
}

ReportWriter::ReportWriter(run::TextSink& sink, const machine::Machine& machine, const ReportSettings& settings) {
  if (!page_is_built()) throw std::logic_error(kHowToBuildPage);
  state_ = std::make_unique<State>(sink, machine, settings);
  sink.write(page_head());
}

ReportWriter::~ReportWriter() = default;

void ReportWriter::program(gcode::LineSource& lines) {
  PageStream text(state_->sink, "program");
  std::string_view line;
  while (lines.next(line)) {
    text.bytes(line);
    text.bytes("\n");
  }
  text.finish();
}

void ReportWriter::sending(const planner::PlannedBlock& planned) {
  State& state = *state_;
  if (!state.start) state.start = planned.block.start;
  PathRecord record;
  record.block = planned.block;
  record.speed = planned.speed;
  record.limit = planned.limit;
  record.stop = planned.stop;
  record.first_command = ~std::uint64_t{0};
  state.under_way.push_back(record);
  ++state.blocks;
}

void ReportWriter::command(std::uint64_t number, const driver::Command& command) {
  State& state = *state_;
  // A probe's own commands are before and after those of its block.
  if (std::holds_alternative<driver::ProbeCommand>(command) ||
      std::holds_alternative<driver::ProbeEndCommand>(command)) {
    return state.barrier();
  }
  PathRecord& record = state.under_way.back();
  if (record.first_command == ~std::uint64_t{0}) record.first_command = number;
  CommandTicks ticks{number, state.clock.ticks(), 0, 0};
  if (const auto* feed = std::get_if<driver::FeedCommand>(&command)) {
    state.clock.piece(*feed);
    return;
  }
  if (const auto* line = std::get_if<driver::LineCommand>(&command)) {
    ticks.last = line->ticks;
  } else if (const auto* chord = std::get_if<driver::ArcChordCommand>(&command)) {
    ticks.last = chord->ticks;
    ticks.prescale = chord->prescale;
  } else if (const auto* arc = std::get_if<driver::ArcCommand>(&command)) {
    ticks.last = arc->ticks;
    ticks.prescale = arc->prescale;
  } else {
    if (driver::counts_as_begun(command)) state.barrier();
    return;
  }
  if (state.barrier_put) state.stretches.push_back({number, state.after_barrier});
  state.barrier_put = false;
  record.ticks += ticks.last;
  state.clock.path(state.blocks - 1, ticks.last);
  state.commands.push_back(ticks);
}

void ReportWriter::path_step(const driver::PathStep& step) {
  State& state = *state_;
  const bool same_clock = state.last && state.last->cycle == step.cycle;
  if (!same_clock) {
    const std::optional<driver::PathStep> last = state.last;
    const bool behind_barrier = !state.stretches.empty() && step.command >= state.stretches.front().first;
    // The last step of a motion, and the last before a gap, are also points of the map.
    if (last && last->cycle != state.anchored && (behind_barrier || step.cycle - state.anchored >= state.spacing)) {
      state.anchor(*last);
    }
    state.enter(step.command);
    if (behind_barrier) {
      state.new_stretch = true;
      state.stretch_begin = state.stretches.front().begin;
      state.stretches.pop_front();
    }
    state.count_clock(step);
    state.last = step;
    if (state.new_stretch || step.cycle - state.anchored >= state.spacing) state.anchor(step);
  }
  if (state.inside(step.cycle)) {
    state.steps[step.axis]->path_step(step.cycle, step.direction);
    return;
  }
  state.steps[step.axis]->pass();
  ++state.beside[step.axis];
  if (step.cycle < state.first_cycle) state.before[step.axis] += step.direction;
}

void ReportWriter::pin_step(const driver::PinStep& step) { state_->steps[step.axis]->pin_step(step.cycle); }

std::string ReportWriter::State::machine_json() const {
  const auto clocks = [&](std::chrono::nanoseconds time) {
    return driver::clocks_of(time, settings.clock_hz, "step time");
  };
  const kinematics::Kinematics kinematics(machine);
  std::string list;
  const std::vector<std::size_t> second = machine.second_motors();
  for (std::size_t motor = 0; motor < machine.motors(); ++motor) {
    const std::size_t axis = motor < machine.axes.size() ? motor : second[motor - machine.axes.size()];
    const machine::MachineAxis& of = machine.axes[axis];
    list += fmt::format(
        R"({}{{"letter":"{}","axis":{},{},"max_velocity":{:.17g},"max_acceleration":{:.17g},)"
        R"("max_jerk":{:.17g},"step_length":{},"dir_lead":{},"inverted":{},"start":{},"before":{},"beside":{}}})",
        motor == 0 ? "" : ",", of.letter, axis, ratios_json(kinematics, motor), of.max_velocity, of.max_acceleration,
        of.max_jerk, clocks(planner::settings_of(of).step_length),
        clocks(planner::settings_of(of).direction_setup) + kTurnClocks, kinematics.joint(motor).inverted,
        start ? (*start)[axis] : 0, before[motor], beside[motor]);
  }
  std::string window = "null";
  if (settings.window) window = fmt::format("[{},{}]", first_cycle, last_cycle);
  return fmt::format(
      R"({{"clock_hz":{},"axes":{},"max_override":{:.17g},"window":{},"clocks_before":{},"motors":[{}]}})",
      settings.clock_hz, machine.axes.size(), machine.motion.max_override, window, clocks_before, list);
}

void ReportWriter::finish(const std::string& run, bool stopped) {
  State& state = *state_;
  if (stopped && state.under_way.size() > 1) state.under_way.resize(1);
  if (state.last && state.last->cycle != state.anchored) state.anchor(*state.last);
  state.map.flush([&](const TimeMap::Point& point) { state.keep(point); });
  state.clock.barrier();
  for (const PathRecord& record : state.under_way) state.paths.put(record);
  state.paths.finish();
  state.motion.finish();
  state.times.finish();
  for (const auto& coder : state.steps) coder->finish();
  const std::string json = fmt::format(R"({{"machine":{},"run":{}}})", state.machine_json(), run);
  state.sink.write("<script type=\"application/json\" id=\"facts\">" + inside_script(json) + "</script>\n");
  state.sink.write(page_tail());
}

std::string inside_script(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  // '<' occurs only in strings, where \u003c has the same meaning.
  for (const char c : json) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

}  // namespace trammel::report
