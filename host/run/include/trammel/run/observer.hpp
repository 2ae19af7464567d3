// What a run tells of itself while it goes. Called from the thread that runs; must not use the card.
#pragma once

#include <cstddef>
#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/planner/planner.hpp"

namespace trammel::run {

// How far the card is.
struct Progress {
  std::uint32_t begun = 0;  // commands begun from the geometry queue, barriers too; wraps
  std::size_t line = 0;     // of the program, that has begun last
  driver::Status status;
};

class Observer {
 public:
  virtual ~Observer() = default;
  // First pass, before anything moves: a block whose first command has the number `first`.
  virtual void planned(const planner::PlannedBlock& /*block*/, std::uint64_t /*first*/) {}
  // Second pass: a block before its commands are written, and each of them with its number, which is not wrapped.
  virtual void sending(const planner::PlannedBlock& /*block*/) {}
  virtual void command(std::uint64_t /*number*/, const driver::Command& /*command*/) {}
  // When the block's commands are written.
  virtual void sent() {}
  // Every now and then while the card runs.
  virtual void progress(const Progress& /*progress*/) {}
};

}  // namespace trammel::run
