// Planner: from blocks to the card's stream commands, over as many blocks as look-ahead sees. Not thread-safe.
//
//     BlockBuilder -> ring of blocks -> junctions -> SpeedPlan -> Quantiser -> CommandSink
//
// A path has N feed ticks: T for each pulse of its length, T up to 128 for even steps, less where the clock does not
// allow it; the same T for all paths that a feed piece spans. The plan is a function of the program and the settings
// alone, never of how fast it is read.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "trammel/driver/command_sink.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"
#include "trammel/planner/block_builder.hpp"
#include "trammel/planner/card_limits.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

// Raised where the same program, machine and settings give other commands than before.
inline constexpr unsigned kPlanVersion = 1;

enum class SpeedProfile {
  kByMachine,  // S-curve where every axis has a max_jerk, else trapezoid
  kTrapezoid,  // acceleration jumps
  kSCurve,     // jerk is limited where an axis that moves has a max_jerk; BlockBuilder::require_jerk() asks for all
};

// Where a planner's paths stand on their way: the next one's first path gets the ticks that it would have had in the
// same planner, so that a program in parts makes the steps of the whole, in their order.
struct PathTicks {
  double density = 0;  // ticks a mm of the last path; 0: none yet
  double base_mm = 0;  // where that density began
  std::uint64_t base_tick = 0;
  double end_mm = 0;
  std::uint64_t end_tick = 0;
  bool rapid = false;  // the last path's class
};

struct PlannerSettings {
  bool single_block = false;  // each line of the program ends in a stop
  SpeedProfile profile = SpeedProfile::kByMachine;
  // Called before each block is read and before each ramp is planned, since one Planner::next() may take a whole window
  // of them. What it throws passes through that call.
  std::function<void()> meanwhile{};
  PathTicks ticks{};
};

// kTrapezoid or kSCurve.
SpeedProfile profile_of(const machine::Machine& machine, const PlannerSettings& settings);

// What the commands came from.
struct PlannedBlock {
  Block block;                           // complete before the first command is put, as are `seconds` and what follows
  double seconds = 0;                    // planned duration
  double speed = 0;                      // mm/s along the path, the highest planned; 0 for what does not move
  SpeedLimit limit = SpeedLimit::kNone;  // what keeps it below what the program wants
  bool stop = false;                     // moves, and ends at rest
  double velocity_jump = 0;              // mm/s, the largest of an axis at its end, where it has a corner
  double acceleration_step = 0;          // mm/s^2, at its end, where it has no corner and the curvature changes
  std::uint64_t commands = 0;            // put
  std::uint64_t beside = 0;              // of these, the first ones: what takes effect where the block begins
  std::uint64_t geometry = 0;            // of these, into the geometry queue: paths, barriers, outputs
  std::uint64_t feed = 0;                // and into the feed queue: pieces and barriers
};

struct PathEntry;

class Planner {
 public:
  // Blocks and machine must outlive the planner.
  Planner(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card,
          const PlannerSettings& settings = {});
  ~Planner();

  // Puts the commands of the next block: what it switches, the feed pieces that begin in it, then its geometry, so that
  // neither queue can fill up with what waits for the other. False after the last (kEnd), and when all before an error
  // is given, which the builder has: the motion ends at rest there. What the sink throws passes through; the planner is
  // then of no further use.
  bool next(driver::CommandSink& sink, PlannedBlock& planned);

  // Behind the last block that was read.
  const PathTicks& ticks() const;
  // Of the speed plan.
  const PlanWork& work() const;

 private:
  class LookAhead;

  void put_outputs(PlannedBlock& planned, driver::CommandSink& sink);
  void put_pulses(PlannedBlock& planned, const PathEntry& entry, driver::CommandSink& sink);
  driver::PwmCommand pulses_of(const PathEntry& entry) const;
  void put_dwell(PlannedBlock& planned, const PathEntry& entry, driver::CommandSink& sink);
  void put_geometry(const Block& block, std::uint64_t ticks, driver::CommandSink& sink);
  void put_line(const Block& block, std::uint64_t ticks, driver::CommandSink& sink);
  void put_arc_chords(const Block& block, std::uint64_t ticks, driver::CommandSink& sink);
  void put_chords(const Block& block, std::uint64_t ticks, driver::CommandSink& sink);

  kinematics::Kinematics kinematics_;
  std::unique_ptr<LookAhead> look_ahead_;
  bool pwm_;         // S sets pulses
  double clock_hz_;  // of the card
  double most_override_;
  std::optional<driver::PwmCommand> pulses_;  // put last
  driver::Command line_{driver::LineCommand{}};
  driver::Command piece_{driver::FeedCommand{}};
  driver::Command other_{driver::EndCommand{}};
};

}  // namespace trammel::planner
