// Second motors of axes (gantries): further axes of the card, which make their axes' steps. Internal to the runs.
#pragma once

#include <cstddef>
#include <vector>

#include "trammel/driver/commands.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/card_limits.hpp"

namespace trammel::run {

// What the planner may use: arcs turn two axes of the card, so where motors follow axes they go out as lines.
inline planner::CardLimits planning_limits(planner::CardLimits card, const machine::Machine& machine) {
  return machine.second_motors().empty() ? card : planner::with_arcs_by(card, planner::ArcsBy::kChords);
}

class SecondMotors {
 public:
  explicit SecondMotors(const machine::Machine& machine)
      : first_(machine.axes.size()), axes_(machine.second_motors()) {}

  bool empty() const { return axes_.empty(); }
  // The line with the motors that follow its axes.
  driver::LineCommand with(driver::LineCommand line) const {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      line.increment[first_ + i] = line.increment[axes_[i]];
      if ((line.mask >> axes_[i] & 1) != 0) line.mask = static_cast<std::uint8_t>(line.mask | 1U << (first_ + i));
    }
    return line;
  }
  // The axis that a motor of the card belongs to.
  std::size_t axis_of(std::size_t motor) const { return motor < first_ ? motor : axes_[motor - first_]; }

 private:
  std::size_t first_;
  std::vector<std::size_t> axes_;
};

}  // namespace trammel::run
