// One pass over a program: lines, reader, blocks, planner. For a run that begins in the middle, it begins at that
// place. Internal to the runner.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "trammel/driver/wide.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/replay.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::run {

class Pipeline {
 public:
  // `meanwhile`: as in planner::PlannerSettings. `all`, unless it is null, gets every command of the program, including
  // those before the place where the run begins. Throws ProgramError for a place that the program does not have.
  Pipeline(const ProgramLines& lines, const machine::Machine& machine, const planner::CardLimits& card,
           const RunSettings& settings, std::function<void()> meanwhile = {}, driver::CommandSink* all = nullptr)
      : lines_(lines()),
        reader_(*lines_, machine, settings.start, settings.reader),
        blocks_(reader_, machine, planner::with_arcs_by(card, settings.arcs), settings.start),
        machine_(machine),
        kinematics_(machine),
        card_(card),
        planning_({settings.single_block, settings.profile, std::move(meanwhile), settings.ticks}) {
    planner_.emplace(blocks_, machine_, card_, planning_);
    planning_.ticks = {};  // after a probe the ticks start anew
    if (settings.profile == planner::SpeedProfile::kSCurve) blocks_.require_jerk();
    if (settings.single_block) blocks_.keep_corners();
    all_.tap = all;
    start_ = blocks_.start();
    if (settings.place || settings.first_line > 1) go_to_start(settings);
  }

  // As planner::Planner::next(), but throws ProgramError, and returns false also if a probe is next.
  bool next(driver::CommandSink& sink, planner::PlannedBlock& planned) {
    if (opening_) return give_opening(sink, planned);
    if (all_.tap == nullptr) return plan_next(sink, planned);
    all_.next = &sink;
    return plan_next(all_, planned);
  }
  bool at_probe() const { return blocks_.at_probe(); }
  // After this call, next() gives the probe's motion to its target, then returns false.
  const gcode::Motion& begin_probe() {
    const gcode::Motion& motion = blocks_.begin_probe();
    planner_.emplace(blocks_, machine_, card_, planning_);
    return motion;
  }
  // Continues after the probe; positions in pulses by joint.
  void end_probe(const planner::Pulses& edge, const planner::Pulses& rest, bool tripped) {
    reader_.probed(millimetres(edge), millimetres(rest), tripped);
    go_on_at(rest);
  }
  // For the check before the run: assumes that the probe ends at its target, which is not known yet.
  void assume_probe(const planner::Pulses& target) {
    reader_.assume_probed();
    go_on_at(target);
  }
  std::size_t lines_on_probes() const { return reader_.lines_on_probes(); }
  std::map<int, double> parameters() const { return reader_.parameters(); }
  const planner::PathTicks& ticks() const { return planner_->ticks(); }
  gcode::Coordinates millimetres(const planner::Pulses& pulses) const { return kinematics_.coordinates(pulses); }
  const kinematics::Kinematics& kinematics() const { return kinematics_; }

  const std::string& file() const { return lines_->name(); }
  // The position at which the run begins.
  const planner::Pulses& start() const { return start_; }
  std::size_t begin_line() const { return begin_line_; }  // program line
  // Commands of the program before the run's first one that count in GEOMETRY_BEGUN.
  std::uint64_t skipped() const { return skipped_; }
  // Whether the run begins in the middle of the program, and how many feed ticks of its first path are already done.
  bool replays() const { return replays_; }
  std::uint64_t ticks_done() const { return ticks_done_; }
  // The output levels that the run sets first.
  const driver::OutputCommand& restored() const { return restored_; }
  const std::map<std::string, std::size_t>& accepted() const { return reader_.accepted(); }

 private:
  struct Tee final : driver::CommandSink {
    void put(const driver::Command& command) override {
      tap->put(command);
      next->put(command);
    }
    driver::CommandSink* tap = nullptr;
    driver::CommandSink* next = nullptr;
  };
  // The rest of the block in which the run begins.
  struct Opening final : driver::CommandSink {
    void put(const driver::Command& command) override { commands.push_back(command); }
    std::vector<driver::Command> commands;
    planner::PlannedBlock planned;
  };
  // Starts a replay at a line: finds the first block of the line.
  class AtLine final : public driver::CommandSink {
   public:
    // Line 0: the replay already knows its place.
    AtLine(Replay& replay, const planner::PlannedBlock& planned, std::size_t line)
        : replay_(replay), planned_(planned), line_(line) {}
    void put(const driver::Command& command) override {
      if (line_ != 0 && planned_.block.line >= line_) replay_.here();
      replay_.put(command);
    }

   private:
    Replay& replay_;
    const planner::PlannedBlock& planned_;
    std::size_t line_;
  };

  bool plan_next(driver::CommandSink& sink, planner::PlannedBlock& planned) {
    const bool more = planner_->next(sink, planned);
    if (!more && blocks_.error()) throw ProgramError(*blocks_.error());
    return more;
  }

  void go_to_start(const RunSettings& settings) {
    if (!settings.place) reader_.must_reach(settings.first_line);
    opening_.emplace();
    Replay replay = settings.place ? Replay(*opening_, settings.place->path) : Replay(*opening_);
    AtLine at_line(replay, opening_->planned, settings.place ? 0 : settings.first_line);
    driver::CommandSink* sink = &at_line;
    if (all_.tap != nullptr) {
      all_.next = &at_line;
      sink = &all_;
    }
    try {
      while (!replay.begun() && plan_next(*sink, opening_->planned)) {
      }
    } catch (const ReplayError& error) {
      refuse(gcode::ErrorCode::kNoSuchLine, opening_->planned.block.line, error.what());
    }
    if (!replay.begun()) refuse_start(settings);
    planner::PlannedBlock& planned = opening_->planned;
    if (settings.place) check_position(replay.ticks_done(), settings.place->position);
    start_ = settings.place ? settings.place->position : planned.block.start;
    planned.block.start = start_;
    planned.commands = opening_->commands.size();
    begin_line_ = planned.block.line;
    const auto* outputs = std::get_if<driver::OutputCommand>(&opening_->commands.front());
    if (outputs != nullptr) restored_ = *outputs;
    skipped_ = replay.skipped();
    replays_ = true;
    ticks_done_ = replay.ticks_done();
  }
  // For a line or a block without motion, the ticks determine the machine's position. Refuses any other position:
  // another program has moved the card since the stop.
  void check_position(std::uint64_t done, const planner::Pulses& position) const {
    const planner::Block& block = opening_->planned.block;
    planner::Pulses wanted = block.start;
    for (const driver::Command& command : opening_->commands) {
      if (const auto* line = std::get_if<driver::LineCommand>(&command)) wanted = after(wanted, *line, done);
    }
    const bool known = block.geometry == planner::Geometry::kLine || !planner::moves(block);
    if (!known || position == wanted) return;
    refuse(
        gcode::ErrorCode::kNoSuchLine, block.line,
        fmt::format("the run was stopped {} ticks into this line, but the card stood at {}: something else has moved "
                    "it since",
                    done, place_text(millimetres(position), machine_)));
  }
  // The position after `done` ticks of a line.
  static planner::Pulses after(planner::Pulses at, const driver::LineCommand& line, std::uint64_t done) {
    for (std::size_t joint = 0; joint < at.size(); ++joint) {
      const driver::Int128 way =
          driver::Int128(static_cast<std::int64_t>(done)) * driver::Int128(line.increment[joint]) +
          driver::Int128(std::int64_t{1} << 39);
      at[joint] += static_cast<std::int64_t>(static_cast<std::uint64_t>(way.high()) << 24 | way.low() >> 40);
    }
    return at;
  }
  [[noreturn]] void refuse_start(const RunSettings& settings) {
    const std::string where = settings.place ? std::string("the place") : fmt::format("line {}", settings.first_line);
    if (at_probe()) {
      refuse(gcode::ErrorCode::kDependsOnProbe, blocks_.begin_probe().line,
             fmt::format("a probe before {}, where the program is to begin", where));
    }
    refuse(gcode::ErrorCode::kNoSuchLine, opening_->planned.block.line,
           fmt::format("the program ends before {}, where it is to begin", where));
  }
  [[noreturn]] void refuse(gcode::ErrorCode code, std::size_t line, const std::string& message) const {
    throw ProgramError(gcode::Error{code, file(), line, message});
  }
  bool give_opening(driver::CommandSink& sink, planner::PlannedBlock& planned) {
    const Opening opening = std::move(*opening_);
    opening_.reset();
    planned = opening.planned;
    for (const driver::Command& command : opening.commands) sink.put(command);
    return true;
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
  std::optional<planner::Planner> planner_;  // plans up to the next probe
  Tee all_;
  planner::Pulses start_{};
  std::optional<Opening> opening_;  // until next() has returned it
  std::size_t begin_line_ = 1;
  std::uint64_t skipped_ = 0;
  bool replays_ = false;
  std::uint64_t ticks_done_ = 0;
  driver::OutputCommand restored_;
};

}  // namespace trammel::run
