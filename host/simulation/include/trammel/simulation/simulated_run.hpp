// A program on a simulated card: makes the card, streams to it through the driver, and collects the results from its
// pins, its path and the comparison with the golden model. Prints nothing and opens no file. Not thread-safe.
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

// Sinks are not owned; a null sink costs nothing.
struct RunOptions {
  run::RunSettings settings;
  Operation operation;
  double max_percent = 100;             // largest override, in percent of the planned speed; 100 or more
  run::TextSink* steps = nullptr;       // every leading edge at a STEP pin
  run::TextSink* path_steps = nullptr;  // every step of the path
  run::TextSink* outputs = nullptr;     // every change of an output
  run::TextSink* report = nullptr;      // the page of the run; not if one motor moves two axes
  std::optional<std::pair<std::uint64_t, std::uint64_t>> report_window;  // clocks of the card, first and last
  bool plot = false;                                                     // fill RunResult::plot
  // Wraps the card's engine in another engine, such as a simulated machine, before anything is connected to it.
  std::function<std::unique_ptr<sim::Engine>(std::unique_ptr<sim::Engine>)> surroundings;
};

// An output that the machine file names.
struct OutputResult {
  unsigned number = 0;
  std::vector<std::string> words;  // words that switch it on
  run::OutputRecorder::Output at_pin;
};

// Measured by the run, except for `plan` and the commanded path of the picture.
struct RunResult {
  run::Plan plan;
  run::Outcome outcome;
  run::EndPosition end;  // of outcome.final_position
  sim::EngineKind engine = sim::EngineKind::kRtl;
  std::vector<std::uint64_t> steps;              // pulses at the pins, by axis of the card
  std::uint64_t cycles = 0;                      // clocks of the card
  std::uint32_t clock_hz = 0;                    // Hz
  std::optional<std::uint64_t> lockstep_cycles;  // clocks compared; none if only the model runs
  std::uint64_t comparisons = 0;                 // signals compared
  double largest_line_deviation = 0;             // pulses
  double largest_arc_deviation = 0;              // pulses outside the annulus
  run::DeviationMeter::Place line_place;         // place of the largest line deviation
  run::DeviationMeter::Place arc_place;          // place of the largest arc deviation
  std::uint64_t path_steps = 0;                  // before the shapers
  std::string path_identity;                     // identity of their list
  run::ShaperDelay::Range shaper_delay;          // clocks
  std::optional<double> commanded_feed;          // mm/min, mean
  std::optional<double> achieved_feed;           // mm/min, mean
  std::vector<MadeEvent> events;                 // events that have happened on the card
  std::vector<OutputResult> outputs;             // outputs that the machine file names
  std::optional<std::uint32_t> inputs;           // levels at the end, if `operation` scripts inputs; bit n: input n
  double wall_seconds = 0;                       // since the SimulatedRun was made
  run::Plot plot;                                // empty unless RunOptions::plot
};

// Call in this order: runner().plan(), except when streaming; make_card(); runner().run() or stream() with card();
// result().
class SimulatedRun {
 public:
  // `lines`: the program; it is opened twice, and once more for a report. `machine` must outlive the run; `card` is
  // limits_of() the engine options that make_card() will get. Throws std::invalid_argument if a report is wanted and a
  // motor moves two axes.
  SimulatedRun(run::ProgramLines lines, const machine::Machine& machine, const planner::CardLimits& card,
               const RunOptions& options);
  ~SimulatedRun();
  SimulatedRun(const SimulatedRun&) = delete;
  SimulatedRun& operator=(const SimulatedRun&) = delete;

  // plan() throws run::ProgramError; run() and stream() throw run::RunError and lockstep::Mismatch.
  run::Runner& runner() { return runner_; }
  // Makes the card and all that listens to it, and begins the report. Nothing moves yet. Call once. Throws as
  // sim::make_engine() does.
  void make_card(const sim::SimulationOptions& engine);

  // Call these after make_card(); card() and cycles() before result().
  driver::Card& card();
  std::uint64_t cycles() const;    // clocks of the card so far
  report::ReportWriter* report();  // null without a report; the caller calls its finish()
  // Call once, after the run. It destroys the card and so completes its waveform. Throws std::runtime_error if the card
  // did not end where the program says.
  RunResult result(const run::Outcome& outcome);
  // Call instead of result() after a run::RunError, with the card at rest: the results up to then. `commands`: number
  // of commands sent.
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
