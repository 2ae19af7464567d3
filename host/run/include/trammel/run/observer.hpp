// Receives the events of a run in progress. Called from the thread that runs; must not use the card.
#pragma once

#include <cstddef>
#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/planner/planner.hpp"

namespace trammel::run {

// The progress of the card.
struct Progress {
  std::uint32_t begun = 0;  // commands begun from the geometry queue, barriers too; wraps
  std::size_t line = 0;     // line of the program whose command has begun last
  driver::Status status;
};

class Observer {
 public:
  virtual ~Observer() = default;
  // First pass, before anything moves: a block, and the number of its first command.
  virtual void planned(const planner::PlannedBlock& /*block*/, std::uint64_t /*first*/) {}
  // Second pass: sending() before the commands of a block are written, and command() for each of them with its
  // unwrapped number.
  virtual void sending(const planner::PlannedBlock& /*block*/) {}
  virtual void command(std::uint64_t /*number*/, const driver::Command& /*command*/) {}
  // After the block's commands were written.
  virtual void sent() {}
  // At intervals while the card runs.
  virtual void progress(const Progress& /*progress*/) {}
};

}  // namespace trammel::run
