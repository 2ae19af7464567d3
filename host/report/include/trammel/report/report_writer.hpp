// Writes the page of a run while it goes, in memory that does not grow with it. The page's data are streams
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
  std::uint32_t clock_hz = 0;  // of the card that runs
  // Clocks of the card, first and last: steps outside are counted, but not in the page. None: all are in it.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> window;
};

// Takes the steps as they come; as an observer of the run's second pass it learns the commands that they belong to.
class ReportWriter final : public driver::StepSink, public run::Observer {
 public:
  // Sink and machine must outlive the writer. Writes the page's head. Throws std::logic_error without a page.
  ReportWriter(run::TextSink& sink, const machine::Machine& machine, const ReportSettings& settings);
  ~ReportWriter() override;

  // The program's text, before the run.
  void program(gcode::LineSource& lines);

  void sending(const planner::PlannedBlock& planned) override;
  void command(std::uint64_t number, const driver::Command& command) override;
  void pin_step(const driver::PinStep& step) override;
  void path_step(const driver::PathStep& step) override;

  // After the last step. `run`: what the summary says of the run, as JSON. `stopped`: the run did not come to its end;
  // paths behind that of its last step were sent and never begun, and are not in the page.
  void finish(const std::string& run, bool stopped = false);

 private:
  class State;
  std::unique_ptr<State> state_;
};

// Clocks by which DIR turns before the pulse that it turns for, beside the setup time: the phases of setup and pulse
// and their ways to the pin (docs/reference/behaviour.md).
inline constexpr std::uint64_t kTurnClocks = 5;

// JSON for a script element: nothing in it can end the element or begin another.
std::string inside_script(const std::string& json);

}  // namespace trammel::report
