#include "trammel/run/step_recorder.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "csv.hpp"

namespace trammel::run {

StepRecorder::StepRecorder(const Options& options, kinematics::Kinematics kinematics)
    : options_(options),
      kinematics_(std::move(kinematics)),
      steps_(kinematics_.joints()),
      position_(kinematics_.joints()),
      speed_(options.clock_hz) {
  for (std::size_t joint = 0; joint < kinematics_.joints(); ++joint) {
    step_length_[joint] = kinematics_.step_length(joint);
  }
  if (options.steps != nullptr) step_list_ = std::make_unique<CsvWriter>(*options.steps, "cycle,axis,direction");
  if (options.path_steps != nullptr) {
    path_step_list_ = std::make_unique<CsvWriter>(*options.path_steps, "command,tick,axis,direction");
  }
  if (options.plot) executed_.add({millimetres(), false});
}

StepRecorder::~StepRecorder() = default;

Point StepRecorder::millimetres() const {
  const kinematics::Coordinates at = kinematics_.coordinates(path_position_);
  return {at[0], at[1], at[2]};
}

void StepRecorder::pin_step(const driver::PinStep& step) {
  ++steps_[step.axis];
  position_[step.axis] += step.direction;
  if (step_list_) step_list_->row({static_cast<std::int64_t>(step.cycle), step.axis, step.direction});
  if (options_.plot && step.axis < 3) speed_.add(step.cycle, step.axis, step_length_[step.axis]);
}

void StepRecorder::point_of_path() {
  const Point point = millimetres();
  executed_.add({point, false});
  if (detail_command_ && last_->command >= *detail_command_ && detail_.size() < kDetailPoints) {
    detail_.push_back(point);
  }
}

void StepRecorder::path_step(const driver::PathStep& step) {
  deviation_.step(step.command, step.tick, step.axis, step.direction);
  if (path_step_list_) {
    path_step_list_->row(
        {static_cast<std::int64_t>(step.command), static_cast<std::int64_t>(step.tick), step.axis, step.direction});
  }
  // All steps of one tick form one point of the picture.
  if (options_.plot && last_ && (last_->command != step.command || last_->tick != step.tick)) point_of_path();
  path_position_[step.axis] += step.direction;
  last_ = step;
}

void StepRecorder::finish() {
  deviation_.finish();
  if (options_.plot && last_) point_of_path();
  if (step_list_) step_list_->finish();
  if (path_step_list_) path_step_list_->finish();
}

void StepRecorder::check(const std::vector<std::int64_t>& counted) const {
  for (std::size_t a = 0; a < counted.size(); ++a) {
    if (counted[a] != position_[a]) {
      throw std::runtime_error(
          fmt::format("axis {}: the card counts {} pulses, {} were seen at the pin", a, counted[a], position_[a]));
    }
  }
}

}  // namespace trammel::run
