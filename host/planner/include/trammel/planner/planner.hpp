// Planner: turns blocks into the card's stream commands, with look-ahead over a window of blocks. Not thread-safe.
//
//     BlockBuilder -> ring of blocks -> junctions -> SpeedPlan -> Quantiser -> CommandSink
//
// A path has T feed ticks per pulse of its length. T is up to 128, for even steps, and less if the clock does not allow
// that; all paths that a feed piece spans have the same T. The plan depends on the program and the settings only, never
// on how fast the program is read.
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

// Incremented when the same program, machine and settings give other commands than before.
inline constexpr unsigned kPlanVersion = 1;

enum class SpeedProfile {
  kByMachine,  // S-curve if every axis has a max_jerk, else trapezoid
  kTrapezoid,  // acceleration jumps
  // Jerk is limited if a moving axis has a max_jerk; BlockBuilder::require_jerk() demands one of each.
  kSCurve,
};

// The end of a planner's paths in mm and ticks. A planner that gets it gives its first path the ticks that this path
// would have had in the planner before, so that a program in parts makes the same steps in the same order as the whole.
struct PathTicks {
  double density = 0;           // feed ticks per mm of the last path; 0: no path yet
  double base_mm = 0;           // where that density began
  std::uint64_t base_tick = 0;  // the tick there
  double end_mm = 0;            // end of the last path
  std::uint64_t end_tick = 0;   // the tick there
  bool rapid = false;           // the last path's class
};

struct PlannerSettings {
  bool single_block = false;  // each line of the program ends in a stop
  SpeedProfile profile = SpeedProfile::kByMachine;
  // Called before each block is read and before each ramp is planned, because one Planner::next() may do this for a
  // whole window. next() passes on its exceptions.
  std::function<void()> meanwhile{};
  PathTicks ticks{};
};

// kTrapezoid or kSCurve.
SpeedProfile profile_of(const machine::Machine& machine, const PlannerSettings& settings);

// The block that the commands belong to, with its planned times and speeds.
struct PlannedBlock {
  // Complete before the first command is put, like all fields after it.
  Block block;
  double seconds = 0;                    // planned duration
  double speed = 0;                      // mm/s along the path, the highest planned; 0 if it does not move
  SpeedLimit limit = SpeedLimit::kNone;  // why it is below the program's speed
  bool stop = false;                     // it moves and ends at rest
  double velocity_jump = 0;              // mm/s, the largest of an axis at its end, if there is a corner
  double acceleration_step = 0;          // mm/s^2, at its end, if there is no corner and the curvature changes
  std::uint64_t commands = 0;            // number of commands put
  std::uint64_t beside = 0;              // of these, the first ones, which take effect at the block's beginning
  std::uint64_t geometry = 0;            // of these, those for the geometry queue: paths, barriers, outputs
  std::uint64_t feed = 0;                // of these, those for the feed queue: pieces and barriers
};

struct PathEntry;

class Planner {
 public:
  // Blocks and machine must outlive the planner.
  Planner(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card,
          const PlannerSettings& settings = {});
  ~Planner();

  // Puts the commands of the next block in this order: outputs, the feed pieces that begin in the block, its geometry.
  // So neither queue can fill up with commands that wait for the other queue. Returns false after the last block
  // (kEnd), or, after an error (see the builder), when all blocks before it are put; the motion then ends at rest.
  // Exceptions of the sink pass through; the planner is of no further use after one.
  bool next(driver::CommandSink& sink, PlannedBlock& planned);

  // At the end of the last block that was read.
  const PathTicks& ticks() const;
  // Work of the speed plan so far.
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
  bool pwm_;         // S sets the duty of the pulses on the outputs
  double clock_hz_;  // of the card
  double most_override_;
  std::optional<driver::PwmCommand> pulses_;  // the last one put
  driver::Command line_{driver::LineCommand{}};
  driver::Command piece_{driver::FeedCommand{}};
  driver::Command other_{driver::EndCommand{}};
};

}  // namespace trammel::planner
