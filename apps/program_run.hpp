// Runs a program on a simulated card through the driver and gathers what was measured on the way.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "motion_options.hpp"
#include "operator_timeline.hpp"
#include "profile_report.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/report/report_writer.hpp"
#include "trammel/run/deviation_meter.hpp"
#include "trammel/run/output_recorder.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/run/plot.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/text_sink.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::app {

struct RunOptions {
  bool stream = false;  // the program is read once, while it runs
  run::RunSettings settings;
  Operation operation;
  double most_percent = 100;       // largest override
  run::TextSink* steps = nullptr;  // not owned
  run::TextSink* path_steps = nullptr;
  run::TextSink* outputs = nullptr;
  run::TextSink* report = nullptr;
  std::optional<std::pair<std::uint64_t, std::uint64_t>> report_window;  // clocks
  bool plot = false;
  bool progress = false;  // also where stderr is no terminal
  // When all is checked and nothing has moved yet; with `stream` of an empty plan.
  std::function<void(const run::Plan&)> planned;
};

// An output that the machine file names.
struct OutputResult {
  unsigned number = 0;
  std::vector<std::string> words;  // that switch it on
  run::OutputRecorder::Output at_pin;
};

// Measured by the run; nothing here is taken from the plan but `segments`, `planned_seconds`, `motion`, `profile` and
// the picture's commanded path.
struct RunResult {
  std::string program;
  std::string engine;
  std::string axes;                              // letters in the card's order
  std::vector<std::int64_t> final_position;      // pulses by axis of the card, from machine zero on
  std::vector<std::uint64_t> steps;              // pulses at the pins
  std::vector<double> final_millimetres;         // of final_position
  bool joint_for_each_axis = true;               // no motor moves two axes
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
  run::PlannedMotion motion;
  run::Blends blends;
  ProfileReport profile;
  std::optional<std::uint32_t> under_runs;      // none where the card does not count them
  std::uint64_t path_steps = 0;                 // before the shapers
  std::string path_identity;                    // of their list
  run::ShaperDelay::Range shaper_delay;         // clocks
  std::optional<double> commanded_feed;         // mm/min, means
  std::optional<double> achieved_feed;          // mm/min
  std::vector<MadeEvent> events;                // that the card has seen
  std::vector<OutputResult> outputs;            // that the machine file names
  std::optional<std::uint16_t> inputs;          // as they stand at the end, where they are scripted; bit n: input n
  double wall_seconds = 0;                      // the simulation took
  std::map<std::string, std::size_t> accepted;  // words without effect yet
  std::vector<run::ProbeMade> probes;
  std::map<int, double> parameters;  // of the program at its end
  std::vector<run::FeedNotReached> feeds_not_reached;
  run::Plot plot;                         // filled when asked for
  run::DeviationMeter::Place line_place;  // of the largest deviations
  run::DeviationMeter::Place arc_place;
};

// `lines`: the program, opened twice. `engine_options` are used when `options.planned` has returned. Throws
// run::ProgramError before anything moves, run::RunError while it runs, lockstep::Mismatch, and std::runtime_error when
// the card does not end where the program says.
// `report`: made when options.planned has returned, where one is asked for; its finish() is the caller's.
RunResult run_program(const run::ProgramLines& lines, const machine::Machine& machine,
                      const sim::SimulationOptions& engine_options, const RunOptions& options,
                      std::unique_ptr<report::ReportWriter>* report = nullptr);

}  // namespace trammel::app
