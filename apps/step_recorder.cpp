#include "step_recorder.hpp"

#include <cmath>
#include <stdexcept>

namespace trammel::app {

CsvFile::CsvFile(const std::string& file, const char* header)
    : file_(file), out_(file == "-" ? stdout : std::fopen(file.c_str(), "w")) {
  if (out_ == nullptr) throw std::runtime_error(fmt::format("{}: cannot be written", file));
  row("{}\n", header);
}

CsvFile::~CsvFile() {
  if (out_ != nullptr && out_ != stdout) std::fclose(out_);
}

void CsvFile::flush() {
  failed_ |= std::fwrite(buffer_.data(), 1, buffer_.size(), out_) != buffer_.size();
  buffer_.clear();
}

void CsvFile::close() {
  flush();
  failed_ |= std::fflush(out_) != 0;
  if (failed_) throw std::runtime_error(fmt::format("{}: could not be written to its end", file_));
}

StepRecorder::StepRecorder(const Options& options)
    : options_(options),
      steps_(options.steps_per_mm.size()),
      position_(options.steps_per_mm.size()),
      path_position_(options.steps_per_mm.size()),
      speed_(options.clock_hz) {
  if (options.steps) steps_file_ = std::make_unique<CsvFile>(*options.steps, "cycle,axis,direction");
  if (options.path_steps) {
    path_steps_file_ = std::make_unique<CsvFile>(*options.path_steps, "command,tick,axis,direction");
  }
  if (options.plot) executed_.add(millimetres());
}

Point StepRecorder::millimetres() const {
  Point point{};
  for (std::size_t axis = 0; axis < std::min<std::size_t>(3, path_position_.size()); ++axis) {
    point[axis] = static_cast<double>(path_position_[axis]) / options_.steps_per_mm[axis];
  }
  return point;
}

void StepRecorder::pin_step(const sim::PinStep& step) {
  ++steps_[step.axis];
  position_[step.axis] += step.direction;
  if (steps_file_) steps_file_->row("{},{},{}\n", step.cycle, int{step.axis}, int{step.direction});
  if (options_.plot && step.axis < 3) speed_.add(step.cycle, step.axis, 1.0 / options_.steps_per_mm[step.axis]);
}

void StepRecorder::point_of_path() {
  const Point point = millimetres();
  executed_.add(point);
  if (detail_command_ && last_->command >= *detail_command_ && detail_.size() < kDetailPoints) {
    detail_.push_back(point);
  }
}

void StepRecorder::path_step(const sim::PathStep& step) {
  deviation_.step(step.command, step.tick, step.axis, step.direction);
  if (path_steps_file_) {
    path_steps_file_->row("{},{},{},{}\n", step.command, step.tick, int{step.axis}, int{step.direction});
  }
  // All steps of one tick make one point of the picture.
  if (options_.plot && last_ && (last_->command != step.command || last_->tick != step.tick)) point_of_path();
  path_position_[step.axis] += step.direction;
  last_ = step;
}

void StepRecorder::finish() {
  deviation_.finish();
  if (options_.plot && last_) point_of_path();
  if (steps_file_) steps_file_->close();
  if (path_steps_file_) path_steps_file_->close();
}

}  // namespace trammel::app
