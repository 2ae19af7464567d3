// One pass over a program: lines, reader, blocks, planner. Internal to the runner.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::run {

class Pipeline {
 public:
  // `meanwhile`: as of planner::PlannerSettings.
  Pipeline(const ProgramLines& lines, const machine::Machine& machine, const planner::CardLimits& card,
           const RunSettings& settings, std::function<void()> meanwhile = {})
      : lines_(lines()),
        reader_(reader_at(settings.first_line, gcode::Reader(*lines_, machine, settings.start, settings.reader))),
        blocks_(reader_, machine, planner::with_arcs_by(card, settings.arcs), reader_.position()),
        machine_(machine),
        kinematics_(machine),
        card_(card),
        planning_({settings.single_block, settings.profile, std::move(meanwhile)}) {
    planner_.emplace(blocks_, machine_, card_, planning_);
    if (settings.profile == planner::SpeedProfile::kSCurve) blocks_.require_jerk();
    if (settings.single_block) blocks_.keep_corners();
    if (settings.start_is_known) require_at(settings.start, settings.first_line);
  }

  // As planner::Planner::next(), but throws ProgramError, and gives false where a probe stands next, too.
  bool next(driver::CommandSink& sink, planner::PlannedBlock& planned) {
    const bool more = planner_->next(sink, planned);
    if (!more && blocks_.error()) throw ProgramError(*blocks_.error());
    return more;
  }
  bool at_probe() const { return blocks_.at_probe(); }
  // From here next() gives the probe's way to its target, then false.
  const gcode::Motion& begin_probe() {
    const gcode::Motion& motion = blocks_.begin_probe();
    planner_.emplace(blocks_, machine_, card_, planning_);
    return motion;
  }
  // Goes on behind the probe, pulses by joint.
  void end_probe(const planner::Pulses& edge, const planner::Pulses& rest, bool tripped) {
    reader_.probed(millimetres(edge), millimetres(rest), tripped);
    go_on_at(rest);
  }
  // For the check before the run: at its target, not known yet.
  void assume_probe(const planner::Pulses& target) {
    reader_.assume_probed();
    go_on_at(target);
  }
  std::size_t lines_on_probes() const { return reader_.lines_on_probes(); }
  std::map<int, double> parameters() const { return reader_.parameters(); }
  gcode::Coordinates millimetres(const planner::Pulses& pulses) const { return kinematics_.coordinates(pulses); }
  const kinematics::Kinematics& kinematics() const { return kinematics_; }

  const std::string& file() const { return lines_->name(); }
  const planner::Pulses& start() const { return blocks_.start(); }
  const std::map<std::string, std::size_t>& accepted() const { return reader_.accepted(); }

 private:
  static gcode::Reader reader_at(std::size_t line, gcode::Reader reader) {
    if (line > 1 && !reader.skip_to(line)) throw ProgramError(*reader.error());
    return reader;
  }

  // Throws RunError where the program begins elsewhere.
  void require_at(const gcode::Coordinates& place, std::size_t line) const {
    if (blocks_.start() == kinematics_.pulses(place)) return;
    throw RunError(
        file(), line,
        fmt::format("it begins at {}, but the machine stands at {}: run the lines before it, or go there first",
                    place_text(reader_.position(), machine_), place_text(place, machine_)));
  }

  void go_on_at(const planner::Pulses& here) {
    blocks_.resume_at(here);
    planner_.emplace(blocks_, machine_, card_, planning_);
  }

  std::unique_ptr<gcode::LineSource> lines_;
  gcode::Reader reader_;
  planner::BlockBuilder blocks_;
  const machine::Machine& machine_;
  kinematics::Kinematics kinematics_;
  planner::CardLimits card_;
  planner::PlannerSettings planning_;
  std::optional<planner::Planner> planner_;  // of the program up to the next probe
};

}  // namespace trammel::run
