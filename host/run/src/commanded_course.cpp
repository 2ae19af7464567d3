#include "trammel/run/commanded_course.hpp"

#include <algorithm>
#include <cmath>

#include "trammel/run/step_recorder.hpp"

namespace trammel::run {
namespace {

constexpr double kCentreScale = 256.0;

// The commanded path of a segment as points. In mm, where an arc is a circle whatever the axes' scales.
class CommandedPath {
 public:
  CommandedPath(const planner::PlannedSegment& segment, const std::vector<double>& steps_per_mm)
      : axes_(std::min<std::size_t>(3, steps_per_mm.size())), axis_x_(segment.axis_x), axis_y_(segment.axis_y) {
    double square = 0;
    for (std::size_t a = 0; a < steps_per_mm.size(); ++a) {
      start_[a] = static_cast<double>(segment.start[a]) / steps_per_mm[a];
      end_[a] = static_cast<double>(segment.end[a]) / steps_per_mm[a];
      square += std::pow(static_cast<double>(segment.end[a] - segment.start[a]), 2);
    }
    pulses_ = std::sqrt(square);
    if (segment.kind != gcode::MotionKind::kArc) return;
    centre_x_ = static_cast<double>(segment.centre_x) / kCentreScale / steps_per_mm[axis_x_];
    centre_y_ = static_cast<double>(segment.centre_y) / kCentreScale / steps_per_mm[axis_y_];
    radius_ = std::hypot(start_[axis_x_] - centre_x_, start_[axis_y_] - centre_y_);
    angle_ = std::atan2(start_[axis_y_] - centre_y_, start_[axis_x_] - centre_x_);
    turn_ = segment.clockwise ? -segment.sweep : segment.sweep;
    pulses_ = radius_ * segment.sweep * std::max(steps_per_mm[axis_x_], steps_per_mm[axis_y_]);
  }
  double pulses() const { return pulses_; }  // length, about

  // The point at a share, 0 to 1, of the path.
  Point at(double share) const {
    Point point{};
    for (std::size_t a = 0; a < axes_; ++a) point[a] = start_[a] + share * (end_[a] - start_[a]);
    if (radius_ > 0) {
      const double angle = angle_ + share * turn_;
      point[axis_x_] = centre_x_ + radius_ * std::cos(angle);
      point[axis_y_] = centre_y_ + radius_ * std::sin(angle);
    }
    return point;
  }

 private:
  std::size_t axes_;
  std::size_t axis_x_;
  std::size_t axis_y_;
  std::array<double, card_map::kMaxAxes> start_{};
  std::array<double, card_map::kMaxAxes> end_{};
  double centre_x_ = 0;
  double centre_y_ = 0;
  double radius_ = 0;  // 0: a line
  double angle_ = 0;
  double turn_ = 0;
  double pulses_ = 0;
};

bool is_geometry(const driver::Command& command) {
  return std::holds_alternative<driver::LineCommand>(command) || std::holds_alternative<driver::ArcCommand>(command);
}

// How well a segment shows single pulses: an arc best, then a line of several axes, then any path.
int detail_rank(const planner::PlannedSegment& segment) {
  if (segment.kind == gcode::MotionKind::kArc) return 3;
  int moving = 0;
  for (std::size_t a = 0; a < 3; ++a) moving += segment.end[a] != segment.start[a] ? 1 : 0;
  return std::min(moving, 2);
}

}  // namespace

CommandedCourse::CommandedCourse(const machine::Machine& machine) {
  for (const machine::MachineAxis& axis : machine.axes) steps_per_mm_.push_back(axis.steps_per_mm);
}

void CommandedCourse::planned(const planner::PlannedSegment& segment, std::uint64_t first) {
  constexpr double kArcPoints = 64;
  const auto geometry = std::find_if(segment.commands.begin(), segment.commands.end(), is_geometry);
  if (geometry == segment.commands.end()) return;
  const CommandedPath path(segment, steps_per_mm_);
  if (points_.given() == 0) points_.add(path.at(0));
  const double points = segment.kind == gcode::MotionKind::kArc ? kArcPoints : 1;
  for (double i = 1; i <= points; ++i) points_.add(path.at(i / points));
  const int rank = detail_rank(segment);
  if (rank <= best_rank_) return;
  best_rank_ = rank;
  detail_command_ = first + static_cast<std::uint64_t>(geometry - segment.commands.begin());
  detail_.clear();
  const double length = std::min(path.pulses(), static_cast<double>(StepRecorder::kDetailPoints));
  for (double s = 0; s <= length; s += 1) detail_.push_back(path.at(s / path.pulses()));
}

}  // namespace trammel::run
