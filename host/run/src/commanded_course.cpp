#include "trammel/run/commanded_course.hpp"

#include <algorithm>
#include <cmath>

#include "trammel/run/step_recorder.hpp"

namespace trammel::run {
namespace {

// The commanded path of a block as points, in mm. In mm an arc is a circle for all kinematics.
class CommandedPath {
 public:
  CommandedPath(const planner::Block& block, const kinematics::Kinematics& kinematics)
      : axes_(std::min<std::size_t>(3, kinematics.axes())),
        axis_x_(block.axis_x),
        axis_y_(block.axis_y),
        start_(kinematics.coordinates(block.start)),
        end_(kinematics.coordinates(block.end)) {
    double square = 0;
    for (std::size_t joint = 0; joint < kinematics.joints(); ++joint) {
      square += std::pow(static_cast<double>(block.end[joint] - block.start[joint]), 2);
    }
    pulses_ = std::sqrt(square);
    if (block.geometry == planner::Geometry::kLine) return;
    turn_ = block.clockwise ? -block.exact.sweep : block.exact.sweep;
    tilted_ = block.tilted;
    if (tilted_) {
      space_ = block.space;
      pulses_ = space_.radius * space_.sweep * kinematics.finest(axis_x_);
      return;
    }
    centre_x_ = block.exact.centre_x;
    centre_y_ = block.exact.centre_y;
    radius_ = std::hypot(start_[axis_x_] - centre_x_, start_[axis_y_] - centre_y_);
    angle_ = std::atan2(start_[axis_y_] - centre_y_, start_[axis_x_] - centre_x_);
    pulses_ = radius_ * block.exact.sweep * std::max(kinematics.finest(axis_x_), kinematics.finest(axis_y_));
  }
  double pulses() const { return pulses_; }  // approximate length

  // The point at the fraction `share` (0 to 1) of the path.
  Point at(double share) const {
    Point point{};
    for (std::size_t a = 0; a < axes_; ++a) point[a] = start_[a] + share * (end_[a] - start_[a]);
    if (radius_ > 0) {
      const double angle = angle_ + share * turn_;
      point[axis_x_] = centre_x_ + radius_ * std::cos(angle);
      point[axis_y_] = centre_y_ + radius_ * std::sin(angle);
    }
    for (std::size_t i = 0; tilted_ && i < space_.axes.size(); ++i) {
      const double way = std::cos(share * turn_) * space_.first[i] + std::sin(share * turn_) * space_.second[i];
      point[space_.axes[i]] = space_.centre[i] + space_.radius * way;
    }
    return point;
  }

 private:
  std::size_t axes_;
  std::size_t axis_x_;
  std::size_t axis_y_;
  gcode::Coordinates start_;
  gcode::Coordinates end_;
  double centre_x_ = 0;
  double centre_y_ = 0;
  double radius_ = 0;  // 0: a line, or tilted
  bool tilted_ = false;
  planner::SpaceArc space_;
  double angle_ = 0;
  double turn_ = 0;
  double pulses_ = 0;
};

// Ranks how well a block shows single pulses: an arc best, then a line of several axes, then any path.
int detail_rank(const planner::Block& block) {
  if (block.geometry != planner::Geometry::kLine) return 3;
  int moving = 0;
  for (std::size_t a = 0; a < 3; ++a) moving += block.end[a] != block.start[a] ? 1 : 0;
  return std::min(moving, 2);
}

}  // namespace

CommandedCourse::CommandedCourse(const machine::Machine& machine) : kinematics_(machine) {}

void CommandedCourse::planned(const planner::PlannedBlock& planned, std::uint64_t first) {
  constexpr double kArcPoints = 64;  // per turn
  constexpr double kMaxTurns = 100;
  const planner::Block& block = planned.block;
  if (!planner::moves(block)) return;
  const CommandedPath path(block, kinematics_);
  if (!begun_) points_.add({path.at(0), false});
  begun_ = true;
  const double turns = std::min(std::ceil(block.exact.sweep / 6.28), kMaxTurns);
  const double points = block.geometry == planner::Geometry::kLine ? 1 : kArcPoints * turns;
  for (double i = 1; i <= points; ++i) points_.add({path.at(i / points), block.rapid});
  const int rank = detail_rank(block);
  if (rank <= best_rank_) return;
  best_rank_ = rank;
  detail_command_ = first + planned.feed + planned.beside;  // feed pieces and commands without a path come first
  detail_.clear();
  const double length = std::min(path.pulses(), static_cast<double>(StepRecorder::kDetailPoints));
  for (double s = 0; s <= length; s += 1) detail_.push_back(path.at(s / path.pulses()));
}

}  // namespace trammel::run
