// One pass over a program: lines, reader, blocks, planner. Internal to the runner.
#pragma once

#include <memory>

#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::run {

class Pipeline {
 public:
  Pipeline(const ProgramLines& lines, const machine::Machine& machine, const planner::CardLimits& card,
           const RunSettings& settings)
      : lines_(lines()),
        reader_(reader_at(settings.first_line, gcode::Reader(*lines_, machine, settings.start, settings.reader))),
        blocks_(reader_, machine, planner::with_arcs_by(card, settings.arcs), reader_.position()),
        planner_(blocks_, machine, card, {settings.single_block, settings.profile}) {
    if (settings.profile == planner::SpeedProfile::kSCurve) blocks_.require_jerk();
    if (settings.single_block) blocks_.keep_corners();
  }

  // As planner::Planner::next(), but throws ProgramError.
  bool next(driver::CommandSink& sink, planner::PlannedBlock& planned) {
    const bool more = planner_.next(sink, planned);
    if (!more && blocks_.error()) throw ProgramError(*blocks_.error());
    return more;
  }
  const std::string& file() const { return lines_->name(); }
  const planner::Pulses& start() const { return blocks_.start(); }
  const std::map<std::string, std::size_t>& accepted() const { return reader_.accepted(); }

 private:
  static gcode::Reader reader_at(std::size_t line, gcode::Reader reader) {
    if (line > 1 && !reader.skip_to(line)) throw ProgramError(*reader.error());
    return reader;
  }

  std::unique_ptr<gcode::LineSource> lines_;
  gcode::Reader reader_;
  planner::BlockBuilder blocks_;
  planner::Planner planner_;
};

}  // namespace trammel::run
