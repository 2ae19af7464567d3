// A block of the commanded path in the format of the page. Internal to the writer.
#pragma once

#include <cstdint>
#include <optional>

#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/report/page_stream.hpp"

namespace trammel::report {

struct PathRecord {
  planner::Block block;
  double speed = 0;  // mm/s, highest planned speed
  planner::SpeedLimit limit = planner::SpeedLimit::kNone;
  bool stop = false;
  std::uint64_t first_command = 0;
  std::uint64_t ticks = 0;        // ticks of all its commands
  std::uint64_t step_clocks = 0;  // number of clocks with steps
};

// Encodes the blocks in the program's order.
class PathCoder {
 public:
  PathCoder(run::TextSink& sink, const machine::Machine& machine)
      : stream_(sink, "paths"), axes_(machine.axes.size()) {}
  void put(const PathRecord& record);
  void finish() { stream_.finish(); }

 private:
  void put_arc(const planner::Block& block);
  bool goes_on(const planner::Block& block) const;

  PageStream stream_;
  std::size_t axes_;
  std::int64_t line_ = 0;
  std::optional<planner::Pulses> end_;  // end of the previous motion
};

}  // namespace trammel::report
