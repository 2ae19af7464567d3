// Planner: from blocks to the card's stream commands, exact stop at the end of every block. Not thread-safe.
//
// A path has N feed ticks: T ticks for each pulse of path length (length in mm times the largest steps/mm of the moving
// axes), T up to 128 for even steps, less where the clock or the speed does not allow it. The profile keeps every axis
// within its velocity and acceleration (a feed override above 100 % is not planned for).
#pragma once

#include <cstdint>

#include "trammel/driver/command_sink.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"
#include "trammel/planner/block_builder.hpp"
#include "trammel/planner/card_limits.hpp"
#include "trammel/planner/profile.hpp"

namespace trammel::planner {

// What the commands came from.
struct PlannedBlock {
  Block block;                           // complete before the first command is put, as are `seconds` and what follows
  double seconds = 0;                    // planned duration
  double speed = 0;                      // mm/s along the path, the highest planned; 0 for what does not move
  SpeedLimit limit = SpeedLimit::kNone;  // what keeps it below what the program wants
  std::uint64_t commands = 0;            // put
  std::uint64_t geometry = 0;            // of these, into the geometry queue: paths and barriers
  std::uint64_t feed = 0;                // and into the feed queue: pieces and barriers
};

class Planner {
 public:
  // Blocks and machine must outlive the planner.
  Planner(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card);

  // Plans the next block and puts its commands; false after the last (kEnd) and at an error, which the builder has.
  // The feed pieces of a path come before its geometry, so that neither queue can fill up with what waits for the
  // other. What the sink throws passes through; the planner is then of no further use.
  bool next(driver::CommandSink& sink, PlannedBlock& planned);

 private:
  std::uint64_t ticks_for(const Block& block) const;
  void plan_move(PlannedBlock& planned);
  void put_dwell(PlannedBlock& planned, driver::CommandSink& sink);
  void put_geometry(const Block& block, driver::CommandSink& sink);
  void put_chords(const Block& block, driver::CommandSink& sink);

  BlockBuilder& blocks_;
  const machine::Machine& machine_;
  CardLimits card_;
  std::uint64_t least_ticks_;
  std::uint64_t ticks_ = 0;  // of the block; kChords: of each line
  Profile profile_;
  driver::Command line_{driver::LineCommand{}};
  driver::Command piece_{driver::FeedCommand{}};
  driver::Command other_{driver::EndCommand{}};
};

}  // namespace trammel::planner
