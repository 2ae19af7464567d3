#include "trammel/run/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "trammel/driver/stream.hpp"
#include "trammel/run/configure.hpp"

namespace trammel::run {
namespace {

bool is_geometry(const driver::Command& command) {
  return std::holds_alternative<driver::LineCommand>(command) || std::holds_alternative<driver::ArcCommand>(command);
}

// Streams the plan; errors of the card get the line of the program that was being run.
class ProgramStream {
 public:
  ProgramStream(const gcode::Program& program, const machine::Machine& machine, driver::Card& card,
                const std::vector<Observer*>& observers)
      : program_(program),
        observers_(observers),
        planner_(program, machine, card.identification().clock_hz),
        card_(card),
        stream_(card, options()) {}

  // Gives back where the program ends, pulses.
  planner::Pulses run() {
    planner::Pulses end = planner_.start();
    try {
      planner::PlannedSegment segment;
      while (planner_.next(segment)) {
        send(segment);
        if (segment.kind != gcode::MotionKind::kDwell && segment.kind != gcode::MotionKind::kEnd) end = segment.end;
      }
      stream_.finish();
    } catch (const driver::FaultError& error) {
      // A fault has set the card's counters back; what had begun by then was latched.
      begun_ = card_.stop_snapshot().geometry_begun;
      throw RunError(program_.file, current_line(), error.what());
    } catch (const driver::Error& error) {
      throw RunError(program_.file, current_line(), error.what());
    }
    return end;
  }

  std::uint64_t sent() const { return stream_.sent(); }

 private:
  driver::StreamOptions options() {
    // 200 looks a second: the queues hold far more than 5 ms of motion, and every look costs a simulation bus clocks.
    constexpr std::uint32_t kLooksPerSecond = 200;
    driver::StreamOptions options;
    options.poll_clocks = std::max<std::uint64_t>(64, card_.identification().clock_hz / kLooksPerSecond);
    options.progress = [this](const driver::StreamProgress& progress) {
      begun_ = progress.geometry_begun;
      for (Observer* observer : observers_) observer->progress();
    };
    return options;
  }
  void send(const planner::PlannedSegment& segment) {
    for (Observer* observer : observers_) observer->sending(segment);
    for (const driver::Command& command : segment.commands) {
      for (Observer* observer : observers_) observer->command(commands_, command);
      ++commands_;
      if (!std::holds_alternative<driver::FeedCommand>(command)) geometry_lines_.push_back(segment.line);
    }
    stream_.send(segment.commands);
    for (Observer* observer : observers_) observer->sent();
  }
  // The line of the path or barrier that the card has begun last; of the first one before that.
  std::size_t current_line() const {
    if (geometry_lines_.empty()) return 0;
    const std::size_t begun = std::max<std::size_t>(begun_, 1);
    return geometry_lines_[std::min(begun, geometry_lines_.size()) - 1];
  }

  const gcode::Program& program_;
  const std::vector<Observer*>& observers_;
  planner::Planner planner_;
  driver::Card& card_;
  std::uint64_t commands_ = 0;               // sent
  std::vector<std::size_t> geometry_lines_;  // of the program, by commands in the geometry queue
  std::uint32_t begun_ = 0;                  // of these, as the card said last
  driver::Stream stream_;
};

}  // namespace

RunError::RunError(const std::string& file, std::size_t line, const std::string& message)
    : std::runtime_error(fmt::format("{}:{}: {}", file, line, message)), line_(line) {}

Runner::Runner(const gcode::Program& program, const machine::Machine& machine, std::uint32_t clock_hz)
    : program_(program), machine_(machine), clock_hz_(clock_hz) {
  start_ = planner::Planner(program, machine, clock_hz).start();
}

const Plan& Runner::plan() {
  plan_ = Plan{};
  planner::Planner planner(program_, machine_, clock_hz_);
  for (planner::PlannedSegment segment; planner.next(segment);) {
    for (Observer* observer : observers_) observer->planned(segment, plan_.commands);
    if (std::any_of(segment.commands.begin(), segment.commands.end(), is_geometry)) ++plan_.segments;
    plan_.commands += segment.commands.size();
  }
  plan_.seconds = planner.seconds();
  return plan_;
}

Outcome Runner::run(driver::Card& card) {
  configure(card, machine_);
  ProgramStream stream(program_, machine_, card, observers_);
  const planner::Pulses end = stream.run();
  const driver::Snapshot snapshot = card.snapshot();
  Outcome outcome;
  for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
    const std::int64_t counted = snapshot.position[a];
    if (counted != end[a] - start_[a]) {
      throw std::runtime_error(
          fmt::format("axis {}: the card ended at pulse {}, the program at {}", a, counted, end[a] - start_[a]));
    }
    outcome.counted.push_back(counted);
    outcome.final_position.push_back(end[a]);
  }
  outcome.commands = stream.sent();
  return outcome;
}

}  // namespace trammel::run
