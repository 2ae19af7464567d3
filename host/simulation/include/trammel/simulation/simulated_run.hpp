// A program on a simulated card: makes the card, streams to it through the driver, and gathers what its pins, its path
// and its comparison with the golden model show. Prints nothing and opens no file. Not thread-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trammel/machine/machine.hpp"
#include "trammel/report/report_writer.hpp"
#include "trammel/run/commanded_course.hpp"
#include "trammel/run/deviation_meter.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/output_recorder.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/run/plot.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/text_sink.hpp"
#include "trammel/sim/engines.hpp"
#include "trammel/simulation/operation.hpp"

namespace trammel::simulation {

// Sinks are not owned; one that is missing costs nothing.
struct RunOptions {
  run::RunSettings settings;
  Operation operation;
  double max_percent = 100;             // largest override, of the planned speed; 100 or more
  run::TextSink* steps = nullptr;       // every leading edge at a STEP pin
  run::TextSink* path_steps = nullptr;  // every step of the path
  run::TextSink* outputs = nullptr;     // every change of an output
  run::TextSink* report = nullptr;      // the page of the run; not for machines in which a motor moves two axes
  std::optional<std::pair<std::uint64_t, std::uint64_t>> report_window;  // clocks of the card, first and last
  bool plot = false;                                                     // RunResult::plot is wanted
  // What the card is put into before anything is connected to it: an engine around the one that it gets.
  std::function<std::unique_ptr<sim::Engine>(std::unique_ptr<sim::Engine>)> surroundings;
};

// An output that the machine file names.
struct OutputResult {
  unsigned number = 0;
  std::vector<std::string> words;  // that switch it on
  run::OutputRecorder::Output at_pin;
};

// Measured by the run; nothing here is taken from the plan but `plan` and the picture's commanded path.
struct RunResult {
  run::Plan plan;
  run::Outcome outcome;
  run::EndPosition end;  // of outcome.final_position
  sim::EngineKind engine = sim::EngineKind::kRtl;
  std::vector<std::uint64_t> steps;              // pulses at the pins, by axis of the card
  std::uint64_t cycles = 0;                      // clocks of the card
  std::uint32_t clock_hz = 0;                    // Hz
  std::optional<std::uint64_t> lockstep_cycles;  // clocks compared; none with the model alone
  std::uint64_t comparisons = 0;                 // signals compared
  double largest_line_deviation = 0;             // pulses
  double largest_arc_deviation = 0;              // pulses outside the annulus
  run::DeviationMeter::Place line_place;         // of these
  run::DeviationMeter::Place arc_place;
  std::uint64_t path_steps = 0;          // before the shapers
  std::string path_identity;             // of their list
  run::ShaperDelay::Range shaper_delay;  // clocks
  std::optional<double> commanded_feed;  // mm/min, means
  std::optional<double> achieved_feed;   // mm/min
  std::vector<MadeEvent> events;         // that the card has seen
  std::vector<OutputResult> outputs;     // that the machine file names
  std::optional<std::uint32_t> inputs;   // as they stand at the end, where they are scripted; bit n: input n
  double wall_seconds = 0;               // since the SimulatedRun was made
  run::Plot plot;                        // filled when asked for
};

// In this order: runner().plan() unless it is to stream; make_card(); runner().run() or stream() with card(); result().
class SimulatedRun {
 public:
  // `lines`: the program, opened twice, and once more for a report. `machine` must outlive the run; `card` is
  // limits_of() the engine options that make_card() will get. Throws std::invalid_argument where a report is asked for
  // and a motor moves two axes.
  SimulatedRun(run::ProgramLines lines, const machine::Machine& machine, const planner::CardLimits& card,
               const RunOptions& options);
  ~SimulatedRun();
  SimulatedRun(const SimulatedRun&) = delete;
  SimulatedRun& operator=(const SimulatedRun&) = delete;

  // Throws run::ProgramError out of plan(), run::RunError out of run() and stream(), and lockstep::Mismatch.
  run::Runner& runner() { return runner_; }
  // Makes the card and all that listens to it, and begins the report. Nothing moves yet. Once. Throws as
  // sim::make_engine() does.
  void make_card(const sim::SimulationOptions& engine);

  // These after make_card(); card() and cycles() before result().
  driver::Card& card();
  std::uint64_t cycles() const;    // clocks of the card so far
  report::ReportWriter* report();  // null where none is asked for; its finish() is the caller's
  // Once, after the run: the card is gone then, and its waveform whole. Throws std::runtime_error when the card did not
  // end where the program says.
  RunResult result(const run::Outcome& outcome);
  // In place of it, of a run that a run::RunError has ended, with the card at rest: what was made by then. `commands`:
  // sent.
  RunResult stopped_result(std::uint64_t commands);

 private:
  struct Instruments;  // the card and what listens to it
  RunResult gather(const run::Outcome& outcome);

  run::ProgramLines lines_;
  const machine::Machine& machine_;
  RunOptions options_;
  run::Runner runner_;
  run::CommandedCourse course_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::unique_ptr<Instruments> instruments_;
};

}  // namespace trammel::simulation
