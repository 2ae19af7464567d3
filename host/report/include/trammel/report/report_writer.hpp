// Writes the page of a run during the run, in memory that does not grow with it. The page's data are streams
// (PageStream) and one element of JSON; docs/developer/report.md has their layout. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "trammel/driver/steps.hpp"
#include "trammel/gcode/line_source.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/observer.hpp"
#include "trammel/run/text_sink.hpp"

namespace trammel::report {

struct ReportSettings {
  std::uint32_t clock_hz = 0;  // clock of the card
  // First and last clock of the card: steps outside are counted, but are not in the page. None: all steps are in it.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> window;
};

// Receives the steps in order; as an observer of the run's second pass it also receives the commands to which they
// belong.
class ReportWriter final : public driver::StepSink, public run::Observer {
 public:
  // Writes the page's head. `sink` and `machine` must outlive the writer. Throws std::logic_error in a build without
  // the page.
  ReportWriter(run::TextSink& sink, const machine::Machine& machine, const ReportSettings& settings);
  ~ReportWriter() override;

  // Writes the program's text; call before the run.
  void program(gcode::LineSource& lines);

  void sending(const planner::PlannedBlock& planned) override;
  void command(std::uint64_t number, const driver::Command& command) override;
  void pin_step(const driver::PinStep& step) override;
  void path_step(const driver::PathStep& step) override;

  // Call after the last step. `run`: the summary of the run, as JSON. `stopped`: the run was stopped before its end.
  // Paths after that of its last step were sent but never begun, and are not in the page.
  void finish(const std::string& run, bool stopped = false);

 private:
  class State;
  std::unique_ptr<State> state_;
};

// Clocks by which DIR changes before its pulse, in addition to the setup time: the phases of setup and pulse, and their
// delays to the pin (docs/reference/behaviour.md).
inline constexpr std::uint64_t kTurnClocks = 5;

// Escapes JSON for a script element, so that nothing in it can end the element or begin another.
std::string inside_script(const std::string& json);

}  // namespace trammel::report
