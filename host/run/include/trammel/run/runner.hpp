// Runs a program on a card. It is read twice in memory that does not grow with it: once to check and plan all of it,
// once to stream it. Opens nothing and prints nothing. Not thread-safe.
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

// Gives the program's lines from the first one on: called once for each pass, and may be called again.
using ProgramLines = std::function<std::unique_ptr<gcode::LineSource>()>;

// What is wrong with the program. what() is "file:line: message".
class ProgramError : public std::runtime_error {
 public:
  explicit ProgramError(gcode::Error error);
  const gcode::Error& error() const { return error_; }

 private:
  gcode::Error error_;
};

// What went wrong while the card ran, at the program's line that it was at. what() is "file:line: message".
class RunError : public std::runtime_error {
 public:
  RunError(const std::string& file, std::size_t line, const std::string& message);
  explicit RunError(const ProgramError& error);
  std::size_t line() const { return line_; }  // 0: before the first command

 private:
  std::size_t line_;
};

// It was asked to stop on the path (driver::Card::request_stop()): the card is at rest, and a program may begin there.
class StoppedOnPath : public RunError {
 public:
  StoppedOnPath(const std::string& file, std::size_t line, const std::string& message, const planner::Pulses& position)
      : RunError(file, line, message), position_(position) {}
  // Where it stands, machine coordinates.
  const planner::Pulses& position() const { return position_; }

 private:
  planner::Pulses position_;
};

// Where the motion is not smooth.
struct PlannedMotion {
  std::uint64_t stops = 0;       // motions that end at rest
  double velocity_jump = 0;      // mm/s, the largest of an axis at a corner that is passed
  double acceleration_step = 0;  // mm/s^2, the largest where curvature changes without a corner
};

// What G64 P has made of corners.
struct Blends {
  std::array<std::uint64_t, planner::kCorners> corners{};  // by planner::Corner
  double distance = 0;                                     // mm, the largest between blended and programmed path
};

// From the first pass.
struct Plan {
  std::string file;
  double seconds = 0;          // estimate
  std::uint64_t segments = 0;  // paths
  std::uint64_t rapids = 0;    // of these, the rapids
  std::uint64_t commands = 0;  // for the card
  PlannedMotion motion;
  Blends blends;
  planner::Pulses start{};  // by axis of the card, from machine zero on; where the first line begins
  planner::Pulses end{};
  std::vector<FeedNotReached> feeds_not_reached;  // one a cause, the cause of most blocks first
  std::map<std::string, std::size_t> accepted;    // words without effect yet and how often
  std::uint64_t probes = 0;                       // taken to end at their targets
  std::uint64_t lines_on_probes = 0;              // that depend on where they end: checked again when reached
  // Of all commands of the program, those before the run's first one too: equal plans have equal ones; 16 digits.
  std::string identity;
  // Where the run begins amid the program.
  std::uint64_t skipped = 0;       // commands before its first one that count in GEOMETRY_BEGUN
  std::uint64_t ticks_done = 0;    // feed ticks of its first path that are done
  std::size_t begin_line = 1;      // of the program
  driver::OutputCommand restored;  // set before anything else
};

// What a probe of the program has met.
struct ProbeMade {
  std::size_t line = 0;
  bool tripped = false;
  gcode::Coordinates edge{};  // machine coordinates; where it ended, if it did not trip
};

struct Outcome {
  std::vector<std::int64_t> counted;         // pulses from the start, by axis of the card, as it counted them
  std::vector<std::int64_t> final_position;  // pulses, likewise, from machine zero on
  gcode::Coordinates final_coordinates{};    // the same as the machine's axes: mm (degrees)
  std::uint64_t commands = 0;                // sent
  std::vector<ProbeMade> probes;
  std::map<int, double> parameters;         // of the program at its end, those that are not 0
  planner::PathTicks ticks;                 // for a run of what follows
  std::optional<std::uint32_t> under_runs;  // holds for want of commands; none where the card has no such hold
};

class Pipeline;

class Runner {
 public:
  // `machine` must outlive the runner. `card`: limits_of() the card that will run the program.
  Runner(ProgramLines lines, const machine::Machine& machine, const planner::CardLimits& card,
         const RunSettings& settings = {});

  // `observer` must outlive the runner; they are called in the order in which they were added.
  void add(Observer& observer) { observers_.push_back(&observer); }

  // First pass. Throws ProgramError, and driver::ArgumentError for step times that the card cannot keep.
  const Plan& plan();
  // Second pass, after the first, to the end of the motion: configures the card and streams. Throws StoppedOnPath when
  // another thread has asked the card for it, RunError for what
  // the card or its bus reports, ProgramError when the program is not the one that was planned, and std::runtime_error
  // when the card does not end where the program does.
  Outcome run(driver::Card& card);
  // In place of both: the program is read once, while it runs, and last_plan() tells what was read. What is wrong in it
  // is a RunError then; the motion before it is made and ends at rest.
  Outcome stream(driver::Card& card);
  // Of the last pass.
  const Plan& last_plan() const { return plan_; }
  // The card holds since this run begins amid the program, in its silence: the run ends this hold with its first piece
  // that moves, and nobody else does. For observers.
  bool begins() const { return begins_; }
  // As RunSettings::stands_at, for what comes next.
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
