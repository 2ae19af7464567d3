// Runs a program on a simulated card through the driver and gathers what was measured on the way.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/plot.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::app {

// Files to write; "-" is standard output.
struct RunOutputs {
  std::optional<std::string> json;
  std::optional<std::string> steps;
  std::optional<std::string> path_steps;
  std::optional<std::string> plot;
  bool progress = false;
};

// Measured by the run; nothing here is taken from the plan but `segments`, `planned_seconds` and the picture's
// commanded path.
struct RunResult {
  std::string program;
  std::string engine;
  std::string axes;                              // letters in the card's order
  std::vector<std::int64_t> final_position;      // pulses, the card's position counters
  std::vector<std::uint64_t> steps;              // pulses at the pins
  std::vector<double> final_millimetres;         // of final_position
  std::uint64_t cycles = 0;                      // clocks of the card
  std::uint32_t clock_hz = 0;                    // Hz
  std::optional<std::uint64_t> lockstep_cycles;  // clocks compared
  std::uint64_t comparisons = 0;                 // signals compared
  std::uint64_t mismatches = 0;                  // a mismatch ends the run: 0 in every result
  double largest_line_deviation = 0;             // pulses
  double largest_arc_deviation = 0;              // pulses outside the annulus
  std::uint64_t segments = 0;                    // of the program
  std::uint64_t commands = 0;                    // sent to the card
  double planned_seconds = 0;                    // estimate
  double wall_seconds = 0;                       // the simulation took
  std::map<std::string, std::size_t> accepted;   // words without effect yet
  run::Plot plot;                                // filled when asked for
};

// Sees a run as it goes: what is sent, and every step.
class RunWatcher : public driver::StepSink {
 public:
  // Before the commands of a segment are written. Their numbers follow on those of the segment before, from 0.
  virtual void sending(const planner::PlannedSegment& segment) = 0;
  // When they are written; `cycle` of the card.
  virtual void sent(std::uint64_t cycle) = 0;
};

// `watcher` may be nullptr. Throws gcode::ProgramError before anything moves, driver::Error with the program's line in
// its message while it runs, lockstep::Mismatch, and std::runtime_error when the card does not end where the program
// says.
RunResult run_program(const gcode::Program& program, const machine::Machine& machine,
                      const sim::SimulationOptions& engine_options, const RunOutputs& outputs,
                      RunWatcher* watcher = nullptr);

}  // namespace trammel::app
