// The commanded path of a program for its plot, recorded in the first pass: thinned points, and a stretch to magnify.
// Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/observer.hpp"
#include "trammel/run/path_points.hpp"

namespace trammel::run {

class CommandedCourse final : public Observer {
 public:
  explicit CommandedCourse(const machine::Machine& machine);
  void planned(const planner::PlannedBlock& planned, std::uint64_t first) override;

  std::vector<PathPoint> points() const { return points_.points(); }
  // The path command that shows single pulses best (an arc rather than a line): its number, and the points at its
  // beginning.
  std::optional<std::uint64_t> detail_command() const { return detail_command_; }
  const std::vector<Point>& detail() const { return detail_; }

 private:
  kinematics::Kinematics kinematics_;
  PathPoints points_{10000};
  bool begun_ = false;
  int best_rank_ = 0;
  std::optional<std::uint64_t> detail_command_;
  std::vector<Point> detail_;
};

}  // namespace trammel::run
