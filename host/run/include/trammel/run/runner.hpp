// Runs a program on a card. The program is read twice: once to check and plan all of it, and once to stream it. The
// memory does not grow with the program. Opens no files and prints nothing. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/run/feed_report.hpp"
#include "trammel/run/observer.hpp"
#include "trammel/run/run_settings.hpp"

namespace trammel::run {

// Returns the program's lines from the first one on. Called once for each pass; a later call starts again at the first
// line.
using ProgramLines = std::function<std::unique_ptr<gcode::LineSource>()>;

// An error in the program. what() is "file:line: message".
class ProgramError : public std::runtime_error {
 public:
  explicit ProgramError(gcode::Error error);
  const gcode::Error& error() const { return error_; }

 private:
  gcode::Error error_;
};

// An error while the card ran, with the program line in execution. what() is "file:line: message".
class RunError : public std::runtime_error {
 public:
  RunError(const std::string& file, std::size_t line, const std::string& message);
  explicit RunError(const ProgramError& error);
  std::size_t line() const { return line_; }  // 0: before the first command

 private:
  std::size_t line_;
};

// A stop on the path was requested (driver::Card::request_stop()). The card is at rest, and a program may begin there.
class StoppedOnPath : public RunError {
 public:
  StoppedOnPath(const std::string& file, std::size_t line, const std::string& message, const planner::Pulses& position)
      : RunError(file, line, message), position_(position) {}
  // The position of the stop, machine coordinates.
  const planner::Pulses& position() const { return position_; }

 private:
  planner::Pulses position_;
};

// Figures for the motion's smoothness.
struct PlannedMotion {
  std::uint64_t stops = 0;       // motions that end at rest
  double velocity_jump = 0;      // mm/s, largest jump of an axis at a corner passed without a stop
  double acceleration_step = 0;  // mm/s^2, largest step where curvature changes without a corner
};

// The effect of G64 P on corners.
struct Blends {
  std::array<std::uint64_t, planner::kCorners> corners{};  // by planner::Corner
  double distance = 0;                                     // mm, largest, of the blended path from the programmed one
};

// The result of the first pass.
struct Plan {
  std::string file;
  double seconds = 0;          // estimate
  std::uint64_t segments = 0;  // paths
  std::uint64_t rapids = 0;    // paths that are rapids
  std::uint64_t commands = 0;  // for the card
  PlannedMotion motion;
  Blends blends;
  planner::Pulses start{};  // position at the first line, by axis of the card, relative to machine zero
  planner::Pulses end{};
  std::vector<FeedNotReached> feeds_not_reached;  // one entry per cause, the most frequent first
  std::map<std::string, std::size_t> accepted;    // words that have no effect yet, with their counts
  std::uint64_t probes = 0;                       // probes; the plan assumes that they end at their targets
  std::uint64_t lines_on_probes = 0;              // lines that depend on a probe's result: checked again when reached
  // Hash of all commands of the program, including those before the run's first one; equal plans have equal hashes. 16
  // digits.
  std::string identity;
  // For a run that begins in the middle of the program:
  std::uint64_t skipped = 0;       // commands before its first one that count in GEOMETRY_BEGUN
  std::uint64_t ticks_done = 0;    // feed ticks of its first path that are already done
  std::size_t begin_line = 1;      // program line
  driver::OutputCommand restored;  // output levels that are set first
};

// The result of a probe of the program.
struct ProbeMade {
  std::size_t line = 0;
  bool tripped = false;
  gcode::Coordinates edge{};  // machine coordinates; the end of the motion if it did not trip
};

struct Outcome {
  std::vector<std::int64_t> counted;         // pulses from the start, by axis of the card, from its counters
  std::vector<std::int64_t> final_position;  // pulses relative to machine zero, by axis of the card
  gcode::Coordinates final_coordinates{};    // the same by axis of the machine: mm (degrees)
  std::uint64_t commands = 0;                // commands sent
  std::vector<ProbeMade> probes;
  std::map<int, double> parameters;         // program parameters at the end that are not 0
  planner::PathTicks ticks;                 // for RunSettings::ticks of the next run
  std::optional<std::uint32_t> under_runs;  // under-run holds; none if the card lacks the under-run hold
};

class Pipeline;

class Runner {
 public:
  // `machine` must outlive the runner. `card`: limits_of() of the card that will run the program.
  Runner(ProgramLines lines, const machine::Machine& machine, const planner::CardLimits& card,
         const RunSettings& settings = {});

  // `observer` must outlive the runner. Observers are called in the order in which they were added.
  void add(Observer& observer) { observers_.push_back(&observer); }

  // First pass. Throws ProgramError, and driver::ArgumentError for step times that the card does not support.
  const Plan& plan();
  // Second pass, after the first, to the end of the motion: configures the card and streams. Throws StoppedOnPath if
  // another thread has requested a stop from the card, RunError for errors of the card or its bus, ProgramError if the
  // program differs from the planned one, and std::runtime_error if the card's final position is not the program's.
  Outcome run(driver::Card& card);
  // Replaces both passes: the program is read once, while it runs, and last_plan() returns the plan of it. An error in
  // the program is then a RunError; the motion before it is executed and ends at rest.
  Outcome stream(driver::Card& card);
  // The plan of the last pass.
  const Plan& last_plan() const { return plan_; }
  // For observers: the card is in the hold with which a run begins in the middle of the program. The run itself ends
  // this hold, with its first piece that moves; nothing else may end it.
  bool begins() const { return begins_; }
  // Sets RunSettings::stands_at for the next pass.
  void stands_at(const planner::Pulses& position) { settings_.stands_at = position; }

 private:
  void require_planned_for(driver::Card& card) const;
  void prepare(driver::Card& card, const Pipeline& pipeline) const;
  Outcome outcome(driver::Card& card, const driver::Snapshot& before, const planner::Pulses& end) const;

  ProgramLines lines_;
  const machine::Machine& machine_;
  planner::CardLimits card_;
  RunSettings settings_;
  std::vector<Observer*> observers_;
  Plan plan_;
  bool begins_ = false;
};

}  // namespace trammel::run
